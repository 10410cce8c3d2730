"""The compiled tick beside the reference: a campaign of `make campaign`."""

from __future__ import annotations

import sys
from functools import partial

from comparing.campaign import Kind, Subject, main

from core.random_ticks import compare_by_seed

TICKS = 12  # of each automaton

SUBJECT = Subject(
    "compiled-tick",
    "Compiled tick beside the reference",
    f"Random automata with random runs of {TICKS} ticks; after every step the states, the finished and the\n"
    "conflicting abilities, the active operations and the abilities that may start are compared.",
    {"automata": Kind(partial(compare_by_seed, ticks=TICKS), 50_000)},
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
