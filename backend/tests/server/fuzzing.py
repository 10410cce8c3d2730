"""Requests drawn from the server's own OpenAPI document by schemathesis, and what is wrong with the answers.

They come as somebody with a role, whose session is opened anew whenever a request has ended it, or as nobody.
Schemathesis is used as a library: its plug-in of pytest would cost every run of the tests half a second.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import schemathesis
from schemathesis import AuthContext, AuthProvider, Case, CheckContext, Response
from schemathesis.engine import events, from_schema

from controller.test_network_watch import REPORTS
from sequence_planner.auth.roles import Role
from sequence_planner.auth.sessions import find_session
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.server.http.credentials import session_cookie
from support.server import Loop, Server, settings_in

from .test_looking import Telling, network

PHASES = ("examples", "coverage", "fuzzing", "stateful")
PATIENCE = 10.0  # seconds
MEDIA_TYPE = "application/problem+json"


@dataclass
class Found:
    """What a run has seen: how often each operation gave which status, and what was wrong, with how to repeat it."""

    statuses: dict[str, Counter[int]] = field(default_factory=dict)
    wrong: dict[str, str] = field(default_factory=dict)

    @property
    def requests(self) -> int:
        return sum(counter.total() for counter in self.statuses.values())


@schemathesis.check
def described(ctx: CheckContext, response: Response, case: Case[Any]) -> None:
    """The status is named in the document itself, not left to `default`, and a refusal is a problem that says why."""
    status = response.status_code
    if status >= 400:
        assert response.headers["content-type"] == [MEDIA_TYPE]
        problem = response.json()
        assert problem["status"] == status
        assert problem["type"].startswith("/problems/")
        assert problem["title"]
        assert problem["detail"]
    if case.method.upper() == case.operation.method.upper():
        assert str(status) in case.operation.responses.status_codes, f"{status} is not described"


@contextmanager
def station(folder: Path, *, with_model: bool = False) -> Iterator[tuple[Server, Telling]]:
    """A server whose operations have something to answer, those about the model and the past only where it has a model;
    and its controller. Files go to `folder`.
    """
    (model := folder / "model").mkdir()
    (model / "station.yaml").write_text("name: cell\n", encoding="utf-8")
    settings = replace(settings_in(folder), model=model if with_model else None)
    path = settings.controller_socket
    loop = Loop()
    controller, server = Telling(loop, path), Server(loop, settings)
    controller.link = ControllerLink(path, controller.handle, controller.answer)
    controller.of_now = True
    controller.start()
    server.start()
    try:
        server.hear_controller()
        controller.tell(network(REPORTS))
        yield server, controller
    finally:
        server.stop()
        controller.stop()
        loop.close()


def documented(server: Server) -> dict[str, Any]:
    """The document as the server gives it; its cookies have the names that they have on the loopback."""
    with server.client(Role.VIEWER) as client:
        found: dict[str, Any] = client.get("/api/v1/openapi.json", timeout=60.0).raise_for_status().json()
    found["components"]["securitySchemes"]["session"]["name"] = session_cookie(server.settings)
    return found


def fuzz(
    server: Server,
    role: Role | None,
    *,
    examples: int,
    phases: Collection[str] = PHASES,
    seed: int = 1,
    without_edges: Collection[str] = (),
) -> Found:
    """Try every operation as somebody with `role`, or as nobody, with so many drawn requests each beside the edges,
    unless it is one of those `without_edges`.
    """
    config = schemathesis.Config.from_dict(
        {
            "seed": seed,
            "cache": {"enabled": False},  # nothing that one run has learnt changes the next
            "base-url": server.address,
            "request-timeout": PATIENCE,
            "continue-on-failure": True,
            "generation": {"max-examples": examples, "no-shrink": True, "database": "none"},
            "phases": {name: {"enabled": name in phases} for name in PHASES},
            "operations": [
                {"include-name": each, "phases": {"coverage": {"enabled": False}}} for each in sorted(without_edges)
            ],
            "checks": {"positive_data_acceptance": {"enabled": False}},  # what else must hold is for the station to say
        }
    )
    schema = schemathesis.openapi.from_dict(documented(server), config=config)
    if role is not None:
        schema.auth(refresh_interval=None)(signed_in(server, role))
    found = Found()
    for event in from_schema(schema).execute():
        if isinstance(event, events.ScenarioFinished):
            _note(event, found)
        elif isinstance(event, events.NonFatalError):
            found.wrong[f"{event.label}: {event.value!r}"] = ""
        elif isinstance(event, events.FatalError):
            raise event.exception
    return found


def signed_in(server: Server, role: Role) -> type[AuthProvider[str]]:
    """Gives each request the session of somebody with `role`."""

    class Signed:
        token = ""

        def get(self, case: Case[Any], context: AuthContext) -> str:
            with server.identity.database.reading() as connection:
                live = find_session(connection, self.token, server.identity.now())
            if live is None:
                self.token = server.session(server.person(role))[0]
            return self.token

        def set(self, case: Case[Any], data: str, context: AuthContext) -> None:
            case.cookies = {**(case.cookies or {}), session_cookie(server.settings): data}

    return Signed


def _note(event: events.ScenarioFinished, found: Found) -> None:
    seen = event.recorder
    for identifier, interaction in seen.interactions.items():
        label = seen.cases[identifier].value.operation.label
        if interaction.response is not None:
            found.statuses.setdefault(label, Counter())[interaction.response.status_code] += 1
    for checks in seen.checks.values():
        for each in checks:
            if each.failure_info is not None:
                failure = each.failure_info.failure
                found.wrong.setdefault(
                    f"{failure.operation}: {failure.title}: {failure.message}", each.failure_info.code_sample
                )
