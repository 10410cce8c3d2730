"""What the tests of watches have in common: a station with two people, and watches in somebody's hands."""

from __future__ import annotations

import time
from typing import Any

import httpx
from websockets.sync.client import ClientConnection, connect

from sequence_planner.controller.views.station import StationView
from support.example_view import ability, example_view
from support.server import Server

from .test_acting import problem

WATCHES = "/api/v1/wearables"
OWN, FOREIGN = "7", "8"  # tasks
DAY = 86400.0  # seconds


def station(**changes: object) -> StationView:
    """A station with two people: the operator has one task, the inspector another."""
    before = example_view()
    own = before.tasks[OWN]
    foreign = own.model_copy(update={"resource": "inspector", "title": "Inspect the engine", "text": "Look behind it"})
    inspector = before.resources["operator"].model_copy(update={"title": "Inspector"})
    parts: dict[str, object] = {
        "resources": before.resources | {"inspector": inspector},
        "abilities": before.abilities
        | {"inspector.look": ability("inspector", "Look").model_copy(update={"human": True})},
        "tasks": {OWN: own, FOREIGN: foreign},
    }
    return example_view(**{**parts, **changes})


class Device(httpx.Client):
    """A watch in somebody's hand, with the browser in it."""

    def __init__(self, server: Server) -> None:
        super().__init__(base_url=server.address, headers={"User-Agent": "a watch"})
        self.server = server

    def pair(self, code: str) -> httpx.Response:
        return self.post(f"{WATCHES}/pairing", json={"code": code})

    def state(self) -> str:
        """What the watch is told of itself; `signed-out` when it is none."""
        answer = self.get(f"{WATCHES}/self")
        if answer.status_code == 401:
            problem(answer, 401, "signed-out")
            return "signed-out"
        state: str = answer.json()["state"]
        return state

    def acknowledge(self, task: str, revision: int = 3) -> httpx.Response:
        return self.post(f"/api/v1/tasks/{task}/acknowledgement", json={"revision": revision})

    def report(self, task: str, revision: int = 3, *, solved: bool = False) -> httpx.Response:
        path = "problem/solved" if solved else "problem"
        return self.post(f"/api/v1/tasks/{task}/{path}", json={"revision": revision})

    def listen(self, place: str = f"{WATCHES}/stream") -> ClientConnection:
        cookies = "; ".join(f"{name}={value}" for name, value in self.cookies.items())
        address = f"ws://127.0.0.1:{self.server.settings.port}{place}"
        return connect(address, additional_headers={"Cookie": cookies}, close_timeout=1)


def offer(client: httpx.Client, name: str = "Watch 1", resource: str = "operator") -> dict[str, Any]:
    """An offer with its code."""
    answer = client.post(f"{WATCHES}/offers", json={"name": name, "resource": resource})
    assert answer.status_code == 201, answer.text
    assert answer.headers["cache-control"] == "no-store"
    found: dict[str, Any] = answer.json()
    return found


def paired(client: httpx.Client, device: Device, name: str = "Watch 1", resource: str = "operator") -> str:
    """The id of a watch that waits to be confirmed."""
    answer = device.pair(offer(client, name, resource)["code"])
    assert answer.status_code == 201, answer.text
    identifier: str = answer.json()["id"]
    return identifier


def confirm(client: httpx.Client, watch: str) -> httpx.Response:
    return client.post(f"{WATCHES}/{watch}/confirmation", json={})


def active(client: httpx.Client, device: Device, name: str = "Watch 1", resource: str = "operator") -> str:
    """The id of a watch that was confirmed."""
    watch = paired(client, device, name, resource)
    assert confirm(client, watch).status_code == 204
    return watch


def later(server: Server, seconds: float) -> None:
    """Put the server's clock forward."""
    server.identity.now = lambda: time.time() + seconds
