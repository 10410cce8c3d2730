"""A sample of what `campaigns/disturbances.py` does for longer: nothing holds up a station that plans all the time."""

from __future__ import annotations

import asyncio
import time

from controller.disturbances import LONGEST_TICK, disturbed


def test_a_disturbed_station_plans_and_ticks_on_time() -> None:
    """CPU time is measured, which other tests that run at the same time do not lengthen."""
    seen = asyncio.run(disturbed(10, "sample", time.thread_time))
    assert seen.seen["plans adopted, fast"]
    assert seen.percentile <= LONGEST_TICK
