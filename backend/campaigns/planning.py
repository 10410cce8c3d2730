"""The planner's engines beside exhaustive search: a campaign of `make campaign`."""

from __future__ import annotations

import sys

from comparing.campaign import Kind, Subject, main

from core.order_comparison import compare_orders, compare_pairs
from core.planner_comparison import compare_engines

SUBJECT = Subject(
    "planning",
    "Planner's engines beside exhaustive search",
    "Random small stations with random goals; half of them with formulas, offline resources, restart abilities and\n"
    "conditions to avoid, a quarter from states with unknown values. Every engine is asked under both contracts.\n"
    "Plans must replay on the reference tick, minimal ones have as few ticks and then starts as breadth-first search\n"
    "finds, and there is a proof only where no run at all reaches the goals.\n"
    "*Orders* are those in which starts of one tick are tried, at stations of five to eight abilities on few\n"
    "variables: a tick must end in all states in which any order of starts ends, with as few starts.\n"
    "*Pairs* are of abilities of such stations: whether their order matters is looked up in all states.",
    {
        "problems": Kind(compare_engines, 10_000),
        "orders": Kind(compare_orders, 10_000),
        "pairs": Kind(compare_pairs, 5_000),
    },
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
