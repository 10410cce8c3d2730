"""A sample of what `campaigns/disturbances.py` does for longer, which also holds the length of ticks to its limit."""

from __future__ import annotations

import asyncio

from controller.disturbances import disturbed


def test_a_disturbed_station_ticks_on_and_every_plan_it_adopts_replays() -> None:
    """Ticks are not timed here: 99 in 100 of so few are all of them, and the machine is shared with other tests."""
    seen = asyncio.run(disturbed(10, "sample"))
    assert seen.ticks
    assert seen.seen["plans adopted, fast"]
    assert seen.seen["operations completed"]
