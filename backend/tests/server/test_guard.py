"""Who may not speak to the server: other names, other pages, other kinds of bodies, bodies too large."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import httpx
import pytest
from websockets.exceptions import InvalidStatus

from support.server import Controller, Server, listen
from support.waiting import patience

from .test_acting import problem

MODE = {"mode": "paused"}


@pytest.mark.parametrize("host", ["evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "localhost.evil.example:{port}"])
def test_a_foreign_host_is_refused_everywhere(server: Server, client: httpx.Client, host: str) -> None:
    for path in ("/", "/healthz", "/api/v1/station", "/api/v1/nothing"):
        answer = client.get(path, headers={"Host": host.format(port=server.settings.port)})
        if path == "/healthz" and host.startswith("127.0.0.1"):
            assert answer.status_code == 200  # what this machine asks about its own health may name any of its ports
        else:
            problem(answer, 421, "wrong-host")


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost", "LOCALHOST", "[::1]"])
def test_each_of_our_names_is_answered(server: Server, client: httpx.Client, name: str) -> None:
    assert client.get("/healthz", headers={"Host": f"{name}:{server.settings.port}"}).status_code == 200


@pytest.mark.parametrize("headers", [b"", b"Host: 127.0.0.1:{port}\r\nHost: evil.example\r\n"])
def test_a_request_needs_exactly_one_host(server: Server, headers: bytes) -> None:
    port = str(server.settings.port).encode()
    with socket.create_connection(("127.0.0.1", server.settings.port)) as raw:
        raw.sendall(b"GET /healthz HTTP/1.0\r\n" + headers.replace(b"{port}", port) + b"\r\n")
        assert raw.recv(4096).split(b"\r\n")[0].split()[1] == b"400"


def test_what_two_servers_may_read_differently_is_read_by_none(server: Server) -> None:
    host = b"Host: 127.0.0.1:%d\r\n" % server.settings.port
    both = b"Content-Type: application/json\r\nContent-Length: 4\r\nTransfer-Encoding: chunked\r\n"
    smuggled = b"GET /healthz HTTP/1.1\r\n" + host + b"\r\n"
    with socket.create_connection(("127.0.0.1", server.settings.port), timeout=5) as raw:
        raw.sendall(b"POST /api/v1/session HTTP/1.1\r\n" + host + both + b"\r\n2\r\n{}\r\n0\r\n\r\n" + smuggled)
        answered = b"".join(iter(lambda: raw.recv(4096), b""))
    assert answered.startswith(b"HTTP/1.1 400 ")
    assert b"/problems/conflicting-lengths" in answered
    assert answered.count(b"HTTP/1.1 ") == 1


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": "http://127.0.0.1:1"},
        {"Origin": "https://127.0.0.1:{port}"},
        {"Sec-Fetch-Site": "cross-site"},
        {"Origin": "http://127.0.0.1:{port}", "Sec-Fetch-Site": "cross-site"},
    ],
)
def test_a_foreign_page_changes_nothing_and_opens_no_stream(
    server: Server, client: httpx.Client, controller: Controller, headers: dict[str, str]
) -> None:
    sent = {name: value.format(port=server.settings.port) for name, value in headers.items()}
    problem(client.put("/api/v1/mode", json=MODE, headers=sent), 403, "foreign-origin")
    problem(client.post("/api/v1/production/start", json={}, headers=sent), 403, "foreign-origin")
    problem(client.post("/api/v1/tasks/7/acknowledgement", json={"revision": 3}, headers=sent), 403, "foreign-origin")
    assert controller.commands == []
    with pytest.raises(InvalidStatus) as refused, listen(server, headers=sent):
        pass
    assert refused.value.response.status_code == 403
    assert b"/problems/foreign-origin" in (refused.value.response.body or b"")


def test_a_foreign_host_opens_no_stream(server: Server) -> None:
    with socket.create_connection(("127.0.0.1", server.settings.port)) as raw:
        raw.sendall(
            b"GET /api/v1/stream HTTP/1.1\r\nHost: evil.example\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
        )
        assert raw.recv(4096).split()[1] == b"421"


def test_our_own_page_may_act(server: Server, client: httpx.Client, controller: Controller) -> None:
    for name in ("127.0.0.1", "localhost"):
        headers = {"Origin": f"http://{name}:{server.settings.port}", "Sec-Fetch-Site": "same-origin"}
        assert client.put("/api/v1/mode", json=MODE, headers=headers).status_code == 204
        with listen(server, headers=headers) as stream:
            assert '"snapshot"' in str(stream.recv(patience(2)))
    assert len(controller.commands) == 2


@pytest.mark.parametrize(
    "kind", [None, "text/plain", "application/x-www-form-urlencoded", "multipart/form-data", "application/ld+json"]
)
def test_only_json_is_read(client: httpx.Client, controller: Controller, kind: str | None) -> None:
    headers = {} if kind is None else {"Content-Type": kind}
    for method, path in (("PUT", "mode"), ("POST", "production/start"), ("POST", "tasks/7/acknowledgement")):
        answer = client.request(method, f"/api/v1/{path}", content=b'{"mode": "paused"}', headers=headers)
        problem(answer, 415, "not-json")
    assert controller.commands == []


def test_json_may_name_its_encoding(client: httpx.Client) -> None:
    headers = {"Content-Type": "application/json; charset=utf-8"}
    assert client.put("/api/v1/mode", content=b'{"mode": "paused"}', headers=headers).status_code == 204


FILES = ("/api/v1/model/recordings",)  # each is brought as it is, and a foreign page can send no such type either


def test_every_route_that_changes_something_reads_json_only(administrator: httpx.Client) -> None:
    paths = administrator.get("/api/v1/openapi.json").json()["paths"]
    changing = [(path, verb) for path, verbs in paths.items() for verb in verbs if verb not in ("get", "delete")]
    assert len(changing) == 90
    for path, verb in changing:
        address = path.replace("{", "").replace("}", "")
        answer = administrator.request(verb.upper(), address, headers={"Content-Type": "text/plain"})
        problem(answer, 415, "not-octets" if path in FILES else "not-json")


def in_pieces(size: int) -> Iterator[bytes]:
    for _ in range(0, size, 1024):
        yield b" " * 1024


def test_a_body_may_have_64_kib(client: httpx.Client, controller: Controller) -> None:
    headers = {"Content-Type": "application/json"}
    body = b'{"mode": "paused"}'.ljust(64 * 1024)
    assert client.put("/api/v1/mode", content=body, headers=headers).status_code == 204
    problem(client.put("/api/v1/mode", content=body + b" ", headers=headers), 413, "body-too-large")
    problem(client.put("/api/v1/mode", content=in_pieces(66 * 1024), headers=headers), 413, "body-too-large")
    assert len(controller.commands) == 1


@pytest.mark.parametrize("path", ["/", "/healthz", "/api/v1/station", "/api/v1/nothing"])
def test_every_answer_carries_the_security_headers(client: httpx.Client, path: str) -> None:
    headers = client.get(path).headers
    policy = headers["content-security-policy"]
    for rule in ("frame-ancestors 'none'", "base-uri 'self'", "object-src 'none'", "form-action 'self'"):
        assert rule in policy
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["x-frame-options"] == "DENY"
    assert headers["referrer-policy"] == "no-referrer"
    assert "server" not in headers
    assert "access-control-allow-origin" not in headers


def test_refusals_carry_the_security_headers_too(client: httpx.Client) -> None:
    assert "content-security-policy" in client.get("/", headers={"Host": "evil.example"}).headers
