"""The planner's engines beside exhaustive search: a campaign of `make campaign`."""

from __future__ import annotations

import sys

from comparing.campaign import Kind, Subject, main

from core.planner_comparison import compare_engines

SUBJECT = Subject(
    "planning",
    "Planner's engines beside exhaustive search",
    "Random small stations with random goals; half of them with formulas, offline resources, restart abilities and\n"
    "conditions to avoid, a quarter from states with unknown values. Every engine is asked under both contracts.\n"
    "Plans must replay on the reference tick, minimal ones have as few ticks and then starts as breadth-first search\n"
    "finds, and there is a proof only where no run at all reaches the goals.",
    {"problems": Kind(compare_engines, 10_000)},
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
