"""The server with a certificate of its own, by its names over real TLS; and who is kept from what it serves so."""

from __future__ import annotations

import dataclasses
import socket
import ssl
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import InvalidStatus

from sequence_planner.auth.roles import Role
from sequence_planner.server.settings import Settings
from support.certificates import Certified, certify
from support.server import Controller, Loop, Server, first_message_over_tls
from support.waiting import PATIENCE, until

from .test_acting import problem

NAME = "station.example"


@dataclass(frozen=True)
class Secured:
    """A server that is opened as https://station.example:<port>, seen from a browser that trusts its authority."""

    server: Server
    certified: Certified

    @property
    def host(self) -> str:
        return f"{NAME}:{self.server.settings.port}"

    @property
    def trusting(self) -> ssl.SSLContext:
        return ssl.create_default_context(cafile=self.certified.authority)

    def browser(self, headers: dict[str, str] | None = None) -> httpx.Client:
        """No name server knows the name: the browser is told where it is, and asks for it by the name."""
        transport = _Resolved(self.server.settings.port, self.trusting)
        return httpx.Client(base_url=f"https://{self.host}", transport=transport, headers=headers, timeout=PATIENCE)

    def first_message(self, headers: dict[str, str]) -> str:
        """The first message of the station stream."""
        here = socket.create_connection(("127.0.0.1", self.server.settings.port))
        return first_message_over_tls(f"wss://{self.host}/api/v1/stream", self.trusting, headers, here)

    def signed_in(self, role: Role = Role.OPERATOR) -> dict[str, str]:
        return self.server.cookie(self.server.session(self.server.person(role))[0])


class _Resolved(httpx.BaseTransport):
    """Knows where the name is."""

    def __init__(self, port: int, trusting: ssl.SSLContext) -> None:
        self._port = port
        self._sending = httpx.HTTPTransport(verify=trusting)

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        request.extensions = {**request.extensions, "sni_hostname": request.url.host}
        request.url = request.url.copy_with(host="127.0.0.1", port=self._port)
        return self._sending.handle_request(request)

    def close(self) -> None:
        self._sending.close()


@pytest.fixture
def secured(loop: Loop, controller: Controller, settings: Settings, tmp_path: Path) -> Iterator[Secured]:
    certified = certify(tmp_path / "certificate", NAME)
    https = dataclasses.replace(
        settings,
        host="0.0.0.0",
        certificate=certified.certificate,
        private_key=certified.private_key,
        names=(NAME,),
    )
    server = Server(loop, https)
    server.start()
    secured = Secured(server, certified)
    with secured.browser() as browser:
        until(lambda: browser.get("/healthz").json()["controller"] == "heard")
    yield secured
    server.stop()


def test_it_is_opened_by_its_name_and_stays_with_https(secured: Secured) -> None:
    with secured.browser() as browser:
        for path in ("/", "/healthz", "/api/v1/session", "/api/v1/nothing"):
            headers = browser.get(path).headers
            assert headers["strict-transport-security"] == "max-age=31536000"
            assert "default-src 'self'" in headers["content-security-policy"]


def test_the_cookie_is_for_this_host_over_https_alone(secured: Secured) -> None:
    with secured.browser(secured.signed_in()) as browser:
        kept = browser.delete("/api/v1/session").headers["set-cookie"]
    name, *flags = kept.lower().split("; ")
    assert name.startswith("__host-sequence-planner=")
    assert {"secure", "httponly", "samesite=strict", "path=/"} <= set(flags)
    assert not any(flag.startswith("domain") for flag in flags)


def test_who_signed_in_acts_and_listens_by_name(secured: Secured, controller: Controller) -> None:
    origin = {"Origin": f"https://{secured.host}", "Sec-Fetch-Site": "same-origin"}
    with secured.browser(secured.signed_in() | origin) as browser:
        assert browser.put("/api/v1/mode", json={"mode": "paused"}).status_code == 204
    assert len(controller.commands) == 1
    assert '"snapshot"' in secured.first_message(secured.signed_in() | origin)


def test_a_client_that_closes_and_does_not_hang_up_does_not_keep_the_server_from_ending(secured: Secured) -> None:
    origin = {"Origin": f"https://{secured.host}"}
    key = "dGhlIHNhbXBsZSBub25jZQ=="
    asks = {"Host": secured.host, "Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13"}
    headers = asks | {"Sec-WebSocket-Key": key} | secured.signed_in() | origin
    head = "".join(f"{name}: {value}\r\n" for name, value in headers.items())
    plain = socket.create_connection(("127.0.0.1", secured.server.settings.port))
    with secured.trusting.wrap_socket(plain, server_hostname=NAME) as client:
        client.sendall(f"GET /api/v1/stream HTTP/1.1\r\n{head}\r\n".encode())
        assert client.recv(4096).startswith(b"HTTP/1.1 101 ")
        client.sendall(bytes([0x88, 0x80, 0, 0, 0, 0]))  # that it closes; a frame of RFC 6455
        before_it_hangs_up(client)
        secured.server.stop()
    with pytest.raises(httpx.ConnectError), secured.browser() as browser:
        browser.get("/healthz")


def before_it_hangs_up(client: ssl.SSLSocket) -> None:
    """Read until the server has closed its side, so that it waits for the client's."""
    client.settimeout(PATIENCE)
    while client.recv(4096):
        pass


FOREIGN_ORIGINS = (
    "https://evil.example",
    "https://evil.example:{port}",
    "http://station.example:{port}",  # not encrypted: whoever sits between may have written that page
    "https://station.example",  # another port of the same machine
    "https://sub.station.example:{port}",
    "wss://station.example:{port}",
    "https://127.0.0.1:{port}",
    "null",
)


def test_a_foreign_page_changes_nothing_and_opens_no_stream(secured: Secured, controller: Controller) -> None:
    known = secured.signed_in()
    for origin in FOREIGN_ORIGINS:
        headers = known | {"Origin": origin.format(port=secured.server.settings.port)}
        with secured.browser(headers) as browser:
            problem(browser.put("/api/v1/mode", json={"mode": "paused"}), 403, "foreign-origin")
            problem(browser.delete("/api/v1/session"), 403, "foreign-origin")
        with pytest.raises(InvalidStatus) as refused:
            secured.first_message(headers)
        assert refused.value.response.status_code == 403
    assert controller.commands == []


def test_a_name_that_was_made_to_resolve_to_it_is_not_answered(secured: Secured) -> None:
    """DNS rebinding: the page of evil.example asks us by its own name, with an address of ours behind it."""
    known = secured.signed_in()
    for host in ("evil.example", "evil.example:{port}", "127.0.0.1:{port}", "localhost:{port}", NAME, "0.0.0.0:{port}"):
        foreign = host.format(port=secured.server.settings.port)
        headers = known | {"Host": foreign, "Origin": f"https://{foreign}", "Sec-Fetch-Site": "same-origin"}
        with secured.browser(headers) as browser:
            for path in ("/", "/api/v1/station", "/api/v1/session"):
                problem(browser.get(path), 421, "wrong-host")
            problem(browser.put("/api/v1/mode", json={"mode": "paused"}), 421, "wrong-host")


def test_the_machine_itself_may_ask_whether_it_is_alive(secured: Secured) -> None:
    port = secured.server.settings.port
    with httpx.Client(verify=_trusting_anybody()) as checking:
        for name in ("127.0.0.1", "localhost"):
            headers = {"Host": f"{name}:{port}"}
            assert checking.get(f"https://127.0.0.1:{port}/healthz", headers=headers).status_code == 200
            problem(checking.get(f"https://127.0.0.1:{port}/", headers=headers), 421, "wrong-host")
        problem(checking.get(f"https://127.0.0.1:{port}/healthz", headers={"Host": "evil.example"}), 421, "wrong-host")


def test_plain_http_and_old_tls_are_not_spoken(secured: Secured) -> None:
    port = secured.server.settings.port
    with pytest.raises(httpx.TransportError):
        httpx.get(f"http://127.0.0.1:{port}/healthz")
    old = _trusting_anybody()
    old.set_ciphers("DEFAULT:@SECLEVEL=0")
    with pytest.warns(DeprecationWarning):
        old.minimum_version = old.maximum_version = ssl.TLSVersion.TLSv1_1
    with (
        socket.create_connection(("127.0.0.1", port)) as plain,
        pytest.raises(ssl.SSLError, match="protocol"),
        old.wrap_socket(plain),
    ):
        pass


def test_without_a_proxy_nobody_is_believed_to_be_one(secured: Secured) -> None:
    claimed = dict.fromkeys(("X-Forwarded-For", "X-Real-IP", "X-Forwarded-Host"), "203.0.113.9")
    body = {"name": "Nobody", "password": "a wrong password"}
    with secured.browser(claimed | {"Forwarded": "for=203.0.113.9", "X-Forwarded-Proto": "http"}) as browser:
        problem(browser.post("/api/v1/session", json=body), 401, "wrong-name-or-password")
    with secured.browser(secured.signed_in()) as browser:
        (record,) = browser.get("/api/v1/audit", params={"action": "sign-in"}).json()["records"]
    assert record["entry"]["actor"]["address"] == "127.0.0.1"


def _trusting_anybody() -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    return context
