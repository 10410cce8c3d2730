"""The transport over rosbridge: its contract, the JSON it speaks, and servers that go away or speak nonsense."""

from __future__ import annotations

import asyncio
import json
import math
import socket
import threading
import time
from collections.abc import Awaitable, Callable, Iterator, Sequence
from functools import cache, partial

import pytest
from hypothesis import given
from structlog.testing import capture_logs

from core.choices import Choices, made_by
from rosbridge.server import RosbridgeServer
from sequence_planner.ros.exclusivity import require_sole_publisher
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NetworkEndpoint, Sample, TransportError
from sequence_planner.ros.transports.rosbridge import PING_EVERY, SILENCE, RosbridgeTransport, from_json, to_json
from sequence_planner.ros.types.definitions import FieldType
from sequence_planner.ros.types.errors import MalformedMessageError, MessageValueError
from sequence_planner.ros.types.messages import MessageRegistry
from support.examples import examples
from support.waiting import patience, until_async

TEXT, NUMBER, JOINTS = "std_msgs/msg/String", "std_msgs/msg/Int32", "sensor_msgs/msg/JointState"
IMAGE = "sensor_msgs/msg/CompressedImage"
RELIABLE, LATCHED = QualityOfService.RELIABLE, QualityOfService.LATCHED


@cache
def registry() -> MessageRegistry:
    return MessageRegistry.from_folder(None)


@pytest.fixture
def server() -> Iterator[RosbridgeServer]:
    running = RosbridgeServer()
    yield running
    running.close()


class Listener:
    """Keeps what a subscription receives."""

    def __init__(self) -> None:
        self.samples: list[Sample] = []
        self.threads: set[int] = set()

    def __call__(self, batch: Sequence[Sample]) -> None:
        self.samples += batch
        self.threads.add(threading.get_ident())

    @property
    def texts(self) -> list[object]:
        return [registry().decode(TEXT, sample.data)["data"] for sample in self.samples if sample.data]


class Network:
    """Transports to one server."""

    def __init__(self, url: str) -> None:
        self.url = url
        self.joined: list[RosbridgeTransport] = []

    def join(self, node_name: str = "station") -> RosbridgeTransport:
        self.joined.append(RosbridgeTransport(self.url, registry(), node_name, asyncio.get_running_loop()))
        return self.joined[-1]


def play(url: str, scenario: Callable[[Network], Awaitable[None]]) -> None:
    """Run `scenario` on transports to the server at `url`; afterwards none of their threads is left."""
    before = set(threading.enumerate())

    async def run() -> None:
        network = Network(url)
        try:
            await scenario(network)
        finally:
            for transport in network.joined:
                transport.close()

    asyncio.run(run())
    assert set(threading.enumerate()) <= before


def say(transport: RosbridgeTransport, topic: str, text: str) -> None:
    transport.publish(topic, TEXT, registry().encode(TEXT, {"data": text}))


def foreign(transport: RosbridgeTransport) -> list[NetworkEndpoint]:
    return [endpoint for endpoint in transport.graph() if not endpoint.own]


def test_samples_arrive_in_order_on_the_event_loop(server: RosbridgeServer) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        listener, before = Listener(), time.monotonic()
        station.subscribe("/tool/state", TEXT, RELIABLE, listener)
        device.advertise("/tool/state", TEXT, RELIABLE)
        await until_async(lambda: server.subscribed("/tool/state") and len(server.operations) == 2, "both are there")
        for text in ("one", "", "trois", "vier", "fünf 語"):
            say(device, "/tool/state", text)
        await until_async(lambda: len(listener.samples) == 5, "all samples arrive")
        assert listener.texts == ["one", "", "trois", "vier", "fünf 語"]
        assert listener.threads == {threading.get_ident()}
        received = [sample.received for sample in listener.samples]
        assert received == sorted(received)
        assert before <= received[0] <= time.monotonic()

    play(server.url, scenario)


def test_the_graph_holds_ones_own_and_those_heard(server: RosbridgeServer) -> None:
    async def scenario(network: Network) -> None:
        station = network.join()
        station.advertise("/tool/command", TEXT, LATCHED)
        station.subscribe("/tool/state", TEXT, RELIABLE, Listener())
        assert [(e.topic, e.direction, e.node, e.transient_local) for e in station.graph()] == [
            ("/tool/command", "publisher", "/station", True),
            ("/tool/state", "subscriber", "/station", False),
        ]
        await until_async(lambda: server.subscribed("/tool/state"), "the server knows")
        assert foreign(station) == []
        server.publish("/tool/state", "std_msgs/String", {"data": "idle"})
        await until_async(lambda: foreign(station), "the node is heard")
        [heard] = foreign(station)
        assert (heard.topic, heard.type_name, heard.direction, heard.node) == ("/tool/state", TEXT, "publisher", None)
        server.stop()
        await until_async(lambda: not foreign(station), "without a connection nobody is there")

    play(server.url, scenario)


def test_a_late_joiner_gets_the_last_sample_of_a_latched_topic(server: RosbridgeServer) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        for topic, quality in (("/latched", LATCHED), ("/volatile", RELIABLE)):
            device.advertise(topic, TEXT, quality)
            for text in ("old", "last"):
                say(device, topic, text)
        await until_async(lambda: server.published("/latched")[-1:] == [{"data": "last"}], "all is said")
        latched, volatile = Listener(), Listener()
        station.subscribe("/latched", TEXT, LATCHED, latched)
        station.subscribe("/volatile", TEXT, RELIABLE, volatile)
        await until_async(lambda: latched.texts == ["last"], "the last one comes")
        assert volatile.samples == []

    play(server.url, scenario)


def test_messages_are_written_as_ros_1_writes_them(server: RosbridgeServer) -> None:
    joints = {
        "header": {"stamp": {"sec": 5, "nanosec": 7}, "frame_id": "base"},
        "name": ["a"],
        "position": [1.5],
        "velocity": [math.nan],
        "effort": [],
    }

    async def scenario(network: Network) -> None:
        station, listener = network.join(), Listener()
        for topic, type_name, values in (("/joints", JOINTS, joints), ("/image", IMAGE, {"data": [0, 255, 16]})):
            station.advertise(topic, type_name, RELIABLE)
            station.subscribe(topic, type_name, RELIABLE, listener)
            await until_async(partial(server.subscribed, topic), "the server knows")
            station.publish(topic, type_name, registry().encode(type_name, values))
        await until_async(lambda: len(listener.samples) == 2, "both come back")
        [written] = server.published("/joints")
        assert written["header"] == {"stamp": {"secs": 5, "nsecs": 7}, "frame_id": "base"}
        assert written["velocity"] == [None]
        assert server.published("/image")[0]["data"] == "AP8Q"
        assert {operation["type"] for operation in server.operations if "type" in operation} == {
            "sensor_msgs/JointState",
            "sensor_msgs/CompressedImage",
        }
        heard = registry().decode(JOINTS, listener.samples[0].data)
        assert str(heard.pop("velocity")) == "[nan]"
        assert heard == {name: value for name, value in joints.items() if name != "velocity"}
        assert registry().decode(IMAGE, listener.samples[1].data)["data"] == [0, 255, 16]

    play(server.url, scenario)


def test_a_header_of_ros_1_has_a_number_more(server: RosbridgeServer) -> None:
    header = {"seq": 9, "stamp": {"secs": 1, "nsecs": 2}, "frame_id": "x"}
    assert from_json(registry(), "std_msgs/msg/Header", header) == {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "x"}


LAWFUL = (JOINTS, IMAGE, "diagnostic_msgs/msg/DiagnosticArray", "geometry_msgs/msg/PoseStamped", "std_msgs/msg/Empty")


def some_values(choices: Choices, type_name: str) -> dict[str, object]:
    return {name: some_value(choices, field) for name, field in registry().fields(type_name).items()}


def some_value(choices: Choices, field: FieldType) -> object:
    if field.array is not None:
        count = field.array if isinstance(field.array, int) else choices.number(0, 3)
        return [some_value(choices, field.element) for _ in range(count)]
    if field.kind == "message":
        return some_values(choices, field.type_name)
    least, most = field.range or (0, 0)
    return {
        "bool": choices.chance(2),
        "int": choices.pick([max(0, least), least, most]),
        "float": choices.pick([0.0, -1.5, 1e-300, math.inf]) if field.type_name == "float64" else 0.5,
        "string": choices.pick(["", "a", 'ä語"\\', "\n"]),
    }[field.kind]


def without_infinities(value: object) -> object:
    """`value` as JSON leaves it: what is no number is none at all."""
    match value:
        case dict():
            return {name: without_infinities(inner) for name, inner in value.items()}
        case list():
            return [without_infinities(inner) for inner in value]
        case float():
            return value if math.isfinite(value) else "none"
    return value


@given(made_by(lambda choices: (name := choices.pick(LAWFUL), some_values(choices, name))))
@examples(150)
def test_a_message_survives_its_journey_through_json(drawn: tuple[str, dict[str, object]]) -> None:
    type_name, values = drawn
    frame = json.dumps(to_json(registry(), type_name, values), allow_nan=False)
    back = from_json(registry(), type_name, json.loads(frame))
    assert without_infinities(back) == without_infinities(values)
    registry().encode(type_name, back)


def some_json(choices: Choices, depth: int = 4) -> object:
    """Anything that JSON can say, with the names that messages use."""
    names = ("header", "stamp", "secs", "nsecs", "sec", "name", "position", "data", "pose", "status", "x", "")
    kind = choices.number(0, 8 if depth else 6)
    if kind == 7:
        return [some_json(choices, depth - 1) for _ in range(choices.number(0, 3))]
    if kind == 8:
        return {choices.pick(names): some_json(choices, depth - 1) for _ in range(choices.number(0, 5))}
    return (None, True, 0, -1.5, 2**70, "AAA=", math.inf)[kind]


def with_one_replaced(choices: Choices, value: object) -> object:
    """`value` with anything at all in one place."""
    if isinstance(value, dict) and value and not choices.chance(4):
        name = choices.pick(list(value))
        return {**value, name: with_one_replaced(choices, value[name])}
    return some_json(choices)


def some_near_message(choices: Choices) -> tuple[str, object]:
    type_name = choices.pick(LAWFUL)
    return type_name, with_one_replaced(choices, to_json(registry(), type_name, some_values(choices, type_name)))


@given(made_by(some_near_message))
@examples(400)
def test_whatever_comes_is_a_message_or_refused_as_none(drawn: tuple[str, object]) -> None:
    type_name, message = drawn
    try:
        data = registry().encode(type_name, from_json(registry(), type_name, message))
    except MessageValueError:
        return
    registry().decode(type_name, data)


@pytest.mark.parametrize(
    ("type_name", "message", "place"),
    [
        (TEXT, {"data": "a", "more": 1}, ""),
        (TEXT, {}, "data"),
        (TEXT, [], ""),
        (JOINTS, {"header": {"stamp": 3, "frame_id": ""}}, ""),
        (IMAGE, {"header": {"stamp": {"secs": 0, "nsecs": 0}, "frame_id": ""}, "format": "", "data": "*"}, "data"),
    ],
)
def test_a_message_of_another_definition_is_none(type_name: str, message: object, place: str) -> None:
    with pytest.raises(MessageValueError) as refused:
        from_json(registry(), type_name, message)
    assert refused.value.path.startswith(place)


def test_nonsense_is_said_once_for_each_cause_and_the_work_goes_on(server: RosbridgeServer) -> None:
    nonsense = [
        "{",
        "[1, 2]",
        '"publish"',
        '{"op": "fragment", "id": "1", "data": "{", "num": 0, "total": 2}',
        '{"op": "publish", "topic": "/nobody/asked", "msg": {}}',
        '{"op": "publish", "topic": "/tool/state"}',
        '{"op": "status", "level": "error", "msg": "/tool/state is std_msgs/Int32"}',
        "[" * 5000,
    ]

    async def scenario(network: Network) -> None:
        station, listener = network.join(), Listener()
        station.subscribe("/tool/state", TEXT, RELIABLE, listener)
        await until_async(lambda: server.subscribed("/tool/state"), "the server knows")
        for _ in range(20):
            for frame in nonsense:
                server.send(frame)
            server.publish("/tool/state", "std_msgs/String", {"data": 5})
        server.publish("/tool/state", "std_msgs/String", {"data": "idle"})
        await until_async(lambda: listener.texts == ["idle"], "what makes sense arrives")
        # Of a message that is none it is said that there was one: what it would have told is unknown.
        assert len(listener.samples) == 21
        for sample in listener.samples[:20]:
            assert sample.trouble == "std_msgs/msg/String data: expected string, found 5 (int)"
            with pytest.raises(MalformedMessageError):
                registry().decode(TEXT, sample.data)

    with capture_logs() as log:
        play(server.url, scenario)
    said = [event["trouble"] for event in log if event["event"] == "message of rosbridge not understood"]
    assert said == [
        "not JSON",
        "not an operation",
        "the operation 'fragment' is not understood",
        "the server says: /tool/state is std_msgs/Int32",
        "not a std_msgs/msg/String: data",
    ]


def test_a_server_that_comes_back_is_used_again_and_gets_no_old_commands(server: RosbridgeServer) -> None:
    async def scenario(network: Network) -> None:
        station, listener = network.join(), Listener()
        station.subscribe("/tool/state", TEXT, RELIABLE, listener)
        station.advertise("/tool/command", TEXT, RELIABLE)
        station.advertise("/tool/mode", TEXT, LATCHED)
        say(station, "/tool/mode", "slow")
        await until_async(lambda: server.subscribed("/tool/state"), "the server knows")
        say(station, "/tool/command", "heard")
        await until_async(lambda: server.published("/tool/command"), "a command arrives")
        server.publish("/tool/state", "std_msgs/String", {"data": "before"})
        await until_async(lambda: foreign(station), "the node is heard")

        server.stop()
        await until_async(lambda: not foreign(station), "the loss is seen")
        for _ in range(100):
            say(station, "/tool/command", "into the void")
        say(station, "/tool/mode", "fast")
        server.operations.clear()
        server.start()
        await until_async(lambda: server.subscribed("/tool/state"), "it is subscribed to again")
        await until_async(lambda: server.published("/tool/mode") == [{"data": "fast"}], "what is latched is said again")
        server.publish("/tool/state", "std_msgs/String", {"data": "after"})
        say(station, "/tool/command", "now")
        await until_async(lambda: listener.texts == ["before", "after"], "samples arrive again")
        await until_async(lambda: server.published("/tool/command"), "commands arrive again")
        assert server.published("/tool/command") == [{"data": "now"}]

    with capture_logs() as log:
        play(server.url, scenario)
    events = [event["event"] for event in log]
    assert events.count("connected to rosbridge") == 2
    assert events.count("the connection to rosbridge is lost; it is sought again") == 1


def test_who_else_commands_a_device_is_noticed_by_his_words(server: RosbridgeServer) -> None:
    async def scenario(network: Network) -> None:
        other = network.join("other")
        other.advertise("/tool/command", TEXT, RELIABLE)

        async def command() -> None:
            while True:
                say(other, "/tool/command", "go")
                await asyncio.sleep(0.1)

        commanding = asyncio.create_task(command())
        with pytest.raises(TransportError, match="somebody else publishes /tool/command: the station would fight"):
            await require_sole_publisher(network.join("question"), {"/tool/command": TEXT}, "the station")
        commanding.cancel()
        await require_sole_publisher(network.join("question"), {"/tool/command": TEXT}, "the station")

    play(server.url, scenario)


def test_a_server_that_freezes_counts_as_gone(server: RosbridgeServer) -> None:
    async def scenario(network: Network) -> None:
        station = network.join()
        station.subscribe("/tool/state", TEXT, RELIABLE, Listener())
        await until_async(lambda: server.subscribed("/tool/state"), "the server knows")
        server.publish("/tool/state", "std_msgs/String", {"data": "idle"})
        await until_async(lambda: foreign(station), "the node is heard")
        server.freeze(PING_EVERY + SILENCE + 2)
        await until_async(lambda: not foreign(station), "the silence is noticed")

    play(server.url, scenario)


def test_a_server_that_never_answers_holds_nothing_up() -> None:
    async def scenario(network: Network) -> None:
        station = network.join()
        station.advertise("/tool/command", TEXT, RELIABLE)
        began = time.monotonic()
        for _ in range(1000):
            say(station, "/tool/command", "go")
        await asyncio.sleep(0.5)
        assert time.monotonic() - began < patience(2.0)

    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        port = silent.getsockname()[1]
        play(f"ws://127.0.0.1:{port}", scenario)  # somebody who listens and never says a word
    play(f"ws://127.0.0.1:{port}", scenario)  # nobody at all


def test_misuse_is_refused_with_a_reason(server: RosbridgeServer) -> None:
    async def scenario(network: Network) -> None:
        station = network.join()
        with pytest.raises(TransportError, match="/tool/command has not been advertised"):
            say(station, "/tool/command", "go")
        station.advertise("/tool/command", TEXT, RELIABLE)
        station.advertise("/tool/command", TEXT, RELIABLE)  # harmless
        with pytest.raises(TransportError, match="already advertised as std_msgs/msg/String"):
            station.advertise("/tool/command", NUMBER, RELIABLE)
        station.subscribe("/tool/state", TEXT, RELIABLE, Listener())
        with pytest.raises(TransportError, match="already subscribed to as std_msgs/msg/String"):
            station.subscribe("/tool/state", NUMBER, RELIABLE, Listener())
        with pytest.raises(ValueError, match="is not a topic name"):
            station.advertise("tool/command", TEXT, RELIABLE)
        with pytest.raises(LookupError, match="did you mean std_msgs/msg/String"):
            station.subscribe("/tool/other", "std_msgs/msg/Strng", RELIABLE, Listener())
        with pytest.raises(ValueError, match="is not a node name"):
            network.join("my station")
        with pytest.raises(TransportError, match="call it on ROS 2"):
            await station.call("/reset", "std_srvs/srv/Trigger", b"", 1.0)
        station.close()
        station.close()
        with pytest.raises(TransportError, match="closed"):
            station.graph()

    play(server.url, scenario)


@pytest.mark.parametrize("url", ["127.0.0.1:9090", "http://127.0.0.1:9090", "ws://", "ws://127.0.0.1:port", ""])
def test_what_is_no_address_is_refused(url: str) -> None:
    async def scenario(network: Network) -> None:
        with pytest.raises(TransportError, match=r"is not the address of a rosbridge server .*ws://127.0.0.1:9090"):
            network.join()

    play(url, scenario)
