"""The WebSocket as a page meets it."""

from __future__ import annotations

import json
import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from sequence_planner.execution.vocabulary import Mode
from support.example_view import example_view
from support.server import Controller, Server, listen
from support.waiting import patience, until

from .test_difference import apply

Message = dict[str, Any]


def hear(stream: ClientConnection, seconds: float = 3.0) -> Message:
    message: Message = json.loads(stream.recv(patience(seconds)))
    return message


def hear_kind(stream: ClientConnection, kind: str) -> Message:
    """The next message of `kind`; others may come before it."""
    for _ in range(200):
        if (message := hear(stream))["kind"] == kind:
            return message
    raise AssertionError(f"no {kind}")


@pytest.fixture
def stream(server: Server) -> Iterator[ClientConnection]:
    # A client that does not read cannot hear the answer to its goodbye, so it does not wait long for it.
    with listen(server, close_timeout=1) as stream:
        yield stream


def slow_client(server: Server, address: str | None = None) -> ClientConnection:
    """A client with little room for what it does not read: as soon as that is full, the server has to wait."""
    sock = socket.socket()
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 16 * 1024)
    sock.connect(("127.0.0.1", server.settings.port))
    return listen(server, address, sock=sock, max_queue=1, max_size=None, close_timeout=1)


def test_a_snapshot_and_its_deltas_are_the_view(stream: ClientConnection, controller: Controller) -> None:
    snapshot = hear(stream)
    assert snapshot["kind"] == "snapshot"
    document, sequence = snapshot["view"], snapshot["sequence"]
    changed = example_view(tick=2, time=5000.0, mode=Mode.PAUSED, tasks={}, resources={})
    controller.show(changed)
    while document["time"] < 5000.0:
        delta = hear_kind(stream, "delta")
        assert delta["sequence"] == sequence + 1
        sequence = delta["sequence"]
        document = apply(document, delta["changed"], delta["removed"])
    assert {**document, "time": 5000.0} == changed.model_dump(mode="json")
    assert delta["changed"].keys() <= {"tick", "time", "mode", "tasks", "resources"}


def test_only_what_changed_is_sent(stream: ClientConnection, controller: Controller) -> None:
    hear(stream)
    variables = dict(controller.view.variables)
    variables["robot.pose"] = variables["robot.pose"].model_copy(update={"value": "above_engine"})
    controller.show(example_view(time=5000.0, variables=variables))
    while (delta := hear_kind(stream, "delta"))["changed"]["time"] < 5000.0:
        assert delta["changed"].keys() == {"time"}
    assert delta["changed"].keys() == {"time", "variables"}
    assert delta["changed"]["variables"].keys() == {"robot.pose"}
    assert delta["removed"] == {}


def test_while_nothing_changes_a_fresh_time_comes_every_second(stream: ClientConnection) -> None:
    last = hear(stream)["view"]["time"]
    for _ in range(5):
        delta = hear(stream, 1.0)
        assert delta["changed"]["time"] > last
        last = delta["changed"]["time"]


def test_a_silent_controller_is_told_within_its_two_seconds_and_returns_with_a_snapshot(
    stream: ClientConnection, controller: Controller
) -> None:
    hear(stream)
    controller.publishing = False
    begun = time.monotonic()
    assert hear_kind(stream, "link")["controller"] == "lost"
    assert 1.5 < time.monotonic() - begun < patience(2.5)
    with pytest.raises(TimeoutError):
        stream.recv(0.5)
    controller.publishing = True
    assert (hear(stream)["controller"], hear(stream)["kind"]) == ("heard", "snapshot")
    assert hear(stream)["kind"] == "delta"


def test_no_old_view_is_shown_to_who_comes_or_asks_while_the_controller_is_lost(
    server: Server, stream: ClientConnection, controller: Controller
) -> None:
    controller.publishing = False
    hear_kind(stream, "link")
    with listen(server) as late:
        assert hear(late)["controller"] == "lost"
        late.send('{"kind": "resync"}')
        assert hear(late)["controller"] == "lost"
        controller.publishing = True
        assert (hear(late)["controller"], hear(late)["kind"]) == ("heard", "snapshot")


def test_a_snapshot_says_how_long_ago_the_controller_was_heard(
    server: Server, stream: ClientConnection, controller: Controller
) -> None:
    hear_kind(stream, "delta")
    with listen(server) as late:
        assert 0 <= hear(late)["age"] < patience(1)
    controller.publishing = False
    time.sleep(1)
    with listen(server) as late:
        assert 1 <= hear(late)["age"] < patience(2)


def test_a_controller_whose_time_stands_still_is_no_younger_for_what_it_shows(
    server: Server, stream: ClientConnection, controller: Controller
) -> None:
    """It may show what it knew once more to whoever connects, and hang."""
    hear_kind(stream, "delta")
    controller.publishing = False
    for _ in range(5):
        time.sleep(0.2)
        controller.show(controller.view)
    with listen(server) as late:
        assert hear_kind(late, "snapshot")["age"] >= 0.9


def test_who_comes_before_the_controller_gets_its_first_view(lonely_server: Server, controller: Controller) -> None:
    with listen(lonely_server) as stream:
        assert hear_kind(stream, "snapshot")["view"]["station"]["name"] == "bolting"


def test_a_client_may_ask_for_a_new_snapshot(stream: ClientConnection) -> None:
    first = hear(stream)
    stream.send('{"kind": "resync"}')
    again = hear_kind(stream, "snapshot")
    assert again["sequence"] >= first["sequence"]
    assert hear(stream)["sequence"] == again["sequence"] + 1


@pytest.mark.parametrize(
    "frame",
    [
        "",
        "{",
        "null",
        "[]",
        '{"kind": "dance"}',
        '{"kind": "resync", "more": 1}',
        "[" * 4000,
        '"' + "x" * 5000 + '"',
        "x" * 900_000,
        b'{"kind": "resync"}',
        '{"kind": "\\ud800"}',
    ],
)
def test_a_wrong_frame_is_answered_and_the_stream_goes_on(stream: ClientConnection, frame: str | bytes) -> None:
    stream.send(frame)
    assert hear_kind(stream, "error")["detail"]
    assert hear_kind(stream, "delta")["changed"]["time"] > 0


def test_many_wrong_frames_harm_nobody_else(server: Server, stream: ClientConnection) -> None:
    with listen(server) as calm:
        for _ in range(2000):
            stream.send("nonsense")
        hear(calm)
        for _ in range(5):
            # That many frames may keep the process busy for so long that it hears less of the controller for a moment.
            assert hear_kind(calm, "delta")


def test_every_client_sees_the_same_numbers(server: Server) -> None:
    with listen(server) as one, listen(server) as two:
        numbers = [{hear(stream)["sequence"] for _ in range(8)} for stream in (one, two)]
        assert len(numbers[0] & numbers[1]) >= 6


def test_a_slow_client_is_given_a_snapshot_then_dropped_and_slows_nobody(
    server: Server, controller: Controller
) -> None:
    def large(number: int) -> str:
        return f"{number} " * 60_000

    with slow_client(server) as slow, listen(server, max_size=None) as quick:
        hear(quick)
        begun = time.monotonic()
        for number in range(60):
            plan = controller.view.plan.model_copy(update={"reason": large(number)})
            controller.show(controller.view.model_copy(update={"plan": plan, "tick": number + 2}))
            while hear(quick, 1.0)["changed"].get("tick", 0) < number + 2:
                pass
        assert time.monotonic() - begun < patience(12)
        until(lambda: time.monotonic() - begun > 4)
        seen = []
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                seen.append(hear(slow, 5.0))
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1013
        assert len(seen) < 60
        assert hear_kind(quick, "delta")


def test_a_slow_client_that_catches_up_goes_on_from_a_fresh_snapshot(server: Server, controller: Controller) -> None:
    with slow_client(server) as slow:
        for number in range(20):
            plan = controller.view.plan.model_copy(update={"reason": f"{number} " * 250_000})
            controller.show(controller.view.model_copy(update={"plan": plan, "tick": number + 2}))
            time.sleep(0.055)
        document: Message = {}
        snapshots, sequence = 0, 0
        while document.get("tick") != 21:
            message = hear(slow)
            if message["kind"] == "snapshot":
                snapshots += 1
                document = message["view"]
            else:
                assert message["sequence"] == sequence + 1
                document = apply(document, message["changed"], message["removed"])
            sequence = message["sequence"]
        assert snapshots >= 2
        assert document["plan"]["reason"].startswith("19 ")


def test_nobody_takes_the_places_of_all_others(server: Server) -> None:
    greedy = server.cookie(server.session(server.person())[0])
    with ExitStack() as stack:
        for _ in range(server.settings.stream.of_one):
            hear(stack.enter_context(listen(server, headers=greedy)))
        with pytest.raises(ConnectionClosed) as closed:
            stack.enter_context(listen(server, headers=greedy)).recv(patience(2))
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1013
        hear(stack.enter_context(listen(server)))
    until(lambda: not server.app.state.streams)


def test_too_many_clients_are_told_to_come_later(server: Server) -> None:
    with ExitStack() as streams:
        for _ in range(server.settings.stream.clients):
            streams.enter_context(listen(server))
        with listen(server) as late, pytest.raises(ConnectionClosed) as closed:
            late.recv(patience(2))
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1013
    with listen(server) as stream:
        assert hear(stream)["kind"] == "snapshot"
