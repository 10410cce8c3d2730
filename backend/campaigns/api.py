"""The server beside its own OpenAPI document, on many more requests: a campaign of `make campaign`."""

from __future__ import annotations

import logging
import sys
import tempfile
import zlib
from collections import Counter
from pathlib import Path

import structlog
from comparing.campaign import Kind, Subject, main

from sequence_planner.auth.roles import Role
from server.fuzzing import fuzz, station

EXAMPLES = 50
WHO = (Role.ADMINISTRATOR, Role.OPERATOR, Role.VIEWER, None)


def as_one(seed: str) -> Counter[str]:
    """Requests of somebody with one of the roles, or of nobody. AssertionError for an answer that is not described."""
    role = WHO[int(seed.rpartition(".")[2]) % len(WHO)]
    with tempfile.TemporaryDirectory() as folder, station(Path(folder), with_model=True) as (server, _):
        found = fuzz(server, role, examples=EXAMPLES, seed=zlib.crc32(seed.encode()))
    assert not found.wrong, "; ".join(found.wrong)
    answers = sum(found.statuses.values(), Counter[int]())
    return Counter({f"answers {status}": number for status, number in answers.items()})


SUBJECT = Subject(
    "api",
    "The REST interface beside its description",
    "Requests that schemathesis draws from the server's own OpenAPI document, right ones and wrong ones, to a server\n"
    "with its database and the link to a controller. A round is one of an administrator, an operator, a viewer or\n"
    f"nobody in turn: the edges of every schema, {EXAMPLES} drawn requests for each operation, and chains of them.\n"
    "No answer is an error of the server; each has a status, a media type, headers and a content that the document\n"
    "names for this operation; every refusal is a problem document; nobody is let in without credentials.",
    {"rounds": Kind(as_one, 12, kept_every=1)},
)

if __name__ == "__main__":
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.ERROR))
    sys.exit(main(SUBJECT))
