"""The truck engine station of eight nodes under random faults: a campaign of `make campaign`."""

from __future__ import annotations

import sys
from collections import Counter

from comparing.campaign import Kind, Subject, main

from stations.disturbing import assembled

MINUTES, SPEED = 5, 2.0


def five_minutes(seed: str) -> Counter[str]:
    """Five minutes of the station's life. AssertionError for a wrong step, a wrong engine, or a station that stands."""
    return assembled(60 * MINUTES, seed, SPEED)


SUBJECT = Subject(
    "station",
    "The truck engine station under faults",
    "Eight nodes, the world in which their devices stand, and the controller with its planner, each a process of its\n"
    f"own, with devices {SPEED:g} times as fast as real ones. Nodes fall silent, repeat themselves, talk nonsense,\n"
    "leave the network, are killed and started again; devices stand still for a while; the operator is slow.\n"
    "Whether a step or an engine is wrong is said by the world alone, which knows nothing of the model. A spell is\n"
    f"{MINUTES} minutes.",
    {"spells": Kind(five_minutes, 6, kept_every=1)},
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
