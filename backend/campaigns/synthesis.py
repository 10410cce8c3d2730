"""Supervisors beside their definition: a campaign of `make campaign`."""

from __future__ import annotations

import sys

from comparing.campaign import Kind, Subject, main

from core.supervisor_comparison import compare_plain, compare_station

SUBJECT = Subject(
    "synthesis",
    "Supervisors beside their definition",
    "Random plain automata and random stations. The safe states and those reachable, with and without the\n"
    "supervisor, over all variables and over those that matter, are compared with plain sets of states and\n"
    "the reference tick, their exact numbers too; and for each start in each safe state, whether the\n"
    "supervisor allows it and whether its guard says so.",
    {"plain": Kind(compare_plain, 10_000), "station": Kind(compare_station, 1_000)},
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
