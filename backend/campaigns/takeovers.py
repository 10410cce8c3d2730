"""Two stations of which one takes over from the other, again and again: a campaign of `make campaign`."""

from __future__ import annotations

import sys
from collections import Counter

from comparing.campaign import Kind, Subject, main

from running import takeovers

NUMBER = 10  # of one pair


def pairs(seed: str) -> Counter[str]:
    """A pair of stations."""
    return takeovers.takeovers(seed, NUMBER)


SUBJECT = Subject(
    "takeovers",
    "A hot standby that takes over",
    "Two bolt tightening stations for the same devices share a PostgreSQL server, real processes with DDS and REST;\n"
    f"the model says `takeover: automatic`. {NUMBER} times the one that commands is killed, killed and started again\n"
    "at once, stopped (SIGSTOP) and let go on after the other has taken over, or cut off from the database, drawn by\n"
    f"seed. Each time the other has to command within {takeovers.SOON:g} s. Where another process beside the killed\n"
    "one says in time that all is recorded it goes on with production by itself, unless a person has to decide what\n"
    "an output shall be; else it begins paused, says why, and a person lets it go on. A foreign subscriber may hear\n"
    "nobody again once another has spoken; and at the end the journal of all of them is done again, as in `kills`.",
    {"pairs": Kind(pairs, 3, kept_every=1)},
)

if __name__ == "__main__":
    sys.exit(main(SUBJECT))
