"""Addresses that name nothing, whatever they hold: each route says so, and none fails."""

from __future__ import annotations

import re
from pathlib import Path

import httpx
import pytest

from sequence_planner.actor import Actor, ActorKind
from sequence_planner.control.production_commands import ServiceKind, SetService
from sequence_planner.control.recording import entry_of
from sequence_planner.identity.roles import Role
from sequence_planner.journal.entry import LONGEST_SUBJECT

from .fuzzing import documented, station
from .test_acting import problem

ODD = [
    "x" * 400,
    "x" * 8000,
    "%00",
    "a%00b",
    "%0d%0aX-More:%201",
    "%1b%5b2J",
    "%ff%fe",
    "%ed%a0%80",
    "%E2%80%AE",
    "..%2f..%2fetc%2fpasswd",
    "%2e%2e",
    "'%3b--",
    "-1",
    "9" * 400,
    "%25",
    "robot[%22",
]
BODIES: list[object] = [{}, {"in_service": False, "reason": "x"}, {"reason": "x"}, {"over": None}]


def test_no_route_fails_for_what_stands_in_its_address(tmp_path: Path) -> None:
    with station(tmp_path, with_model=True) as (server, _), server.client(Role.ADMINISTRATOR) as client:
        client.timeout = httpx.Timeout(60)
        routes = [(verb, path) for path, verbs in documented(server)["paths"].items() for verb in verbs if "{" in path]
        assert len(routes) > 20
        for verb, path in routes:
            for odd in ODD:
                address = re.sub(r"\{(?!of\})\w+\}", odd, path).replace("{of}", "resource")
                for body in BODIES if verb in ("put", "post", "patch") else [None]:
                    answer = client.request(verb, address, json=body)
                    # The controller of these tests does whatever it is told to, and knows no past.
                    assert answer.status_code < 500 or "/history" in path, (verb, address[:100], body, answer.text)
                    if answer.status_code >= 400:
                        assert answer.headers["content-type"] == "application/problem+json"
                    if odd in ("%00", "a%00b", "%ff%fe", "%1b%5b2J"):
                        problem(answer, 404, "not-found")


@pytest.mark.parametrize("address", ["/api/v1/audit?action=%00", "/api/v1/model/files?path=a%00b"])
def test_no_question_holds_what_no_database_keeps(client: httpx.Client, address: str) -> None:
    problem(client.get(address), 422, "invalid-request")


@pytest.mark.parametrize("of", ServiceKind)
def test_a_command_about_the_longest_name_can_be_recorded(of: ServiceKind) -> None:
    eva = Actor(kind=ActorKind.PERSON, id="1", name="Eva")
    command = SetService(actor=eva, of=of, name="x" * 400, in_service=False, reason="why")
    entry = entry_of(command)
    assert len(entry.subject) == LONGEST_SUBJECT
    assert entry.details["name"] == command.name
