"""A MES that orders for a day at a station with faults, whose processes are killed: a campaign of `make campaign`."""

from __future__ import annotations

import os
import sys
import tempfile
from collections import Counter

from comparing.campaign import Kind, Subject, main

from running.day_stations import bolt_station, engine_station
from running.days import day
from running.queues import PRESSES, queue

BOLT_ORDERS, BOLT_TROUBLES = 8, 6  # of one day
ENGINE_ORDERS, ENGINE_TROUBLES = 6, 9
QUEUED, KILLS = 1000, 10


def bolts(seed: str) -> Counter[str]:
    """A day at the bolt tightening station."""
    return day(bolt_station, seed, BOLT_ORDERS, BOLT_TROUBLES)


def engines(seed: str) -> Counter[str]:
    """A day at the truck engine station."""
    return day(engine_station, seed, ENGINE_ORDERS, ENGINE_TROUBLES)


def queues(seed: str) -> Counter[str]:
    """A long queue of orders, all of them given at once."""
    return queue(seed, QUEUED, KILLS)


SUBJECT = Subject(
    "orders",
    "A MES that orders for a day",
    "The MES simulator of `docs/examples` orders at a station of real processes with DDS and REST. It sends some\n"
    "orders twice, and changes, pauses, stops or aborts some. Meanwhile, at moments drawn by seed, devices have\n"
    "faults, or `kill -9` ends the server, the controller, or both, which people then bring back to work. In the end\n"
    "all orders must be over, the abilities and operations of all responses must be exactly those that the run's\n"
    "journal has, each once, and so must those of the events; and the webhook of an administrator must have been told\n"
    "each event, signed.\n"
    f"*Bolts* are days at the bolt tightening station, with {BOLT_ORDERS} orders and {BOLT_TROUBLES} troubles each.\n"
    "*Engines* are days at the truck engine station: eight nodes and the world in which their devices stand, each a\n"
    f"process of its own, with {ENGINE_ORDERS} orders and {ENGINE_TROUBLES} troubles. Faults are those that pass by\n"
    "themselves, and others: the robot trips between two poses, a device stands still, the computer of one is gone.\n"
    "Somebody asks the station for advice then, in restart mode, and does what that says. The world, which knows\n"
    "nothing of the model, has the last word: nothing collided, was dropped or tightened twice, and each engine that\n"
    "was released was built rightly, also one that several orders worked at as the first was stopped or aborted.\n"
    f"A *queue* is {QUEUED} orders for {PRESSES} presses, stored one after the other, and worked to the end while\n"
    f"{KILLS} times the server, the controller or both are killed. What is measured is measured meanwhile; of several\n"
    "queues it is what was the most.",
    {
        "bolts": Kind(bolts, 6, kept_every=1),
        "engines": Kind(engines, 3, kept_every=1),
        "queues": Kind(queues, 1, kept_every=1),
    },
)

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as kept:
        os.environ |= {"XDG_STATE_HOME": f"{kept}/state", "XDG_CACHE_HOME": f"{kept}/cache"}
        sys.exit(main(SUBJECT))
