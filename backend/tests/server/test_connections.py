"""Clients that let the server wait: they are closed, and keep nobody else from being served."""

from __future__ import annotations

import socket
import time
from contextlib import ExitStack

import httpx
import pytest

from sequence_planner.server.http import connections, middleware
from sequence_planner.server.http.connections import HEAD_SECONDS, LARGEST_HEAD
from sequence_planner.server.http.middleware import MOST_UNKNOWN
from support.server import Controller, Server, listen
from support.waiting import patience, until

SOON = 0.4  # seconds


def connected(server: Server) -> socket.socket:
    return socket.create_connection(("127.0.0.1", server.settings.port), timeout=10)


@pytest.fixture
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "HEAD_SECONDS", SOON)
    monkeypatch.setattr(middleware, "BODY_SECONDS", SOON)


@pytest.mark.usefixtures("_impatient")
@pytest.mark.parametrize("begun", [b"", b"G", b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow:"])
def test_whoever_does_not_finish_asking_is_closed(server: Server, begun: bytes) -> None:
    with connected(server) as slow:
        slow.sendall(begun)
        assert slow.recv(4096) == b""


@pytest.mark.usefixtures("_impatient")
def test_also_after_an_answer(server: Server) -> None:
    with connected(server) as slow:
        host = f"127.0.0.1:{server.settings.port}".encode()
        slow.sendall(b"GET /healthz HTTP/1.1\r\nHost: " + host + b"\r\n\r\n")
        assert slow.recv(4096).startswith(b"HTTP/1.1 200")
        slow.sendall(b"GET /healthz HTTP/1.1\r\n")
        received = b"-"
        while received:
            received = slow.recv(4096)
            assert not received.startswith(b"HTTP/1.1 200")


@pytest.mark.usefixtures("_impatient")
def test_a_stream_is_nobody_who_lets_it_wait(server: Server) -> None:
    with listen(server) as stream:
        end = time.monotonic() + 3 * SOON
        while time.monotonic() < end:
            assert stream.recv(patience(2))


@pytest.mark.usefixtures("_impatient")
def test_a_body_that_does_not_come_is_not_waited_for(server: Server, client: httpx.Client) -> None:
    with connected(server) as slow:
        cookie = "; ".join(f"{name}={value}" for name, value in client.cookies.items())
        slow.sendall(
            f"PUT /api/v1/mode HTTP/1.1\r\nHost: 127.0.0.1:{server.settings.port}\r\nCookie: {cookie}\r\n"
            "Content-Type: application/json\r\nContent-Length: 20\r\n\r\n{".encode()
        )
        answer = slow.recv(4096)
        assert answer.startswith(b"HTTP/1.1 408")


def answered(server: Server, sent: bytes) -> bytes:
    """All that comes until the server hangs up."""
    with connected(server) as client:
        client.sendall(sent)
        received = b""
        while more := client.recv(65536):
            received += more
        return received


def head(server: Server, *lines: bytes) -> bytes:
    host = f"Host: 127.0.0.1:{server.settings.port}".encode()
    return b"\r\n".join([b"GET /healthz HTTP/1.1", host, *lines]) + b"\r\n\r\n"


@pytest.mark.parametrize("end", [b"", b"\r\n\r\n"], ids=["endless", "whole"])
def test_a_head_may_not_be_too_large(server: Server, end: bytes) -> None:
    start = head(server)[:-2] + b"X-Long: "
    answer = answered(server, start + b"a" * (LARGEST_HEAD - len(start) - len(end) + 1) + end)
    assert answer.startswith(b"HTTP/1.1 431")
    assert b"/problems/head-too-large" in answer


def test_a_head_may_have_its_whole_size(server: Server) -> None:
    start, end = head(server)[:-2] + b"Connection: close\r\nX-Long: ", b"\r\n\r\n"
    answer = answered(server, start + b"a" * (LARGEST_HEAD - len(start) - len(end)) + end)
    assert answer.startswith(b"HTTP/1.1 200")


@pytest.mark.parametrize("before", [False, True], ids=["first", "behind another"])
def test_a_line_that_ends_with_a_line_feed_alone_is_refused(server: Server, before: bool) -> None:
    wrong = head(server, b"X-One: 1\nX-Two: 2")
    first, _, rest = answered(server, (head(server) if before else b"") + wrong).partition(b"HTTP/1.1 400")
    assert first.startswith(b"HTTP/1.1 200") is before
    assert b"CR LF" in rest
    assert b"application/problem+json" in rest


def slow(server: Server, address: str, sent: bytes) -> socket.socket:
    """A client that never finishes what it has begun."""
    made = socket.socket()
    made.settimeout(10)
    made.bind((address, 0))
    made.connect(("127.0.0.1", server.settings.port))
    made.sendall(sent)
    return made


def is_closed(client: socket.socket) -> bool:
    client.setblocking(False)
    try:
        while client.recv(65536):
            pass  # the rest of an answer
        return True
    except BlockingIOError:
        return False
    except ConnectionResetError:
        return True


def many(server: Server, count: int, *addresses: str) -> list[socket.socket]:
    """Clients of which a third says nothing, a third half a head, and a third half a body."""
    body = b"POST /api/v1/session HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nContent-Type: application/json\r\n"
    begun = [b"", b"GET / HTTP/1.1\r\nX-Slow:", body % server.settings.port + b"Content-Length: 90\r\n\r\n{"]
    return [slow(server, address, begun[number % 3]) for number in range(count) for address in addresses]


def test_who_is_signed_in_stops_the_station_whoever_else_holds_connections(
    server: Server, controller: Controller, client: httpx.Client
) -> None:
    """All places for strangers are taken, from this machine and through others; and more come."""
    idle = many(server, MOST_UNKNOWN // 3 + 5, "127.0.0.1", "127.0.0.2", "127.0.0.3")
    try:
        began = time.monotonic()
        for mode in ("hold", "paused"):  # each with a connection of its own
            with httpx.Client(base_url=server.address, cookies=client.cookies, timeout=HEAD_SECONDS / 2) as operator:
                assert operator.put("/api/v1/mode", json={"mode": mode}).status_code == 204
        assert len(controller.commands) == 2
        assert time.monotonic() - began < HEAD_SECONDS / 2
        idle += many(server, 5, "127.0.0.1", "127.0.0.2", "127.0.0.3")
        assert httpx.get(f"{server.address}/healthz", timeout=HEAD_SECONDS / 2).status_code == 200
        assert 0 < sum(map(is_closed, idle)) < len(idle) / 2
    finally:
        for each in idle:
            each.close()


def test_a_stream_of_somebody_signed_in_stays_when_strangers_come(server: Server) -> None:
    with listen(server) as stream:
        idle = many(server, MOST_UNKNOWN // 3 + 50, "127.0.0.1", "127.0.0.2", "127.0.0.3")
        for _ in range(5):
            assert stream.recv(patience(5))
        for each in idle:
            each.close()


def test_one_address_may_not_have_them_all(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(middleware.MOST_OF_ONE, middleware.ConnectionKind.ADDRESS, 3)
    kept = [slow(server, "127.0.0.9", b"") for _ in range(5)]
    with slow(server, "127.0.0.8", head(server)) as other:
        assert other.recv(4096).startswith(b"HTTP/1.1 200")
    until(lambda: [is_closed(each) for each in kept] == [True, True, False, False, False])
    for each in kept:
        each.close()


def test_one_session_may_not_have_them_all(
    server: Server, client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(middleware.MOST_OF_ONE, middleware.ConnectionKind.BEARER, 3)
    cookie = "; ".join(f"{name}={value}" for name, value in client.cookies.items()).encode()
    asked = head(server, b"Cookie: " + cookie).replace(b"/healthz", b"/api/v1/session")
    kept = []
    with listen(server) as stream, ExitStack() as opened:
        for _ in range(5):
            kept.append(opened.enter_context(slow(server, "127.0.0.9", asked)))
            assert kept[-1].recv(65536).startswith(b"HTTP/1.1 200")
        assert not is_closed(kept[-1])
        until(lambda: is_closed(kept[0]) and is_closed(kept[1]))
        assert stream.recv(patience(5))
