"""Stations that are stopped and get back to work through REST alone: a campaign of `make campaign`."""

from __future__ import annotations

import os
import sys
import tempfile

from comparing.campaign import Kind, Subject, main

from running.back_to_work.ways import bolt_ways, engine_ways

SUBJECT = Subject(
    "restart",
    "Getting back to work",
    "A station at work is stopped in some ways drawn by seed: devices stand still, are away, are moved by hand, the\n"
    "product is not what is believed, the controller is killed, somebody holds it in the middle of an operation.\n"
    "It gets back to work through REST alone: by the advice, the questions and the refusals of the station, and what\n"
    "somebody beside it does with their hands. A spell is five ways, one of each kind among them, and then one more\n"
    "engine. `bolts` is the bolt tightening station with emulated devices, `engines` the truck engine station with\n"
    "its eight nodes. Whether engines are built rightly is said by what is true there, which nobody looks at before.",
    {"bolts": Kind(bolt_ways, 4, kept_every=1), "engines": Kind(engine_ways, 4, kept_every=1)},
)

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as kept:
        os.environ |= {"XDG_STATE_HOME": f"{kept}/state", "XDG_CACHE_HOME": f"{kept}/cache"}
        sys.exit(main(SUBJECT))
