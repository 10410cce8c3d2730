"""The transport over cyclonedds: other processes, other codecs, and networks that are not there."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication, BuiltinTopicDcpsSubscription
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import make_idl_struct, types
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic
from hypothesis import given
from hypothesis import strategies as st
from ros_networks import Network, play, settle, standard
from ros_processes import peer

from sequence_planner.ros import names
from sequence_planner.ros.qos import Direction, QualityOfService
from sequence_planner.ros.transport import Sample, Transport, TransportError
from sequence_planner.ros.transports import cyclonedds, cyclonedds_network
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.transports.cyclonedds_discovery import Discovery, user_data
from sequence_planner.ros.transports.cyclonedds_network import MOST_IN_PROCESS, loopback_configuration
from sequence_planner.ros.types.errors import MalformedMessageError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.simulation.faults import garbage
from support.examples import examples
from support.network import DOMAIN, free_domain
from support.waiting import until_async

TEXT = "std_msgs/msg/String"
RELIABLE = QualityOfService.RELIABLE


class Expected(NamedTuple):
    """What a station sees of a peer."""

    node: str | None
    has_hash: bool


@pytest.mark.parametrize(
    ("kind", "expected"), [("ours", Expected("/peer", True)), ("plain", Expected(None, False))], ids=["ours", "plain"]
)
def test_another_process_answers_and_is_seen_to_leave(kind: str, expected: Expected) -> None:
    async def scenario(network: Network) -> None:
        station = network.join("station")
        heard: list[object] = []

        def listen(batch: Sequence[Sample]) -> None:
            heard.extend(standard().decode(TEXT, sample.data)["data"] for sample in batch)

        def say(text: str) -> None:
            station.publish("/ping", TEXT, standard().encode(TEXT, {"data": text}))

        def greeted() -> bool:
            say("hello")  # The peer may have seen the ping before it knows who listens to its pong.
            return bool(heard)

        def foreign() -> dict[str, Expected]:
            return {
                f"{endpoint.direction} {endpoint.topic} {endpoint.type_name}": Expected(
                    endpoint.node, endpoint.type_hash == standard().type_hash(TEXT)
                )
                for endpoint in station.graph()
                if not endpoint.own
            }

        station.advertise("/ping", TEXT, RELIABLE)
        station.subscribe("/pong", TEXT, RELIABLE, listen)
        both = {f"publisher /pong {TEXT}": expected, f"subscriber /ping {TEXT}": expected}
        async with peer(kind):
            await until_async(lambda: foreign() == both, f"the {kind} peer is seen")
            await until_async(greeted, "the peer answers")
            for text in ("a", "ab", "abc", "abcd", "åäö"):
                say(text)
            await until_async(lambda: heard[-1] == "ÅÄÖ", "the last answer comes")
            assert [text for text in heard if text != "HELLO"] == ["A", "AB", "ABC", "ABCD", "ÅÄÖ"]
        await until_async(lambda: not foreign(), "the peer is gone")

    play("cyclonedds", scenario)


def test_a_peer_that_comes_during_a_look_at_the_network_has_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """A participant says once which nodes it has; whoever looked at that moment saw one without a name for ever."""
    take = Discovery._refresh
    came: list[Transport] = []

    async def scenario(network: Network) -> None:
        station = network.join("station")

        def take_while_somebody_comes(discovery: Discovery, direction: Direction) -> None:
            take(discovery, direction)
            if direction == "subscriber" and not came:
                came.append(network.join("device"))
                came[0].advertise("/pong", TEXT, RELIABLE)
                time.sleep(1.0)  # seconds, in which it is discovered

        monkeypatch.setattr(Discovery, "_refresh", take_while_somebody_comes)
        station.graph()
        [device] = [endpoint for endpoint in station.graph() if endpoint.topic == "/pong"]
        assert device.node == "/device"

    play("cyclonedds", scenario)


def test_peers_are_told_of_every_endpoint_more_than_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Who joins in the moment in which one is made may never hear of it. Where that was the one that tells nodes, a
    station saw emulated devices without a name for ever.
    """
    monkeypatch.setattr(cyclonedds, "TOLD_AGAIN", (0.2,))

    async def answer(request: bytes) -> bytes:
        return request

    async def scenario(network: Network) -> None:
        station = network.join("station")
        onlooker = DomainParticipant(DOMAIN)
        readers = [
            BuiltinDataReader(onlooker, kind) for kind in (BuiltinTopicDcpsPublication, BuiltinTopicDcpsSubscription)
        ]
        told: dict[tuple[str, int], bytes] = {}

        def look() -> set[tuple[str, int]]:
            for number, reader in enumerate(readers):
                told.update({(each.topic_name, number): user_data(each.qos) for each in reader.take(100)})
            return {endpoint for endpoint, data in told.items() if b"told=2;" in data}

        station.advertise("/ping", TEXT, RELIABLE)
        station.subscribe("/pong", TEXT, RELIABLE, lambda batch: None)
        station.serve("/ask", "std_srvs/srv/Trigger", answer)
        request, reply = names.dds_service("/ask")
        publisher, subscriber = 0, 1
        every = {("ros_discovery_info", publisher), ("ros_discovery_info", subscriber)}
        every |= {("rt/ping", publisher), ("rt/pong", subscriber), (reply, publisher), (request, subscriber)}
        await until_async(lambda: look() == every, "all of them are told of again")
        hashed = [names.type_hash_of(told[endpoint]) for endpoint in every]
        assert None not in hashed, "what was told before is told still"
        assert names.server_of(told[reply, publisher]) == names.server_of(told[request, subscriber]) is not None

    play("cyclonedds", scenario)


def test_a_publisher_that_is_not_of_ros_is_shown_as_it_is() -> None:
    async def scenario(network: Network) -> None:
        station = network.join("station")
        struct = make_idl_struct("Raw", "plant.Raw", {"value": types.int32})
        participant = DomainParticipant(DOMAIN)
        writers = [
            DataWriter(participant, Topic(participant, name, struct)) for name in ("rt/tool/state", "tool/state")
        ]
        await until_async(station.graph, "the publisher is seen")
        await settle()
        [endpoint] = station.graph()
        assert (endpoint.topic, endpoint.type_name) == ("/tool/state", "plant::Raw")
        assert (endpoint.own, endpoint.type_hash, endpoint.node) == (False, None, None)
        del writers

    play("cyclonedds", scenario)


def test_a_peer_with_a_stale_definition_delivers_nothing(tmp_path: Path) -> None:
    """Cyclone compares the definitions, so what would be garbled is not delivered."""

    def registry(folder: str, definition: str) -> MessageRegistry:
        path = tmp_path / folder / "cell_msgs" / "msg" / "State.msg"
        path.parent.mkdir(parents=True)
        path.write_text(definition)
        return MessageRegistry.from_folder(tmp_path / folder)

    async def scenario(network: Network) -> None:
        old, new = registry("old", "int32 pose\n"), registry("new", "float32 pose\n")
        device, station = network.join("device", old), network.join("station", new)
        heard: list[Sample] = []
        station.subscribe("/robot/state", "cell_msgs/msg/State", RELIABLE, heard.extend)
        device.advertise("/robot/state", "cell_msgs/msg/State", RELIABLE)
        await until_async(lambda: len(station.graph()) == len(device.graph()) == 2, "both see each other")
        device.publish("/robot/state", "cell_msgs/msg/State", old.encode("cell_msgs/msg/State", {"pose": 1}))
        await settle()
        assert heard == []

    play("cyclonedds", scenario)


@pytest.mark.parametrize(
    ("type_name", "values"), [(TEXT, {"data": "hello"}), ("std_msgs/msg/Bool", {}), ("geometry_msgs/msg/Pose", {})]
)
def test_garbage_of_an_emulated_device_arrives_and_is_no_message(type_name: str, values: dict[str, object]) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        heard: list[Sample] = []
        station.subscribe("/robot/state", type_name, RELIABLE, heard.extend)
        device.advertise("/robot/state", type_name, RELIABLE)
        await until_async(lambda: len(station.graph()) == len(device.graph()) == 2, "both see each other")
        device.publish("/robot/state", type_name, garbage(standard().encode(type_name, values)))
        await until_async(lambda: heard, "it arrives")
        with pytest.raises(MalformedMessageError):
            standard().decode(type_name, heard[0].data)

    play("cyclonedds", scenario)


def test_messages_of_every_shape_pass(tmp_path: Path) -> None:
    folder = tmp_path / "cell_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Part.msg").write_text("string<=6 name\nbyte[] code\nfloat32[3] size\n")
    (folder / "Cell.msg").write_text("Part[<=2] parts\nPart[1] spare\nbool from\ngeometry_msgs/Pose pose\nstring[] l\n")
    (folder / "Ping.msg").write_text("# nothing\n")
    registry = MessageRegistry.from_folder(tmp_path)
    part: dict[str, object] = {"name": "nut", "code": [1, 200], "size": [1.0, 2.0, 0.5]}
    pose: dict[str, object] = {
        "position": {"x": 1.0, "y": 2.0, "z": 3.0},
        "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
    }
    cell: dict[str, object] = {"parts": [part], "spare": [part], "from": True, "pose": pose, "l": ["", "b"]}

    async def scenario(network: Network) -> None:
        device, station = network.join("device", registry), network.join("station", registry)
        heard: list[Sample] = []
        kinds: list[tuple[str, dict[str, object]]] = [("Cell", cell), ("Ping", {})]
        for name, _ in kinds:
            station.subscribe(f"/{name}", f"cell_msgs/msg/{name}", RELIABLE, heard.extend)
            device.advertise(f"/{name}", f"cell_msgs/msg/{name}", RELIABLE)
        await until_async(lambda: len(station.graph()) == len(device.graph()) == 4, "both see each other")
        for name, values in kinds:
            device.publish(f"/{name}", f"cell_msgs/msg/{name}", registry.encode(f"cell_msgs/msg/{name}", values))
        await until_async(lambda: len(heard) == 2, "both arrive")
        decoded = {sample.topic: registry.decode(f"cell_msgs/msg/{sample.topic[1:]}", sample.data) for sample in heard}
        assert decoded == {"/Cell": cell, "/Ping": {}}

    play("cyclonedds", scenario)


# Written out with cyclonedds' IDL types: a second codec, by other people.
POINT = make_idl_struct("Point", "geometry_msgs.msg.dds_.Point_", dict.fromkeys("xyz", types.float64))
PATH = make_idl_struct(
    "Path",
    "cell_msgs.msg.dds_.Path_",
    {
        "closed": bool,
        "name": str,
        "points": types.sequence[POINT],
        "codes": types.sequence[types.uint16],
        "labels": types.sequence[str],
        "size": types.array[types.float32, 3],
        "count": types.int64,
        "level": types.int8,
    },
)
PATH_MSG = (
    "bool closed\nstring name\ngeometry_msgs/Point[] points\nuint16[] codes\nstring[] labels\nfloat32[3] size\n"
    "int64 count\nint8 level\n"
)

TEXTS = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=5)
FLOATS = st.floats(allow_nan=False)


@pytest.fixture(scope="module")
def path_registry(tmp_path_factory: pytest.TempPathFactory) -> MessageRegistry:
    folder = tmp_path_factory.mktemp("messages")
    (folder / "cell_msgs" / "msg").mkdir(parents=True)
    (folder / "cell_msgs" / "msg" / "Path.msg").write_text(PATH_MSG)
    return MessageRegistry.from_folder(folder)


PATHS = st.fixed_dictionaries(
    {
        "closed": st.booleans(),
        "name": TEXTS,
        "points": st.lists(st.fixed_dictionaries(dict.fromkeys("xyz", FLOATS)), max_size=3),
        "codes": st.lists(st.integers(0, 2**16 - 1), max_size=3),
        "labels": st.lists(TEXTS, max_size=3),
        "size": st.lists(st.floats(width=32, allow_nan=False), min_size=3, max_size=3),
        "count": st.integers(-(2**63), 2**63 - 1),
        "level": st.integers(-128, 127),
    }
)


@examples(100)
@given(PATHS)
def test_the_bytes_are_those_of_cyclonedds_own_codec(path_registry: MessageRegistry, values: dict[str, Any]) -> None:
    points = [POINT(**point) for point in values["points"]]
    theirs = PATH(**(values | {"points": points})).serialize(use_version_2=False)
    assert path_registry.encode("cell_msgs/msg/Path", values) == theirs


def test_a_computer_without_the_interface_is_told_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    interface = loopback_configuration().replace('name="lo"', 'name="none0"')
    domain = 200  # Never joined, so nobody can be met there.

    async def scenario() -> None:
        loop = asyncio.get_running_loop()
        with (
            monkeypatch.context() as patch,
            pytest.raises(TransportError, match="Check that a loopback interface is up"),
        ):
            patch.setattr(cyclonedds_network, "loopback_configuration", lambda: interface)
            open_transport("cyclonedds", standard(), "station", loop, domain)
        # Once there is one, the same process can join.
        open_transport("cyclonedds", standard(), "station", loop, DOMAIN).close()

    asyncio.run(scenario())


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("ROS_SECURITY_ENABLE", "true", "use ROS 2 with rclpy"),
        ("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF", "use LOCALHOST"),
        ("ROS_AUTOMATIC_DISCOVERY_RANGE", "everywhere", "give one of LOCALHOST, SUBNET"),
        ("ROS_DOMAIN_ID", "300", "give a number from 0 to 232"),
        ("ROS_DOMAIN_ID", "one", "'one'"),
        ("SEQUENCE_PLANNER_INTERFACE", "none0", r"this computer has .*lo.*: give one of these"),
        ("SEQUENCE_PLANNER_INTERFACE", "lo", "set the range to SUBNET"),
    ],
)
def test_an_environment_that_cannot_be_honoured_is_refused(
    monkeypatch: pytest.MonkeyPatch, name: str, value: str, text: str
) -> None:
    async def scenario() -> None:
        monkeypatch.setenv(name, value)
        with pytest.raises(TransportError, match=text):
            open_transport("cyclonedds", standard(), "station", asyncio.get_running_loop())

    asyncio.run(scenario())


def test_the_domain_is_that_of_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    async def scenario(network: Network) -> None:
        device = network.join("device")
        device.advertise("/tool/state", TEXT, RELIABLE)
        monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
        loop = asyncio.get_running_loop()
        here = open_transport("cyclonedds", standard(), "station", loop)
        elsewhere = open_transport("cyclonedds", standard(), "station", loop, free_domain())
        try:
            await until_async(here.graph, "the device is seen")
            assert elsewhere.graph() == []
        finally:
            here.close()
            elsewhere.close()

    play("cyclonedds", scenario)


def test_a_process_is_not_on_the_network_more_often_than_cyclonedds_can_bear() -> None:
    """In one more it would never end making a topic, and take all memory of the machine."""

    async def scenario(network: Network) -> None:
        joined = [network.join(f"device_{number}") for number in range(MOST_IN_PROCESS)]
        with pytest.raises(TransportError, match="emulate the devices of some resources in another one"):
            network.join("one_more")
        joined.pop().close()
        network.join("in_its_place").advertise("/here", TEXT, RELIABLE)

    play("cyclonedds", scenario)
