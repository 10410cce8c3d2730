"""One attempt to deliver: taken with 2xx in time, by whom it was meant for, or not delivered."""

from __future__ import annotations

import asyncio
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from mes.receiver import Answer, Receiver, breaks_off, drips, floods, hangs, receiving, status, talks_nonsense
from sequence_planner.mes.webhooks.delivery import Patience, Sender, Undelivered
from sequence_planner.mes.webhooks.targets import Targets, network
from support.certificates import certify
from support.waiting import patience

OVER = threading.Event()
PATIENCE = Patience()
IMPATIENT = Patience(connecting=0.5, reading=0.3, all=0.6)  # with whoever never answers
NAME = "mes.example"


@pytest.fixture(scope="module")
def receiver() -> Iterator[Receiver]:
    with receiving() as receiver:
        yield receiver
        OVER.set()


@pytest.fixture(autouse=True)
def _fresh(receiver: Receiver) -> None:
    receiver.received.clear()
    receiver.answers.clear()


def post(
    receiver: Receiver,
    url: str | None = None,
    *,
    hosts: tuple[str, ...] = ("127.0.0.1", NAME),
    patience: Patience = PATIENCE,
) -> None:
    targets = Targets(frozenset((host, receiver.port) for host in hosts), loopback=True)
    asyncio.run(Sender(targets, patience).post(url or receiver.url(), {"webhook-id": "event-1"}, b'{"number":1}'))


def resolving(monkeypatch: pytest.MonkeyPatch, *answers: str) -> list[str]:
    """The name means these addresses, each time it is asked for the next; what has been asked for."""
    asked: list[str] = []
    real = socket.getaddrinfo

    def getaddrinfo(host: str, port: int, *rest: object, **named: object) -> object:
        if host != NAME:
            return real(host, port, *rest, **named)  # type: ignore[arg-type]
        asked.append(host)
        family = socket.AF_INET6 if ":" in answers[len(asked) - 1] else socket.AF_INET
        return [(family, socket.SOCK_STREAM, 6, "", (answers[len(asked) - 1], port))]

    monkeypatch.setattr(socket, "getaddrinfo", getaddrinfo)
    return asked


@pytest.mark.parametrize("code", [200, 202, 204])
def test_it_is_delivered_as_it_is(receiver: Receiver, code: int) -> None:
    receiver.answers.append(status(code))
    post(receiver, receiver.url("/hook?a=b"))
    (received,) = receiver.received
    assert (received.path, received.body) == ("/hook?a=b", b'{"number":1}')
    assert received.headers["content-type"] == "application/json"
    assert received.headers["webhook-id"] == "event-1"
    assert received.headers["host"] == f"127.0.0.1:{receiver.port}"


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (status(500), "status 500"),
        (status(404), "status 404"),
        (status(304), "status 304"),
        (breaks_off, "breaks off"),
        (talks_nonsense, "breaks off"),
    ],
)
def test_whatever_else_the_other_end_says_it_is_not_delivered(receiver: Receiver, answer: Answer, words: str) -> None:
    receiver.answers.append(answer)
    with pytest.raises(Undelivered, match=words):
        post(receiver)
    assert len(receiver.received) == 1, "one attempt is one request"


@pytest.mark.parametrize(("answer", "words"), [(hangs(OVER), "answer"), (drips(OVER), "no answer within 0.6 s")])
def test_whoever_never_comes_to_an_answer_is_not_waited_for(receiver: Receiver, answer: Answer, words: str) -> None:
    receiver.answers.append(answer)
    began = time.monotonic()
    with pytest.raises(Undelivered, match=words):
        post(receiver, patience=IMPATIENT)
    assert time.monotonic() - began < patience(5)


def test_one_that_takes_it_is_not_listened_to_further(receiver: Receiver) -> None:
    receiver.answers.append(floods(OVER))
    post(receiver)


@pytest.mark.parametrize("code", [301, 302, 303, 307, 308])
def test_no_redirect_is_followed(receiver: Receiver, code: int) -> None:
    with receiving() as elsewhere:
        receiver.answers.append(status(code, {"location": elsewhere.url()}))
        with pytest.raises(Undelivered, match=f"status {code}; redirects are not followed"):
            post(receiver)
        assert elsewhere.received == []
    assert len(receiver.received) == 1


def test_nobody_there_is_told(receiver: Receiver) -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
        targets = Targets(frozenset({("127.0.0.1", port)}), loopback=True)
        with pytest.raises(Undelivered, match="cannot be connected to"):
            asyncio.run(Sender(targets, PATIENCE).post(f"http://127.0.0.1:{port}/", {}, b""))


def test_one_that_is_taken_from_the_list_is_not_sent_to(receiver: Receiver) -> None:
    with pytest.raises(Undelivered, match="not on the list"):
        post(receiver, hosts=(NAME,))
    assert receiver.received == []


def test_no_proxy_and_no_password_of_the_environment_is_used(
    receiver: Receiver, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "netrc").write_text("machine 127.0.0.1 login somebody password secret\n")
    monkeypatch.setenv("NETRC", str(tmp_path / "netrc"))
    for name in ("HTTP_PROXY", "http_proxy", "ALL_PROXY", "HTTPS_PROXY"):
        monkeypatch.setenv(name, "http://127.0.0.1:9")
    post(receiver)
    assert "authorization" not in receiver.received[0].headers


def test_the_address_that_was_judged_is_the_one_that_is_connected_to(
    receiver: Receiver, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = resolving(monkeypatch, "127.0.0.1")  # asked a second time, it would have no answer
    post(receiver, receiver.url(host=NAME))
    assert asked == [NAME]
    assert receiver.received[0].headers["host"] == f"{NAME}:{receiver.port}"


def test_a_name_that_means_a_private_address_later_is_not_sent_to(
    receiver: Receiver, monkeypatch: pytest.MonkeyPatch
) -> None:
    resolving(monkeypatch, "127.0.0.1", "169.254.169.254", "::ffff:10.0.0.1")
    post(receiver, receiver.url(host=NAME))
    for _ in range(2):
        with pytest.raises(Undelivered, match="not public"):
            post(receiver, receiver.url(host=NAME))
    assert len(receiver.received) == 1


def test_https_is_spoken_with_whom_the_certificate_names(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    right, wrong = certify(tmp_path / "right", NAME), certify(tmp_path / "wrong", "other.example", "127.0.0.1")
    both = tmp_path / "authorities.pem"
    both.write_bytes(right.authority.read_bytes() + wrong.authority.read_bytes())
    monkeypatch.setenv("SSL_CERT_FILE", str(both))
    resolving(monkeypatch, *["127.0.0.1"] * 3)
    with receiving(right) as meant, receiving(wrong) as other:
        post(meant, meant.url(host=NAME, scheme="https"))
        assert meant.received[0].headers["host"] == f"{NAME}:{meant.port}"
        with pytest.raises(Undelivered, match=r"(?i)certificate"):
            post(other, other.url(host=NAME, scheme="https"))
        assert other.received == []
        monkeypatch.setenv("SSL_CERT_FILE", str(wrong.authority))
        with pytest.raises(Undelivered, match=r"(?i)certificate"):
            post(meant, meant.url(host=NAME, scheme="https"))
        assert len(meant.received) == 1


# 127.0.50.0/24 stands for a network of the plant: --webhook-loopback lets what is on the list be this machine.
PLANT = Targets(loopback=True, networks=(network("127.0.50.0/24"),))


def deliver(receiver: Receiver, targets: Targets) -> None:
    url = f"http://{NAME}:{receiver.port}/hook"
    asyncio.run(Sender(targets, PATIENCE).post(url, {"webhook-id": "event-1"}, b"{}"))


def test_a_host_in_a_network_of_the_list_is_delivered_to(monkeypatch: pytest.MonkeyPatch) -> None:
    with receiving(address="127.0.50.7") as plant:
        asked = resolving(monkeypatch, "127.0.50.7")
        deliver(plant, PLANT)
        assert [each.headers["host"] for each in plant.received] == [f"{NAME}:{plant.port}"]
        assert asked == [NAME], "what was looked at is what was connected to"


def test_a_name_that_means_another_network_later_is_delivered_to_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    with receiving(address="127.0.51.7") as other:
        asked = resolving(monkeypatch, "127.0.51.7", "169.254.169.254", "10.0.0.1")
        for words in ("not on the list", "not on the list", "not on the list"):
            with pytest.raises(Undelivered, match=words):
                deliver(other, PLANT)
        assert other.received == []
        assert asked == [NAME] * 3


def test_without_loopback_a_network_of_it_is_not_sent_to(monkeypatch: pytest.MonkeyPatch) -> None:
    with receiving(address="127.0.50.7") as plant:
        resolving(monkeypatch, "127.0.50.7")
        with pytest.raises(Undelivered, match="this machine"):
            asyncio.run(
                Sender(Targets(networks=PLANT.networks), PATIENCE).post(f"https://{NAME}:{plant.port}/", {}, b"{}")
            )
        assert plant.received == []
