"""The truck engine station of eight nodes under random faults: a campaign of `make campaign`."""

from __future__ import annotations

import os
import sys
import tempfile
from collections import Counter

from comparing.campaign import Kind, Subject, main

from stations.dead_robot import worked_around
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
    f"{MINUTES} minutes.\n"
    "A death is one engine at one of whose bolts, drawn by seed, the robot stands still and its node is killed.\n"
    "What is done then is what the station says through REST: it is held, the advice is to take over, the watch\n"
    "asks for the nutrunner to be taken off the robot and for each bolt to be tightened by hand; after its repair\n"
    "the robot goes on.",
    {"spells": Kind(five_minutes, 6, kept_every=1), "deaths": Kind(worked_around, 6, kept_every=1)},
)

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as kept:
        os.environ |= {"XDG_STATE_HOME": f"{kept}/state", "XDG_CACHE_HOME": f"{kept}/cache"}
        sys.exit(main(SUBJECT))
