from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.server.settings import Settings, StreamLimits
from support.server import Controller, Loop, Server, settings_in
from support.waiting import until

from .watching import FOREIGN, Device, station


@pytest.fixture
def loop() -> Iterator[Loop]:
    loop = Loop()
    yield loop
    loop.close()


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    limits = StreamLimits(queue=8, send_seconds=1.5, clients=10, of_one=6)
    return replace(settings_in(tmp_path), stream=limits)


@pytest.fixture
def controller(loop: Loop, settings: Settings) -> Iterator[Controller]:
    controller = Controller(loop, settings.controller_socket)
    controller.start()
    yield controller
    controller.stop()


@pytest.fixture
def lonely_server(loop: Loop, settings: Settings) -> Iterator[Server]:
    """A server whose controller has not been started."""
    server = Server(loop, settings)
    server.start()
    yield server
    server.stop()


@pytest.fixture
def server(controller: Controller, lonely_server: Server) -> Server:
    """A server that hears its controller."""
    lonely_server.hear_controller()
    return lonely_server


@pytest.fixture
def client(server: Server) -> Iterator[httpx.Client]:
    """The browser of an operator who has signed in."""
    with server.client(Role.OPERATOR) as client:
        yield client


@pytest.fixture
def administrator(server: Server) -> Iterator[httpx.Client]:
    """The browser of an administrator who has signed in."""
    with server.client(Role.ADMINISTRATOR) as client:
        yield client


@pytest.fixture
def device(server: Server, controller: Controller) -> Iterator[Device]:
    """A watch, at a station with tasks for two people."""
    controller.show(station())
    until(lambda: FOREIGN in server.app.state.controller.view.tasks)
    with Device(server) as device:
        yield device


@pytest.fixture
def another(server: Server) -> Iterator[Device]:
    """Another watch."""
    with Device(server) as device:
        yield device
