"""Every address and every stream, tried by everybody who may knock."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from http.client import HTTPConnection
from pathlib import Path
from typing import Any, NamedTuple

import httpx
import pytest
from fastapi import APIRouter, FastAPI
from fastapi.routing import iter_route_contexts

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.server.auth import allowed, check_declared
from support.server import Controller, Loop, Server, settings_in
from support.waiting import PATIENCE

from .bearers import Bearer, Headers, everybody

PUBLIC, WATCH, BESIDE = "public", "watch", "beside"
PERMITTED = "permitted"
BODILESS = ("GET", "DELETE")
STATUS = {
    "signed-out": 401,
    "role-too-low": 403,
    "scope-missing": 403,
    "password-must-change": 403,
    "wearable-unconfirmed": 403,
    "foreign-origin": 403,
    "wrong-host": 421,
}
OPENAPI = "GET /api/v1/openapi.json"
ANY_KEY = "any"  # in the place of a scope: every key that is valid

# Who may use what: role and scope. Whoever loosens a route has to say so here.
DECLARED: dict[str, tuple[str, str | None]] = {
    "GET /healthz": ("public", None),
    "GET /readyz": ("public", None),
    "GET /metrics": ("beside", "metrics"),
    "GET /api/v1/session": ("public", None),
    "POST /api/v1/session": ("public", None),
    "POST /api/v1/session/demonstration": ("public", None),
    "POST /api/v1/session/provider": ("public", None),
    "POST /api/v1/session/provider/answer": ("public", None),
    "POST /api/v1/setup": ("public", None),
    "POST /api/v1/wearables/pairing": ("public", None),
    "GET /api/v1/wearables/names": ("watch", None),
    "GET /api/v1/wearables/self": ("watch", None),
    "WS /api/v1/wearables/stream": ("watch", None),
    "DELETE /api/v1/session": ("viewer", None),
    "PUT /api/v1/session/password": ("viewer", None),
    OPENAPI: ("viewer", ANY_KEY),
    "GET /api/v1/station": ("viewer", "read"),
    "GET /api/v1/state": ("viewer", "read"),
    "GET /api/v1/resources": ("viewer", "read"),
    "GET /api/v1/operations": ("viewer", "read"),
    "GET /api/v1/abilities": ("viewer", "read"),
    "GET /api/v1/plan": ("viewer", "read"),
    "GET /api/v1/tasks": ("viewer", "read"),
    "GET /api/v1/topics": ("viewer", "read"),
    "GET /api/v1/overrides": ("viewer", "read"),
    "GET /api/v1/analysis": ("viewer", "read"),
    "GET /api/v1/alarms": ("viewer", "read"),
    "GET /api/v1/model": ("viewer", "read"),
    "GET /api/v1/model/files": ("viewer", "read"),
    "GET /api/v1/model/check": ("viewer", "read"),
    "GET /api/v1/model/check/findings/{finding}/run": ("viewer", "read"),
    "WS /api/v1/model/stream": ("viewer", "read"),
    "GET /api/v1/model/changes": ("viewer", "read"),
    "POST /api/v1/model/changes": ("engineer", None),
    "POST /api/v1/model/language/check": ("viewer", "read"),
    "POST /api/v1/model/language/completion": ("viewer", "read"),
    "POST /api/v1/model/language/hover": ("viewer", "read"),
    "POST /api/v1/model/language/format": ("viewer", "read"),
    "POST /api/v1/model/outlines/preview": ("viewer", "read"),
    "GET /api/v1/model/revisions": ("viewer", "read"),
    "GET /api/v1/model/comparison": ("viewer", "read"),
    "GET /api/v1/model/transfer": ("viewer", "read"),
    "POST /api/v1/model/revisions": ("engineer", None),
    "POST /api/v1/model/revisions/{id}/restore": ("engineer", None),
    "POST /api/v1/model/what-if": ("engineer", None),
    "POST /api/v1/model/what-if/steps": ("engineer", None),
    "POST /api/v1/model/what-if/state-space": ("engineer", None),
    "POST /api/v1/model/recordings": ("engineer", None),
    "GET /api/v1/model/recordings/{id}": ("engineer", None),
    "GET /api/v1/model/recordings/{id}/state": ("engineer", None),
    "DELETE /api/v1/model/recordings/{id}": ("engineer", None),
    "POST /api/v1/model/simulations": ("engineer", None),
    "POST /api/v1/model/simulations/{id}/advance": ("engineer", None),
    "POST /api/v1/model/simulations/{id}/scenario": ("engineer", None),
    "GET /api/v1/model/scenarios": ("engineer", None),
    "POST /api/v1/model/scenarios/run": ("engineer", None),
    "POST /api/v1/model/deployments": ("engineer", None),
    "GET /api/v1/model/comments": ("viewer", "read"),
    "POST /api/v1/model/comments": ("engineer", None),
    "POST /api/v1/model/revisions/{id}/reviews": ("engineer", None),
    "GET /api/v1/model/deployments/planned": ("viewer", "read"),
    "PUT /api/v1/model/deployments/planned": ("engineer", None),
    "DELETE /api/v1/model/deployments/planned": ("engineer", None),
    "POST /api/v1/model/rename": ("engineer", None),
    "GET /api/v1/model/usages": ("viewer", "read"),
    "GET /api/v1/model/graph": ("viewer", "read"),
    "GET /api/v1/model/folds": ("viewer", "read"),
    "GET /api/v1/model/mimic": ("viewer", "read"),
    "GET /api/v1/model/operations": ("viewer", "read"),
    "POST /api/v1/model/begin": ("engineer", None),
    "GET /api/v1/examples": ("viewer", "read"),
    "GET /api/v1/model/outlines": ("viewer", "read"),
    "POST /api/v1/model/undo": ("engineer", None),
    "POST /api/v1/model/redo": ("engineer", None),
    "GET /api/v1/mimic": ("viewer", "read"),
    "GET /api/v1/names": ("viewer", "read"),
    "GET /api/v1/ros/graph": ("viewer", "read"),
    "GET /api/v1/pipelines": ("viewer", "read"),
    "GET /api/v1/pipelines/edges": ("viewer", "read"),
    "GET /api/v1/abilities/{name}/blockers": ("viewer", "read"),
    "GET /api/v1/operations/{name}/blockers": ("viewer", "read"),
    "GET /api/v1/operations/{name}/definition": ("viewer", "read"),
    "GET /api/v1/variables/{name}/trace": ("viewer", "read"),
    "POST /api/v1/goals/blockers": ("engineer", None),
    "GET /api/v1/abilities/{name}/definition": ("viewer", "read"),
    "POST /api/v1/test-runs": ("engineer", None),
    "GET /api/v1/recovery/proposals": ("operator", None),
    "POST /api/v1/operator-plans/goal-preview": ("engineer", None),
    "POST /api/v1/operator-plans/reset-preview": ("operator", None),
    "POST /api/v1/operator-plans": ("operator", None),
    "POST /api/v1/operator-plans/stop": ("operator", None),
    "WS /api/v1/stream": ("viewer", "read"),
    "WS /api/v1/ros/stream": ("viewer", "read"),
    "WS /api/v1/pipelines/stream": ("viewer", "read"),
    "PUT /api/v1/mode": ("operator", None),
    "POST /api/v1/production/start": ("operator", None),
    "POST /api/v1/restart/enter": ("operator", None),
    "POST /api/v1/restart/leave": ("operator", None),
    "PUT /api/v1/settings/job-mode": ("operator", None),
    "PUT /api/v1/mode/cycle-stop": ("operator", None),
    "PUT /api/v1/stepping": ("engineer", None),
    "POST /api/v1/breakpoints": ("engineer", None),
    "DELETE /api/v1/breakpoints/{id}": ("engineer", None),
    "POST /api/v1/stepping/step": ("engineer", None),
    "PUT /api/v1/availability/{kind}/{name}": ("operator", None),
    "PUT /api/v1/forces/{name}": ("engineer", None),
    "DELETE /api/v1/forces/{name}": ("engineer", None),
    "POST /api/v1/tasks/{task}/acknowledgement": ("operator", None),
    "POST /api/v1/tasks/{task}/problem": ("operator", None),
    "POST /api/v1/tasks/{task}/problem/solved": ("operator", None),
    "PUT /api/v1/overrides/{name}": ("operator", None),
    "DELETE /api/v1/overrides/{name}": ("operator", None),
    "POST /api/v1/alarms/acknowledge": ("operator", None),
    "POST /api/v1/alarms/shelve": ("operator", None),
    "POST /api/v1/alarms/unshelve": ("operator", None),
    "POST /api/v1/alarms/suppress": ("engineer", None),
    "POST /api/v1/alarms/restore": ("engineer", None),
    "POST /api/v1/corrections/preview": ("operator", None),
    "POST /api/v1/corrections": ("operator", None),
    "POST /api/v1/corrections/undo": ("operator", None),
    "POST /api/v1/corrections/confirm": ("operator", None),
    "PUT /api/v1/restored-outputs": ("operator", None),
    "POST /api/v1/approvals/corrections": ("operator", None),
    "POST /api/v1/approvals/restored-outputs": ("operator", None),
    "POST /api/v1/approvals/forces": ("engineer", None),
    "POST /api/v1/approvals/{request}/approve": ("operator", None),
    "POST /api/v1/approvals/{request}/decline": ("operator", None),
    "PUT /api/v1/control-lock": ("operator", None),
    "DELETE /api/v1/control-lock": ("operator", None),
    "GET /api/v1/wearables": ("operator", None),
    "POST /api/v1/wearables/offers": ("operator", None),
    "DELETE /api/v1/wearables/offers/{offer}": ("operator", None),
    "POST /api/v1/wearables/{watch}/confirmation": ("operator", None),
    "DELETE /api/v1/wearables/{watch}": ("operator", None),
    "GET /api/v1/audit": ("operator", "audit"),
    "GET /api/v1/history": ("operator", "audit"),
    "GET /api/v1/history/at": ("operator", "audit"),
    "GET /api/v1/history/line": ("operator", "audit"),
    "GET /api/v1/history/export": ("operator", "audit"),
    "GET /api/v1/history/checkpoint": ("operator", "audit"),
    "GET /api/v1/history/{number}": ("operator", "audit"),
    "POST /api/v1/history/{number}/branch": ("engineer", None),
    "POST /api/v1/ros/attachments": ("engineer", None),
    "GET /api/v1/model/pipelines": ("viewer", "read"),
    "POST /api/v1/model/pipelines/suggestions": ("viewer", "read"),
    "POST /api/v1/model/pipelines/preview": ("viewer", "read"),
    "POST /api/v1/model/pipelines/examples": ("viewer", "read"),
    "POST /api/v1/model/pipelines/test-runs": ("viewer", "read"),
    "POST /api/v1/model/pipelines/recordings": ("engineer", None),
    "GET /api/v1/job-orders": ("viewer", "orders-read"),
    "GET /api/v1/job-orders/{id}": ("viewer", "orders-read"),
    "POST /api/v1/job-orders": ("operator", "orders-write"),
    "PUT /api/v1/job-orders/{id}": ("operator", "orders-write"),
    "POST /api/v1/job-orders/{id}/commands": ("operator", "orders-write"),
    "GET /api/v1/job-responses": ("viewer", "orders-read"),
    "GET /api/v1/job-responses/{id}": ("viewer", "orders-read"),
    "GET /api/v1/events": ("viewer", "orders-read"),
    "GET /api/v1/capabilities": ("viewer", "orders-read"),
    "GET /api/v1/schedule": ("viewer", "orders-read"),
    "GET /api/v1/figures": ("viewer", "read"),
    "GET /api/v1/instructions/{name}": ("viewer", "read"),
    "GET /api/v1/wall": ("viewer", "read"),
    "GET /api/v1/webhooks": ("administrator", "webhooks"),
    "POST /api/v1/webhooks": ("administrator", "webhooks"),
    "GET /api/v1/webhooks/{webhook}": ("administrator", "webhooks"),
    "DELETE /api/v1/webhooks/{webhook}": ("administrator", "webhooks"),
    "GET /api/v1/webhooks/{webhook}/dead-letters": ("administrator", "webhooks"),
    "POST /api/v1/webhooks/{webhook}/dead-letters/retry": ("administrator", "webhooks"),
    "GET /api/v1/backups": ("administrator", None),
    "POST /api/v1/backups": ("administrator", None),
    "POST /api/v1/backups/{file}/check": ("administrator", None),
    "GET /api/v1/storage": ("administrator", None),
    "POST /api/v1/storage/archive": ("administrator", None),
    "GET /api/v1/users": ("administrator", None),
    "POST /api/v1/users": ("administrator", None),
    "PATCH /api/v1/users/{person}": ("administrator", None),
    "PUT /api/v1/users/{person}/password": ("administrator", None),
    "DELETE /api/v1/users/{person}/sessions": ("administrator", None),
    "GET /api/v1/api-keys": ("administrator", None),
    "POST /api/v1/api-keys": ("administrator", None),
    "POST /api/v1/api-keys/{key}/rotation": ("administrator", None),
    "DELETE /api/v1/api-keys/{key}": ("administrator", None),
}
FOR_WATCHES = {
    "POST /api/v1/tasks/{task}/acknowledgement",
    "POST /api/v1/tasks/{task}/problem",
    "POST /api/v1/tasks/{task}/problem/solved",
    "WS /api/v1/wearables/stream",
    "GET /api/v1/wearables/names",
    "GET /api/v1/wearables/self",
    "GET /api/v1/instructions/{name}",
}
FOR_WAITING_WATCHES = {"GET /api/v1/wearables/self"}
UNREADY = {"DELETE /api/v1/session", "PUT /api/v1/session/password"}
# The session ends by the first, so it is tried last.
IN_ORDER = sorted(DECLARED, key=lambda place: place == "DELETE /api/v1/session")


class Scene(NamedTuple):
    """A server that hears its controller, what speaks to it, and everybody who tries it."""

    server: Server
    browser: httpx.Client
    bearers: dict[str, Bearer]


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Scene]:
    folder: Path = tmp_path_factory.mktemp("station")
    loop = Loop()
    settings = settings_in(folder)
    controller, server = Controller(loop, settings.controller_socket), Server(loop, settings)
    controller.start()
    server.start()
    server.hear_controller()
    with httpx.Client(base_url=server.address, timeout=PATIENCE) as browser:
        yield Scene(server, browser, everybody(server))
    server.stop()
    controller.stop()
    loop.close()


def outcome(scene: Scene, place: str, headers: Headers) -> str:
    """What comes of it: why somebody is not let in, or that they are, whatever comes then."""
    method, _, path = place.partition(" ")
    path = path.replace("{", "").replace("}", "")
    if method == "WS":
        return _outcome_of_stream(scene.server, path, headers)
    sent = {"Content-Type": "application/json", **headers}
    scene.browser.cookies.clear()
    answer = scene.browser.request(method, path, headers=sent, content=None if method in BODILESS else "{}")
    return _judged(answer.status_code, answer.text)


def _outcome_of_stream(server: Server, path: str, headers: Headers) -> str:
    """The same of a handshake, written by hand so that it can name any host."""
    host = f"127.0.0.1:{server.settings.port}"
    handshake = {
        "Host": host,
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
        "Sec-WebSocket-Version": "13",
        **headers,
    }
    head = "".join(f"{name}: {value}\r\n" for name, value in handshake.items())
    with socket.create_connection(("127.0.0.1", server.settings.port), timeout=5) as raw:
        raw.sendall(f"GET {path} HTTP/1.1\r\n{head}\r\n".encode())
        answer = raw.makefile("rb")
        status = int(answer.readline().split()[1])
        lines = [line.decode().strip().lower() for line in iter(answer.readline, b"\r\n")]
        length = next((int(line.split(":")[1]) for line in lines if line.startswith("content-length")), 0)
        return PERMITTED if status == 101 else _judged(status, answer.read(length).decode())


def _judged(status: int, text: str) -> str:
    slug = ""
    if status >= 400:
        problem: dict[str, Any] = json.loads(text)
        assert problem["status"] == status
        slug = problem["type"].rpartition("/")[2]
    assert status < 500 or slug in ("preparing", "controller-error", "not-ready"), text
    assert (status in (401, 421)) <= (slug in STATUS), text
    if slug not in STATUS:
        return PERMITTED
    assert status == STATUS[slug]
    return slug


def expected(place: str, bearer: Bearer) -> str:
    """What must come of it, by the table above."""
    role, scope = DECLARED[place]
    if role == PUBLIC:
        return PERMITTED
    if bearer.scopes is not None:
        return PERMITTED if scope == ANY_KEY or scope in bearer.scopes else "scope-missing"
    if role == BESIDE:  # all who try are on this machine
        return "signed-out" if "Authorization" in bearer.headers else PERMITTED
    if place in FOR_WATCHES and (bearer.watch or bearer.waiting):
        return PERMITTED if bearer.watch or place in FOR_WAITING_WATCHES else "wearable-unconfirmed"
    if bearer.role is None or role == WATCH:
        return "signed-out"
    if bearer.unready and place not in UNREADY:
        return "password-must-change"
    order = [each.value for each in Role]
    return PERMITTED if order.index(bearer.role) >= order.index(role) else "role-too-low"


def test_the_table_knows_every_address_and_what_the_document_says_of_it(scene: Scene) -> None:
    document = scene.server.app.openapi()
    described = {
        f"{method.upper()} {path}": (operation["x-role"], operation["x-scope"])
        for path, operations in document["paths"].items()
        for method, operation in operations.items()
    }
    streams = {
        f"WS {route.path}": DECLARED[f"WS {route.path}"]
        for route in iter_route_contexts(scene.server.app.routes)
        if route.methods is None
    }
    assert {**described, **streams, OPENAPI: DECLARED[OPENAPI]} == DECLARED
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            place = f"{method.upper()} {path}"
            role, scope = DECLARED[place]
            ways = {way for each in operation["security"] for way in each}
            assert ({} in operation["security"]) == (role == BESIDE)
            assert ("session" in ways) == (role not in (PUBLIC, WATCH, BESIDE))
            assert ("key" in ways) == (scope is not None)
            assert ("watch" in ways) == (place in FOR_WATCHES)


def test_everybody_gets_exactly_as_far_as_is_declared(scene: Scene) -> None:
    wrong = []
    for name, bearer in scene.bearers.items():
        for place in IN_ORDER:
            found = outcome(scene, place, bearer.headers)
            if found != expected(place, bearer):
                wrong.append((name, place, found, expected(place, bearer)))
    assert wrong == []
    assert len(scene.bearers) >= 31


@pytest.mark.parametrize(
    "written",
    [
        "{0}/",
        "/{0}",
        "{0}//",
        "/./{1}",
        "{0}%2f",
        "{0};a",
        "/x/..{0}",
        "{0}%00",
        "{2}",
        "{0}%3Fa",
        "{0}?a=%2e%2e/healthz",
    ],
)
def test_no_other_way_to_write_an_address_gets_past_who_may(scene: Scene, written: str) -> None:
    """Nor do headers by which some servers let a method or a person be another."""
    believed = {"X-HTTP-Method-Override": "GET", "X-Forwarded-User": "ada", "X-Original-URL": "/healthz"}
    headers = {"Content-Type": "application/json", **believed}
    target = ("127.0.0.1", scene.server.settings.port)
    for place, (role, _) in DECLARED.items():
        method, _, path = place.partition(" ")
        if role in (PUBLIC, BESIDE) or method == "WS":
            continue
        path = path.replace("{", "").replace("}", "")
        address = written.format(path, path[1:], path.upper())
        connection = HTTPConnection(*target, timeout=10)  # it sends what a client that tidies addresses would not
        connection.request(method, address, "{}" if method not in BODILESS else None, headers)
        answer = connection.getresponse()
        without_page = answer.status == 503 and b"The page is not built" in answer.read()
        assert without_page or answer.status in (401, 404, 405), (method, address, answer.status)
        connection.close()


@pytest.mark.parametrize("place", [place for place, _ in DECLARED.items() if not place.startswith("GET")])
def test_another_origin_does_nothing_whoever_it_is(scene: Scene, place: str) -> None:
    for name in ("nobody", "administrator", "watch", "key to read and audit"):
        foreign = {**scene.bearers[name].headers, "Origin": "http://evil.example"}
        assert outcome(scene, place, foreign) == "foreign-origin"


@pytest.mark.parametrize("place", DECLARED)
def test_another_host_is_answered_to_nobody(scene: Scene, place: str) -> None:
    for name in ("nobody", "administrator", "watch", "key to read and audit"):
        foreign = {**scene.bearers[name].headers, "Host": f"evil.example:{scene.server.settings.port}"}
        assert outcome(scene, place, foreign) == "wrong-host"


def test_what_is_refused_to_strangers_asks_them_for_a_key_or_a_session(scene: Scene) -> None:
    answer = httpx.get(f"{scene.server.address}/api/v1/state")
    assert answer.headers["www-authenticate"] == "Bearer"
    assert answer.headers["cache-control"] == "no-store"


def test_a_route_that_declares_nothing_or_twice_is_not_served() -> None:
    for dependencies in ([], [allowed(Role.VIEWER), allowed(None)]):
        app = FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
        router = APIRouter(dependencies=dependencies)

        @router.get("/open")
        async def open_to_all() -> None:
            """Is read by anybody."""

        app.include_router(router)
        with pytest.raises(RuntimeError, match="/open must declare once"):
            check_declared(app.routes)
    check_declared([])


def test_what_is_public_cannot_be_declared_for_some() -> None:
    with pytest.raises(ValueError, match="watch_only"):
        allowed(None, watch=True)
    with pytest.raises(ValueError, match="watch_only"):
        allowed(None, scope=Scope.READ)
    with pytest.raises(ValueError, match="watch_only"):
        allowed(None, unready=True)
