"""A station whose controller is killed and whose devices have faults: a campaign of `make campaign`."""

from __future__ import annotations

import sys
from collections import Counter

from comparing.campaign import Kind, Subject, main

from controller.faulty import after_fault
from running import forked, killing

FORKED, REAL = 10, 5  # times that one station's controller is killed
TROUBLES = 4  # of one station


def controllers(seed: str) -> Counter[str]:
    """A controller beside its devices, killed so many times."""
    return forked.apart(seed, FORKED)


def stations(seed: str) -> Counter[str]:
    """Real processes on a real network."""
    return killing.lives(seed, REAL)


def troubles(seed: str) -> Counter[str]:
    """Real processes, of which others than the controller die, and a disk without room."""
    return killing.troubles(seed, TROUBLES)


SUBJECT = Subject(
    "kills",
    "Controllers that are killed, and devices with faults",
    "`kill -9` of the controller of the bolt tightening station at moments drawn by seed, while its devices go on.\n"
    f"*Controllers* is the whole controller with its journal, forked and killed {FORKED} times for each; its network\n"
    f"is a pipe. *Stations* are real processes with DDS and REST, whose controller is killed {REAL} times for each.\n"
    "In three lives of ten the clock that people read is set by up to two hours, forward or back.\n"
    f"*Troubles* are {TROUBLES} for each such station, which goes on by itself: the planner and what else the\n"
    "controller has started are killed, or the server is, or the controller can write to no file any more; then\n"
    "somebody is told, and nothing is commanded.\n"
    "Each time somebody decides on the outputs that came back, drawn among the value that came back and the quiet\n"
    "ones, starts production, and the work must go on. What was said to be durable or was shown must be there, and\n"
    "chained; at the end all of the journal is done again, bit for bit: no ability is started that has not ended\n"
    "since it was, no start leads out of the safe states, and each command that a device has heard is in the journal,\n"
    "in this order. *Faults* are those of one device at one step of the main job, in simulated time: no start leads\n"
    "out of the safe states, and the work goes on, or the advisor has a way.",
    {
        "controllers": Kind(controllers, 100, kept_every=1),
        "stations": Kind(stations, 10, kept_every=1),
        "troubles": Kind(troubles, 10, kept_every=1),
        "faults": Kind(after_fault, 300, kept_every=10),
    },
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
