"""The server behind a reverse proxy: only the proxy is served, and what it says of its client is believed, no more."""

from __future__ import annotations

import dataclasses
import socket
from collections.abc import Iterator

import httpx
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from sequence_planner.auth.roles import Role
from sequence_planner.server.http import middleware
from sequence_planner.server.settings import Settings
from support.server import Controller, Loop, Server
from support.waiting import patience

from .test_acting import problem

NAME = "station.example"
PROXY, STRANGER = "127.0.0.2", "127.0.0.3"  # where they connect from
CLIENT = "203.0.113.7"
FORWARDED = {"Host": NAME, "X-Forwarded-Proto": "https", "X-Forwarded-For": CLIENT}


@pytest.fixture
def proxied(loop: Loop, controller: Controller, settings: Settings) -> Iterator[Server]:
    server = Server(loop, dataclasses.replace(settings, proxies=(PROXY, "2001:db8::1"), names=(NAME,)))
    server.start()
    server.hear_controller()
    yield server
    server.stop()


def connected_from(address: str, server: Server, headers: dict[str, str] | None = None) -> httpx.Client:
    transport = httpx.HTTPTransport(local_address=address)
    return httpx.Client(base_url=server.address, transport=transport, headers=FORWARDED if headers is None else headers)


def signed_in(server: Server) -> dict[str, str]:
    return server.cookie(server.session(server.person(Role.OPERATOR))[0])


def tried_from(proxied: Server, headers: dict[str, str], name: str) -> str:
    """The address that a wrong password for `name`, sent on by the proxy with `headers`, was recorded with."""
    body = {"name": name, "password": "a wrong password"}
    with connected_from(PROXY, proxied, headers) as browser:
        problem(browser.post("/api/v1/session", json=body), 401, "wrong-name-or-password")
    with connected_from(PROXY, proxied, FORWARDED | signed_in(proxied)) as browser:
        (record, *_) = browser.get("/api/v1/audit", params={"action": "sign-in"}).json()["records"]
    assert (record["entry"]["actor"]["name"], record["entry"]["outcome"]) == ("unknown", "refused")
    address: str = record["entry"]["actor"]["address"]
    return address


def test_through_the_proxy_who_signed_in_acts_and_listens(proxied: Server, controller: Controller) -> None:
    headers = FORWARDED | signed_in(proxied) | {"Origin": f"https://{NAME}", "Sec-Fetch-Site": "same-origin"}
    with connected_from(PROXY, proxied, headers) as browser:
        answer = browser.put("/api/v1/mode", json={"mode": "paused"})
        assert answer.status_code == 204
        assert "strict-transport-security" in answer.headers
        assert "; secure" in browser.delete("/api/v1/session").headers["set-cookie"].lower()
    assert len(controller.commands) == 1
    headers |= signed_in(proxied)
    del headers["Host"]
    sock = socket.create_connection(("127.0.0.1", proxied.settings.port), source_address=(PROXY, 0))
    with connect(f"ws://{NAME}/api/v1/stream", sock=sock, additional_headers=headers) as stream:
        assert '"snapshot"' in str(stream.recv(patience(2)))


def test_nobody_but_the_proxy_is_served(proxied: Server) -> None:
    """Whatever they say of themselves."""
    known = FORWARDED | signed_in(proxied)
    for headers in (known, known | {"X-Forwarded-For": PROXY}, known | {"Forwarded": f"for={PROXY}"}):
        with connected_from(STRANGER, proxied, headers) as stranger:
            for path in ("/", "/healthz", "/api/v1/session", "/api/v1/station"):
                problem(stranger.get(path), 403, "not-the-proxy")


def test_nobody_but_the_proxy_opens_a_stream(proxied: Server) -> None:
    sock = socket.create_connection(("127.0.0.1", proxied.settings.port), source_address=(STRANGER, 0))
    headers = {"X-Forwarded-Proto": "https", "X-Forwarded-For": CLIENT} | signed_in(proxied)
    with (
        pytest.raises(InvalidStatus) as refused,
        connect(f"ws://{NAME}/api/v1/stream", sock=sock, additional_headers=headers),
    ):
        pass
    assert refused.value.response.status_code == 403


def test_the_machine_itself_may_ask_whether_it_is_alive(proxied: Server) -> None:
    with connected_from("127.0.0.1", proxied, {}) as checking:
        assert checking.get("/healthz").status_code == 200
        problem(checking.get("/api/v1/session"), 403, "not-the-proxy")
        problem(checking.get("/healthz", headers={"Host": NAME}), 403, "not-the-proxy")


def test_what_did_not_come_over_https_is_refused(proxied: Server) -> None:
    headers = {"Host": NAME, "X-Forwarded-For": CLIENT} | signed_in(proxied)
    for said in ({}, {"X-Forwarded-Proto": "http"}, {"X-Forwarded-Proto": "https, http"}):
        with connected_from(PROXY, proxied, headers | said) as browser:
            problem(browser.get("/api/v1/station"), 403, "not-encrypted")


def test_a_proxy_that_does_not_say_who_asks_is_not_served(proxied: Server) -> None:
    for said in (None, "", "unknown", "localhost", f"{CLIENT},", f"{CLIENT}:1234"):
        headers = {"Host": NAME, "X-Forwarded-Proto": "https"} | ({} if said is None else {"X-Forwarded-For": said})
        with connected_from(PROXY, proxied, headers) as browser:
            problem(browser.get("/api/v1/session"), 400, "no-client-address")


def test_exactly_the_last_hop_is_believed(proxied: Server) -> None:
    for number, (said, believed) in enumerate(
        [
            (CLIENT, CLIENT),
            (f"198.51.100.1, {CLIENT}", CLIENT),  # the client wrote the first itself
            (f"198.51.100.1, {PROXY}", PROXY),  # one hop: a proxy's own address is not looked behind
            (f"nonsense, , {CLIENT}", CLIENT),
            ("2001:db8::7", "2001:db8::7"),
        ]
    ):
        assert tried_from(proxied, FORWARDED | {"X-Forwarded-For": said}, f"Person {number}") == believed


def test_other_headers_change_nothing(proxied: Server) -> None:
    others = dict.fromkeys(("Forwarded", "X-Real-IP", "X-Forwarded-Host", "X-Original-URL"), "198.51.100.1")
    assert tried_from(proxied, FORWARDED | others, "Nobody") == CLIENT


def test_a_foreign_name_is_refused_through_the_proxy_too(proxied: Server) -> None:
    known = FORWARDED | signed_in(proxied)
    for host in ("evil.example", f"{NAME}:8000", "127.0.0.1:{port}", "localhost:{port}"):
        with connected_from(PROXY, proxied, known | {"Host": host.format(port=proxied.settings.port)}) as browser:
            problem(browser.get("/api/v1/station"), 421, "wrong-host")


def test_a_foreign_page_is_refused_through_the_proxy_too(proxied: Server, controller: Controller) -> None:
    for origin in ("https://evil.example", f"http://{NAME}", f"https://{NAME}:8443", "null"):
        with connected_from(PROXY, proxied, FORWARDED | signed_in(proxied) | {"Origin": origin}) as browser:
            problem(browser.put("/api/v1/mode", json={"mode": "paused"}), 403, "foreign-origin")
    assert controller.commands == []


def test_behind_the_proxy_connections_are_counted_by_who_it_says(
    proxied: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(middleware.MOST_OF_ONE, middleware.ConnectionKind.ADDRESS, 2)

    def asked(client: str) -> socket.socket:
        made = socket.create_connection(("127.0.0.1", proxied.settings.port), 10, (PROXY, 0))
        headers = "".join(f"{name}: {value}\r\n" for name, value in {**FORWARDED, "X-Forwarded-For": client}.items())
        made.sendall(f"GET /healthz HTTP/1.1\r\n{headers}\r\n".encode())
        received = b""
        while not received.endswith(b"}"):
            received += made.recv(65536)
        assert received.startswith(b"HTTP/1.1 200")
        return made

    kept = [asked(client) for client in ("2001:db8:1::1", CLIENT, "2001:db8:1::2", "2001:db8:1:0:5::3")]
    assert kept[0].recv(1) == b""
    for each in kept[1:]:
        each.setblocking(False)
        with pytest.raises(BlockingIOError):
            each.recv(1)
    for each in kept:
        each.close()
