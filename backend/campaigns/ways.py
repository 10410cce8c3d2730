"""Ways back that a person can trust: a campaign of `make campaign`."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable

from comparing.campaign import REPOSITORY, Kind, Subject, main

sys.path.insert(0, str(REPOSITORY / "backend" / "tests"))  # or a campaign would stand for the tests of that name
from controller import ways
from planning.advice import rules

DEADLINE = 3.0  # seconds for an answer


def proposed(name: str) -> Callable[[str], Counter[str]]:
    """What is proposed after a fault keeps the rules."""
    return lambda seed: rules.after_a_fault(name, seed, DEADLINE)


def taken(name: str) -> Callable[[str], Counter[str]]:
    """What is proposed after a fault or several comes to its end."""
    return lambda seed: ways.after_a_fault(name, seed, DEADLINE)


LARGE = "truck_engine_station"
SUBJECT = Subject(
    "ways",
    "Ways back that a person can trust",
    "Faults are drawn at moments of the main job of each station in `models`. What is proposed then contradicts no\n"
    "answer, names what it would claim of the product, has what devices or people do before what is only said, and\n"
    "what says that work is done apart and last (`proposed`). Each way that is proposed, after up to three faults at\n"
    "once, is taken, while devices and people do what they may in any order: it comes to its end, inside the safe\n"
    "states, or is over because no order of what may happen leads there any more (`taken`).",
    {
        **{f"proposed_{name}": Kind(proposed(name), 60 if name == LARGE else 300, 20) for name in rules.STATIONS},
        **{f"taken_{name}": Kind(taken(name), 60 if name == LARGE else 300, 20) for name in rules.STATIONS},
    },
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
