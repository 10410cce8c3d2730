"""A MES that orders for a day at a station with faults, whose processes are killed: a campaign of `make campaign`."""

from __future__ import annotations

import sys
from collections import Counter

from comparing.campaign import Kind, Subject, main

from running import days

ORDERS, TROUBLES = 8, 6  # of one day


def orders(seed: str) -> Counter[str]:
    """A day."""
    return days.day(seed, ORDERS, TROUBLES)


SUBJECT = Subject(
    "orders",
    "A MES that orders for a day",
    "The MES simulator of `docs/examples` orders at the bolt tightening station, real processes with DDS and REST.\n"
    f"In each day it gives {ORDERS} orders, some of them twice, and changes, pauses, stops or aborts some. Meanwhile\n"
    f"{TROUBLES} times, at moments drawn by seed, a device has a fault, or `kill -9` ends the server or the\n"
    "controller, which people then bring back to work. In the end all orders must be over, the abilities and\n"
    "operations of all responses must be exactly those that the run's journal has, each once, and so must those of\n"
    "the events; and the webhook of an administrator must have been told each event, signed.",
    {"days": Kind(orders, 6, kept_every=1)},
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
