"""A station under random disturbances while it plans: a campaign of `make campaign`."""

from __future__ import annotations

import asyncio
import logging
import sys
from collections import Counter

import structlog
from comparing.campaign import Kind, Subject, main

from controller.disturbances import LONGEST_TICK, disturbed

SECONDS = 60


def one_minute(seed: str) -> Counter[str]:
    """A minute of a station's life. AssertionError when ticks took too long or a plan does not replay."""
    seen = asyncio.run(disturbed(SECONDS, seed))
    assert seen.percentile <= LONGEST_TICK, f"1 in 100 ticks takes longer than {seen.percentile:.1f} ms"
    return seen.told


SUBJECT = Subject(
    "disturbances",
    "A station under disturbances",
    "The truck engine station with its planner and emulated devices in real time: devices are moved by hand,\n"
    "estimates corrected, resources go away and come back. In each minute 99 in 100 ticks, with all that the\n"
    f"controller does beside them, take at most {LONGEST_TICK:g} ms; every plan adopted replays on the reference tick.",
    {"minutes": Kind(one_minute, 10, kept_every=1)},
)

if __name__ == "__main__":
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.ERROR))
    sys.exit(main(SUBJECT))
