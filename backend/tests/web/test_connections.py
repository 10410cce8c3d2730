"""Clients that let the server wait: they are closed, and keep nobody else from being served."""

from __future__ import annotations

import socket
import time

import httpx
import pytest

from sequence_planner.web import connections, guard

from .running import Server, listen, until

SOON = 0.4  # seconds


def connected(server: Server) -> socket.socket:
    return socket.create_connection(("127.0.0.1", server.settings.port), timeout=10)


@pytest.fixture
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "HEAD_SECONDS", SOON)
    monkeypatch.setattr(guard, "BODY_SECONDS", SOON)


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
            assert stream.recv(2)


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


def test_a_head_may_not_be_endless(server: Server) -> None:
    with connected(server) as long:
        long.sendall(b"GET /healthz HTTP/1.1\r\nX-Long: " + b"a" * (connections.LARGEST_HEAD + 1))
        assert long.recv(4096).startswith(b"HTTP/1.1 400")


def test_connections_beyond_the_most_are_closed_and_the_others_go_on(
    server: Server, client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert client.get("/healthz").status_code == 200
    monkeypatch.setattr(connections, "MOST_CONNECTIONS", 5)
    idle = [connected(server) for _ in range(8)]
    try:
        idle[-1].settimeout(10)
        assert idle[-1].recv(1) == b""
        assert client.get("/healthz").status_code == 200
    finally:
        for each in idle:
            each.close()
    until(lambda: _served(server))


def test_one_address_may_not_have_them_all(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    """Counted as from elsewhere, for once: all connections of a test come from this machine."""
    monkeypatch.setattr(connections, "_from_here", lambda _: False)
    monkeypatch.setattr(connections.PromptConnection, "of_one_address", 3)
    kept = [connected(server) for _ in range(3)]
    with connected(server) as refused, socket.socket() as other:
        assert refused.recv(1) == b""
        other.bind(("127.0.0.9", 0))
        other.connect(("127.0.0.1", server.settings.port))
        other.sendall(f"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1:{server.settings.port}\r\n\r\n".encode())
        assert other.recv(4096).startswith(b"HTTP/1.1 200")
    for each in kept:
        each.close()


def _served(server: Server) -> bool:
    try:
        return httpx.get(f"{server.address}/healthz").status_code == 200
    except httpx.TransportError:
        return False
