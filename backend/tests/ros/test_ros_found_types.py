"""Types that no file of the station defines, described by those who publish them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from ros_networks import Network, play, standard
from ros_processes import peer

from core.choices import Choices, made_by
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NetworkEndpoint, Sample, Transport
from sequence_planner.ros.types.errors import UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.type_description import (
    BadDescriptionError,
    FoundType,
    TypeDescription,
    check_hash,
    describe,
    read_description,
)
from sequence_planner.ros.types.type_discovery import TypeNotFoundError, find_type, serve_types
from support.examples import examples
from support.waiting import until_async

KINDS = ["memory", "cyclonedds"]
CELL = "cell_msgs/msg/Cell"


def registry(folder: Path, definitions: dict[str, str]) -> MessageRegistry:
    for name, text in definitions.items():
        path = folder / "cell_msgs" / "msg" / f"{name}.msg"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return MessageRegistry.from_folder(folder)


CELL_FILES = {
    "Part": "string<=6 name\nbyte[] code\nfloat32[3] size\nchar letter\n",
    "Cell": "Part[<=2] parts\nPart[1] spare\nbool from\nstd_msgs/Header header\nstring<=3[<=2] l\nNothing nothing\n",
    "Nothing": "",
}


async def seen(transport: Transport, topic: str) -> NetworkEndpoint:
    """Wait for the publisher of a topic, with its node."""

    def publishers() -> list[NetworkEndpoint]:
        return [e for e in transport.graph() if e.topic == topic and e.direction == "publisher" and e.node]

    await until_async(publishers, f"the publisher of {topic} is seen")
    return publishers()[0]


@pytest.mark.parametrize("kind", KINDS)
def test_a_type_found_on_the_network_can_be_used(kind: str, tmp_path: Path) -> None:
    async def scenario(network: Network) -> None:
        theirs, ours = registry(tmp_path, CELL_FILES), MessageRegistry.from_folder(None)
        device, station = network.join("device", theirs), network.join("station", ours)
        serve_types(device, theirs, "device")
        device.advertise("/cell", CELL, QualityOfService.LATCHED)
        device.publish("/cell", CELL, theirs.encode(CELL, {"from": True, "parts": [{"name": "nut", "code": [1, 200]}]}))
        with pytest.raises(UnknownMessageTypeError):
            ours.type_hash(CELL)
        endpoint = await seen(station, "/cell")
        found = await find_type(station, ours, endpoint, 10.0)
        assert found == FoundType(CELL, theirs.type_hash(CELL), "/device") == ours.found()[CELL]
        assert set(ours.found()) == {f"cell_msgs/msg/{name}" for name in CELL_FILES}
        assert ours.fields(CELL) == theirs.fields(CELL)
        heard: list[Sample] = []
        station.subscribe("/cell", CELL, QualityOfService.LATCHED, heard.extend)
        await until_async(lambda: heard, "the cell is heard")
        assert ours.decode(CELL, heard[0].data) == theirs.decode(CELL, heard[0].data)
        device.close()
        assert await find_type(station, ours, endpoint, 0.1) == found  # nobody has to be asked again

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_type_that_cannot_be_found_enters_nothing(kind: str, tmp_path: Path) -> None:
    async def scenario(network: Network) -> None:
        theirs = registry(tmp_path / "theirs", CELL_FILES)
        ours = registry(tmp_path / "ours", {"Part": "bool other\n"})
        device, station = network.join("device", theirs), network.join("station", ours)
        device.advertise("/cell", CELL, QualityOfService.LATCHED)
        endpoint = await seen(station, "/cell")
        with pytest.raises(TypeNotFoundError, match="nobody serves /device/get_type_description"):
            await find_type(station, ours, endpoint, 0.2)
        serve_types(device, theirs, "device")
        with pytest.raises(TypeNotFoundError, match="/device uses another definition of cell_msgs/msg/Part"):
            await find_type(station, ours, endpoint, 10.0)
        assert ours.found() == {}
        with pytest.raises(UnknownMessageTypeError):
            ours.type_hash(CELL)

    play(kind, scenario)


def test_a_type_of_a_program_that_knows_nothing_of_ros_is_found() -> None:
    async def scenario(network: Network) -> None:
        ours, route = MessageRegistry.from_folder(None), "plant_msgs/msg/Route"
        station = network.join("station", ours)
        async with peer("route"):
            await until_async(station.graph, "the publisher is seen")
            [endpoint] = station.graph()
            found = await find_type(station, ours, endpoint, 10.0)
            assert found == FoundType(route, ours.type_hash(route), "a program that does not tell its node")
            assert {name: str(field) for name, field in ours.fields(route).items()} == {
                "name": "string<=8",
                "points": "plant_msgs/msg/Point[]",
                "codes": "uint16[2]",
                "labels": "string[<=3]",
                "closed": "bool",
            }
            heard: list[Sample] = []
            station.subscribe("/route", route, QualityOfService.LATCHED, heard.extend)
            await until_async(lambda: heard, "the route is heard")
            points = [{"x": 1.5, "level": 200}]
            said = {"name": "nuts", "points": points, "codes": [1, 65535], "labels": ["a", "b"], "closed": True}
            assert ours.decode(route, heard[0].data) == said

    play("cyclonedds", scenario)


def test_a_description_is_believed_only_with_its_hash() -> None:
    pose = "geometry_msgs/msg/PoseStamped"
    described = describe(standard().declared(), pose)
    truth = standard().type_hash(pose)
    fields = read_description(described, pose)
    check_hash(fields, pose, truth)
    assert set(fields) == {
        pose,
        *(f"geometry_msgs/msg/{name}" for name in ("Pose", "Point", "Quaternion")),
        "std_msgs/msg/Header",
        "builtin_interfaces/msg/Time",
    }
    with pytest.raises(BadDescriptionError, match="and the publisher tells RIHS01_0"):
        check_hash(fields, pose, "RIHS01_" + "0" * 64)
    with pytest.raises(BadDescriptionError, match=f"it describes {pose}"):
        read_description(described, "geometry_msgs/msg/Pose")


@pytest.mark.parametrize("type_name", standard().type_names())
def test_what_is_described_is_read_back(type_name: str) -> None:
    described = describe(standard().declared(), type_name)
    fields = read_description(described, type_name)
    check_hash(fields, type_name, standard().type_hash(type_name))
    assert fields[type_name] == standard().declared()[type_name]


def a(name: str, *fields: tuple[str, int, int, str]) -> dict[str, object]:
    return {
        "type_name": name,
        "fields": [
            {
                "name": field,
                "type": {"type_id": number, "capacity": count, "string_capacity": 0, "nested_type_name": within},
            }
            for field, number, count, within in fields
        ],
    }


BOOLEAN = a("p/msg/A60", ("b", 15, 0, ""))


@pytest.mark.parametrize(
    ("types", "text"),
    [
        ([a("p/msg/A", ("a", 1, 0, "p/msg/A"))], "stands within itself"),
        ([a("p/msg/A", ("a", 1, 0, "p/msg/B")), a("p/msg/B", ("a", 145, 0, "p/msg/A"))], "stands within itself"),
        ([a("p/msg/A", ("a", 1, 0, "p/msg/B"))], "p/msg/B is used and not described"),
        ([a("p/msg/A", ("a", 49, 2**40, "p/msg/B")), a("p/msg/B", ("b", 2, 0, ""))], "more than 10000 values"),
        (
            [*(a(f"p/msg/A{n}", ("a", 49, 2, f"p/msg/A{n + 1}")) for n in range(60)), BOOLEAN],
            "more than 10000",
        ),
        ([a(f"p/msg/A{n}", ("a", 1, 0, f"p/msg/A{n + 1}")) for n in range(999)], "within more than 64 others"),
        ([a("p/msg/A", ("a b", 2, 0, ""))], "'a b' is no name of a field"),
        ([a("p/msg/A\nimport os", ("a", 2, 0, ""))], "is no name of a type"),
        ([a("p/msg/A", ("a", 2, 0, ""), ("a", 2, 0, ""))], "one of them twice"),
        ([a("p/msg/A")], "has no fields"),
        ([a("p/msg/A", ("a", 18, 0, ""))], "the type 18, which is not supported"),
        ([a("p/msg/A", ("a", 50, 0, ""))], "the type 50, which is not supported"),
        ([a("p/msg/A", ("a", -5, 0, ""))], "which is not supported"),
    ],
)
def test_a_hostile_description_is_refused(types: list[dict[str, object]], text: str) -> None:
    description = TypeDescription.model_validate(
        {"type_description": types[0], "referenced_type_descriptions": types[1:]}
    )
    with pytest.raises(BadDescriptionError, match=text):
        read_description(description, str(types[0]["type_name"]))


def mutated(choices: Choices) -> TypeDescription:
    """A description in which one thing is otherwise."""
    described = describe(standard().declared(), "geometry_msgs/msg/PoseStamped").model_dump()
    types = [described["type_description"], *described["referenced_type_descriptions"]]
    field = choices.pick([field for each in types for field in each["fields"]])
    change: Callable[[], None] = choices.pick(
        [
            lambda: field.update(name=choices.pick(["", "x", "from", "A", "__class__"])),
            lambda: field["type"].update(type_id=choices.number(0, 255)),
            lambda: field["type"].update(nested_type_name=choices.pick(["", "a/msg/B", types[0]["type_name"]])),
            lambda: field["type"].update(capacity=choices.pick([1, 2**63])),
        ]
    )
    change()
    return TypeDescription.model_validate(described)


@given(made_by(mutated))
@examples(200)
def test_no_other_description_passes_for_the_true_one(description: TypeDescription) -> None:
    pose = "geometry_msgs/msg/PoseStamped"
    try:
        fields = read_description(description, pose)
        check_hash(fields, pose, standard().type_hash(pose))
    except BadDescriptionError:
        return
    assert {name: standard().declared()[name] for name in fields} == fields
