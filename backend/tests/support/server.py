"""Real processes' parts in one thread: a controller's link that publishes, and the server under uvicorn."""

from __future__ import annotations

import asyncio
import contextlib
import secrets
import socket
import ssl
import threading
import time
from collections.abc import Coroutine, Iterator
from pathlib import Path
from typing import Any, TypeVar

import httpx
import uvicorn
from fastapi import FastAPI
from websockets.asyncio import client as asyncio_client
from websockets.sync.client import ClientConnection, connect

from sequence_planner.auth import users
from sequence_planner.auth.login import SignIn
from sequence_planner.auth.roles import Role
from sequence_planner.auth.sessions import SignedIn, open_session
from sequence_planner.auth.users import Person
from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.execution import SetBreakpoint
from sequence_planner.controller.commands.tasks import TaskCommand
from sequence_planner.controller.ipc import CarriedOut, ControllerLink
from sequence_planner.controller.views.station import MadeBreakpointView, StationView
from sequence_planner.core.actor import SYSTEM, ActorKind
from sequence_planner.server.binding import bind
from sequence_planner.server.http.credentials import session_cookie
from sequence_planner.server.server import uvicorn_config
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.server.settings import Settings
from support.databases import with_tables
from support.network import free_port
from support.people import cheap_passwords
from support.waiting import PATIENCE, patience, until

from .example_view import example_view

T = TypeVar("T")
PUBLISH_INTERVAL = 0.2  # seconds


class Loop:
    """An event loop in a thread of its own."""

    def __init__(self) -> None:
        self.loop = asyncio.new_event_loop()
        self.thread = threading.Thread(target=self.loop.run_forever, daemon=True)
        self.thread.start()

    def run(self, work: Coroutine[Any, Any, T]) -> T:
        return asyncio.run_coroutine_threadsafe(work, self.loop).result(PATIENCE)

    def close(self) -> None:
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join(PATIENCE)
        self.loop.close()


class Controller:
    """Publishes a view with a fresh time five times a second, and carries out or refuses commands.

    Its time begins long ago, or is that `of_now`.
    """

    of_now = False

    def __init__(self, loop: Loop, path: Path) -> None:
        self.loop = loop
        self.view = example_view()
        self.commands: list[Command] = []
        self.publishing = True
        self.link = ControllerLink(path, self.handle)
        self._task: asyncio.Task[None] | None = None

    async def handle(self, command: Command) -> CarriedOut | None:
        if isinstance(command, TaskCommand):
            task = self.view.tasks.get(command.task)
            if task is None or task.revision != command.revision:
                raise CommandRefused("task-gone", "Look at what is asked for now.")
            if command.task == "broken":
                raise RuntimeError("a fault of the controller")
        self.commands.append(command)
        made = MadeBreakpointView(id="7", **dict(self.view.breakpoints["1"]))
        return CarriedOut(made=made if isinstance(command, SetBreakpoint) else None)

    def start(self) -> None:
        self.loop.run(self.link.__aenter__())

        async def begin() -> None:
            self._task = asyncio.create_task(self._publish())

        self.loop.run(begin())

    def stop(self) -> None:
        async def end() -> None:
            if self._task is not None:
                self._task.cancel()
            await self.link.__aexit__(None, None, None)

        self.loop.run(end())

    def show(self, view: StationView) -> None:
        """Publish `view` now, and again from now on."""

        async def publish() -> None:
            self.view = view
            self.link.publish(view)

        self.loop.run(publish())

    async def _publish(self) -> None:
        while True:
            if self.publishing:
                now = time.time() if self.of_now else self.view.time + PUBLISH_INTERVAL
                self.view = self.view.model_copy(update={"time": now})
                self.link.publish(self.view)
            await asyncio.sleep(PUBLISH_INTERVAL)


class Server:
    """The server under uvicorn, on a free port. Its passwords are hashed with parameters that cost nothing."""

    def __init__(self, loop: Loop, settings: Settings) -> None:
        self.loop = loop
        self.settings = settings
        self.address = f"http://127.0.0.1:{settings.port}"
        self.stream = f"ws://127.0.0.1:{settings.port}/api/v1/stream"
        config = uvicorn_config(settings)
        assert isinstance(config.app, FastAPI)
        self.app = config.app
        self._uvicorn = uvicorn.Server(config)
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        listener = bind(self.settings)

        async def begin() -> None:
            # `_serve` is `serve` without the signal handlers, which belong to the main thread.
            self._task = asyncio.create_task(self._uvicorn._serve([listener]))

        self.loop.run(begin())
        until(lambda: self._uvicorn.started)
        self._hash_cheaply()

    def hear_controller(self) -> None:
        """Wait until it hears its controller."""
        until(lambda: httpx.get(f"{self.address}/healthz").json()["controller"] == "heard")

    def _hash_cheaply(self) -> None:
        office = self.identity
        office.passwords.close()
        office.passwords = cheap_passwords()
        office.sign_in = SignIn(office.database, office.passwords)

    @property
    def identity(self) -> IdentityService:
        """The server's own way to the database; use it from this thread through `reading` and `writing` alone."""
        office: IdentityService = self.app.state.identity
        return office

    def person(self, role: Role = Role.OPERATOR, *, name: str | None = None, temporary: bool = False) -> Person:
        """A new person, who cannot sign in with any password."""
        name = name or f"{role.value.capitalize()} {secrets.token_hex(4)}"
        with self.identity.database.writing() as connection:
            return users.create(connection, name, role, "none", SYSTEM, time.time(), temporary=temporary)

    def session(self, person: Person, now: float | None = None) -> tuple[str, SignedIn]:
        """A new session and its token, without a password; opened at `now`."""
        when = time.time() if now is None else now
        with self.identity.database.writing() as connection:
            kind = ActorKind.PERSON
            return open_session(connection, person, when, kind=kind, address="127.0.0.1", agent="tests")

    def cookie(self, token: str) -> dict[str, str]:
        """The header that shows the token of a session."""
        return {"Cookie": f"{session_cookie(self.settings)}={token}"}

    def client(self, role: Role | None = None, *, token: str | None = None) -> httpx.Client:
        """A browser in which somebody with `role` is signed in, or nobody."""
        if role is not None:
            token = self.session(self.person(role))[0]
        cookies = {} if token is None else {session_cookie(self.settings): token}
        return httpx.Client(base_url=self.address, cookies=cookies, timeout=PATIENCE)

    def stop(self) -> None:
        async def end() -> None:
            self._uvicorn.should_exit = True
            if self._task is not None:
                with contextlib.suppress(asyncio.CancelledError):
                    await self._task

        self.loop.run(end())


def settings_in(folder: Path) -> Settings:
    """Of a server whose database, page and controller's socket are in `folder`, on a free port."""
    (page := folder / "page").mkdir(exist_ok=True)
    return Settings(
        controller_socket=folder / "controller.sock",
        page=page,
        database=with_tables(folder / "station.sqlite"),
        port=free_port(),
    )


@contextlib.contextmanager
def serving(settings: Settings) -> Iterator[Server]:
    """A server that runs, with no controller."""
    loop = Loop()
    server = Server(loop, settings)
    server.start()
    try:
        yield server
    finally:
        server.stop()
        loop.close()


def listen(
    server: Server,
    address: str | None = None,
    *,
    headers: dict[str, str] | None = None,
    sock: socket.socket | None = None,
    max_queue: int | None = 16,
    max_size: int | None = 1024 * 1024,
    close_timeout: float = 10,
) -> ClientConnection:
    """A stream of `server` as a viewer listens to it."""
    shown = server.cookie(server.session(server.person(Role.VIEWER))[0]) | (headers or {})
    return connect(
        address or server.stream,
        additional_headers=shown,
        sock=sock,
        max_queue=max_queue,
        max_size=max_size,
        close_timeout=close_timeout,
        open_timeout=PATIENCE,
    )


def first_message_over_tls(
    address: str, trusting: ssl.SSLContext, headers: dict[str, str], sock: socket.socket | None = None
) -> str:
    """Return the first message of the stream at `address`. Raises `InvalidStatus` where the server refuses it.

    The client has one thread: the one with two reads and writes a TLS connection at the same time, which OpenSSL does
    not allow and which now and then loses what was sent.
    """

    async def listen() -> str:
        async with asyncio_client.connect(
            address, ssl=trusting, sock=sock, additional_headers=headers, open_timeout=PATIENCE
        ) as stream:
            async with asyncio.timeout(patience(5)):
                return str(await stream.recv())

    return asyncio.run(listen())
