"""The server at an address of this machine that is not the loopback: a watch is paired there, over HTTPS alone.

A packet from this machine to an address of its own does not leave it.
"""

from __future__ import annotations

import dataclasses
import json
import socket
import ssl
from collections.abc import Iterator
from ipaddress import ip_address
from pathlib import Path
from typing import NamedTuple

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.commands.tasks import AcknowledgeTask
from sequence_planner.core.actor import ActorKind
from sequence_planner.server.settings import Settings
from support.certificates import certify
from support.server import Controller, Loop, Server, first_message_over_tls
from support.waiting import until

from .test_acting import problem
from .watching import FOREIGN, OWN, WATCHES, Device, active, station


def own_address() -> str | None:
    """The address from which this machine would speak to others; nothing is sent to find out."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
        except OSError:
            return None
        found: str = probe.getsockname()[0]
    return None if ip_address(found).is_loopback else found


class Place(NamedTuple):
    """A server, where it is, and whom a browser must trust to open it."""

    server: Server
    address: str
    trusting: ssl.SSLContext

    @property
    def origin(self) -> str:
        return f"https://{self.address}:{self.server.settings.port}"

    def browser(self, headers: dict[str, str] | None = None) -> httpx.Client:
        return httpx.Client(
            base_url=self.origin, verify=self.trusting, headers={"Origin": self.origin, **(headers or {})}
        )


@pytest.fixture
def place(loop: Loop, controller: Controller, settings: Settings, tmp_path: Path) -> Iterator[Place]:
    address = own_address()
    if address is None:
        pytest.skip("this machine has no address but the loopback")
    certified = certify(tmp_path / "certificate", address, self_signed=True)
    elsewhere = dataclasses.replace(
        settings, host=address, certificate=certified.certificate, private_key=certified.private_key, names=(address,)
    )
    server = Server(loop, elsewhere)
    server.start()
    there = Place(server, address, ssl.create_default_context(cafile=certified.authority))
    with there.browser() as browser:
        until(lambda: browser.get("/healthz").json()["controller"] == "heard")
    controller.show(station())
    until(lambda: FOREIGN in server.app.state.controller.view.tasks)
    yield there
    server.stop()


class Wrist(Device):
    """A watch that opens the server at that address."""

    def __init__(self, place: Place) -> None:
        httpx.Client.__init__(self, base_url=place.origin, verify=place.trusting, headers={"Origin": place.origin})
        self.server = place.server


def test_a_watch_is_paired_sees_its_task_and_acknowledges_it(place: Place, controller: Controller) -> None:
    operator = place.server.cookie(place.server.session(place.server.person(Role.OPERATOR))[0])
    with place.browser(operator) as client, Wrist(place) as wrist:
        watch = active(client, wrist)
        (cookie,) = wrist.cookies.jar
        assert (cookie.secure, cookie.name.startswith("__Host-")) == (True, True)
        headers = {"Cookie": f"{cookie.name}={cookie.value}", "Origin": place.origin}
        stream = f"wss://{place.address}:{place.server.settings.port}{WATCHES}/stream"
        shown = json.loads(first_message_over_tls(stream, place.trusting, headers))
        assert shown["tasks"].keys() == {OWN}
        assert wrist.acknowledge(OWN).status_code == 204
    (command,) = controller.commands
    assert isinstance(command, AcknowledgeTask)
    assert (command.actor.kind, command.actor.id) == (ActorKind.WATCH, watch)
    assert command.actor.address == place.address


def test_it_is_opened_over_https_by_its_own_name_there_and_nowhere_else(place: Place) -> None:
    port = place.server.settings.port
    with pytest.raises(httpx.TransportError):
        httpx.get(f"http://{place.address}:{port}/operator")
    with pytest.raises(httpx.ConnectError):
        httpx.get(f"http://127.0.0.1:{port}/operator")
    with place.browser() as browser:
        for host in ("evil.example", f"127.0.0.1:{port}", "localhost"):
            problem(browser.get("/operator", headers={"Host": host}), 421, "wrong-host")
        foreign = {"Origin": f"http://{place.address}:{port}"}
        problem(browser.post(f"{WATCHES}/pairing", json={"code": "1"}, headers=foreign), 403, "foreign-origin")
