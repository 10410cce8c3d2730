"""Another system that webhooks are sent to: a real HTTP server, which takes, refuses, hangs, or breaks off as told."""

from __future__ import annotations

import base64
import hmac
import json
import socket
import ssl
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from hashlib import sha256
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from support.certificates import Certified

Answer = Callable[["Handler"], None]
"""How a request is answered, whose body has been read."""


@dataclass(frozen=True)
class Received:
    """A request; header names in small letters."""

    path: str
    headers: dict[str, str]
    body: bytes

    def verified(self, secret: str) -> dict[str, Any]:
        """The event, if it is signed with this secret, as any receiver of Standard Webhooks finds out."""
        stamp = self.headers["webhook-timestamp"]
        assert abs(time.time() - int(stamp)) < 300
        signed = f"{self.headers['webhook-id']}.{stamp}.".encode() + self.body
        key = base64.b64decode(secret.removeprefix("whsec_"))
        mac = base64.b64encode(hmac.new(key, signed, sha256).digest()).decode()
        assert f"v1,{mac}" in self.headers["webhook-signature"].split()
        event: dict[str, Any] = json.loads(self.body)
        assert self.headers["webhook-id"] == f"event-{event['number']}"
        return event


class Handler(BaseHTTPRequestHandler):
    """Reads a request, keeps it, and answers."""

    server: Server

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers.get("content-length", 0)))
        received = Received(self.path, {name.lower(): value for name, value in self.headers.items()}, body)
        answers = self.server.receiver.answers
        self.server.receiver.received.append(received)
        answer = answers.pop(0) if answers else status(204)
        with suppress(OSError):
            answer(self)

    def do_GET(self) -> None:
        self.do_POST()

    def log_message(self, *_: object) -> None:
        """Say nothing."""


class Server(ThreadingHTTPServer):
    daemon_threads = True
    receiver: Receiver

    def handle_error(self, *_: object) -> None:
        """Whoever breaks off is of no interest."""


@dataclass
class Receiver:
    """What has come, and the `answers` to what comes next; after them all is taken."""

    port: int
    received: list[Received] = field(default_factory=list)
    answers: list[Answer] = field(default_factory=list)

    def url(self, path: str = "/events", host: str = "127.0.0.1", scheme: str = "http") -> str:
        return f"{scheme}://{host}:{self.port}{path}"

    @property
    def numbers(self) -> list[int]:
        return [json.loads(each.body)["number"] for each in self.received]


@contextmanager
def receiving(certified: Certified | None = None, address: str = "127.0.0.1") -> Iterator[Receiver]:
    server = Server((address, 0), Handler)
    if certified is not None:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certified.certificate, certified.private_key)
        server.socket = context.wrap_socket(server.socket, server_side=True)
    server.receiver = Receiver(server.server_address[1])
    thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
    thread.start()
    try:
        yield server.receiver
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


def status(code: int, headers: dict[str, str] | None = None, body: bytes = b"") -> Answer:
    def answer(handler: Handler) -> None:
        handler.send_response(code)
        for name, value in (headers or {}).items():
            handler.send_header(name, value)
        handler.send_header("content-length", str(len(body)))
        handler.end_headers()
        handler.wfile.write(body)

    return answer


def hangs(until: threading.Event) -> Answer:
    """Answers nothing until the test is over."""

    def answer(_: Handler) -> None:
        until.wait(30)

    return answer


def drips(until: threading.Event) -> Answer:
    """Speaks all the time, and never comes to an end of its head."""

    def answer(handler: Handler) -> None:
        handler.wfile.write(b"HTTP/1.1 200 OK\r\n")
        number = 0
        while not until.wait(0.02):
            number += 1
            handler.wfile.write(f"x-{number}: y\r\n".encode())
            handler.wfile.flush()

    return answer


def floods(until: threading.Event) -> Answer:
    """Takes it, and then has no end of things to say."""

    def answer(handler: Handler) -> None:
        handler.wfile.write(b"HTTP/1.1 200 OK\r\n\r\n")
        while not until.is_set():
            handler.wfile.write(b"x" * 65536)

    return answer


def breaks_off(handler: Handler) -> None:
    handler.connection.shutdown(socket.SHUT_RDWR)


def talks_nonsense(handler: Handler) -> None:
    handler.wfile.write(b"\x00\x01 what?\r\n\r\n")
    handler.close_connection = True
