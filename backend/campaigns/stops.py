"""Stops that were accepted, through kills, outages and takeovers: a campaign of `make campaign`."""

from __future__ import annotations

import sys
from collections import Counter

from comparing.campaign import Kind, Subject, main

from running import stops

KILLS, TAKEOVERS = 10, 5  # of one station, and of one pair


def stations(seed: str) -> Counter[str]:
    """One station, whose controller is killed right after the answer."""
    return stops.kills(seed, KILLS)


def pairs(seed: str) -> Counter[str]:
    """Two stations, of which one takes over by itself."""
    return stops.takeovers(seed, TAKEOVERS)


SUBJECT = Subject(
    "stops",
    "Stops that were accepted",
    "Somebody pauses or holds the bolt tightening station, real processes with DDS and REST, while it works. The law:\n"
    "no start after a stop that was accepted, until a person lets the station go on.\n"
    f"*Stations* are one with SQLite, stopped {KILLS} times; its controller is killed 0 to 5 ms after the answer,\n"
    "half of the times while another program keeps the database from being written to. It must begin as it was told\n"
    f"to be. *Pairs* are two on one PostgreSQL with `takeover: automatic`, stopped {TAKEOVERS} times, before or after\n"
    "the one that commands is killed, halted (SIGSTOP), cut off from the database, or the database is away for both;\n"
    "then up to three more such events follow in an order drawn by seed, within milliseconds or seconds, restarts and\n"
    f"the end of the outage among them. After that nobody says anything for {stops.WATCHED:g} s, all is brought back,\n"
    "and nobody says anything for as long again. At the end the journal of all of it is judged by the law, and done\n"
    "again as in `kills`.",
    {
        "stations": Kind(stations, 5, kept_every=1),
        "pairs": Kind(pairs, 5, kept_every=1),
    },
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
