"""Each fault of an emulated station in turn, and what is proposed then: a campaign of `make campaign`."""

from __future__ import annotations

import os
import sys
import tempfile

from comparing.campaign import Kind, Subject, main

from running.faults import KINDS, PROPOSED_WITHIN, SPEED, TOLD_WITHIN, one_fault

SUBJECT = Subject(
    "faults",
    "What is proposed after a fault",
    "The truck engine station runs with emulated devices, real processes with DDS and REST, its devices and time-outs\n"
    f"{SPEED} times as fast. In the middle of the work one thing goes wrong: of each resource that it is\n"
    f"{', '.join(KINDS)}; of measured variables that they are wrong, or changed by hand; that a person holds\n"
    "the station, or takes a resource out of service. If somebody is told within\n"
    f"{TOLD_WITHIN:g} s, advice is asked for at once: it must answer within {PROPOSED_WITHIN:g} s with proposals or\n"
    "reasons, and propose nothing at a device that would not stay so. Where nobody is told, the work must go on.",
    {"faults": Kind(one_fault, 60, kept_every=1)},
)

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as kept:
        os.environ |= {"XDG_STATE_HOME": f"{kept}/state", "XDG_CACHE_HOME": f"{kept}/cache"}
        sys.exit(main(SUBJECT))
