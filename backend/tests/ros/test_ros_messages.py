"""What a station relies on when it turns values into ROS 2 messages and back."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.ros.types.definitions import FieldType
from sequence_planner.ros.types.errors import (
    MalformedMessageError,
    MessageValueError,
    UnknownMessageTypeError,
)
from sequence_planner.ros.types.messages import MessageRegistry
from support.examples import examples


@cache
def standard() -> MessageRegistry:
    return MessageRegistry.from_folder(None)


# Captured from genuine ROS 2 Jazzy.
GOLDEN_BYTES: list[tuple[str, dict[str, object], str]] = [
    ("std_msgs/msg/Bool", {"data": True}, "0001000001"),
    ("std_msgs/msg/String", {"data": "hello"}, "000100000600000068656c6c6f00"),
    ("std_msgs/msg/Int32", {"data": -5}, "00010000fbffffff"),
    ("std_msgs/msg/Float64", {"data": 1.5}, "00010000000000000000f83f"),
    ("std_msgs/msg/Empty", {}, "0001000000"),
    (
        "geometry_msgs/msg/PoseStamped",
        {
            "header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "map"},
            "pose": {"position": {"x": 1.0}, "orientation": {"w": 1.0}},
        },
        "000100000100000002000000040000006d617000000000000000f03f" + "00" * 40 + "000000000000f03f",
    ),
    (
        "sensor_msgs/msg/JointState",
        {"name": ["a", "bb"], "position": [1.0, 2.0]},
        "0001000000000000000000000100000000000000020000000200000061000000030000006262000002000000000000000000f03f"
        "00000000000000400000000000000000",
    ),
]

GOLDEN_HASHES = {
    "std_msgs/msg/Bool": "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9",
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "geometry_msgs/msg/PoseStamped": "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8",
    "sensor_msgs/msg/JointState": "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e",
    "std_msgs/msg/Char": "3ad2d04dd29ba19d04b16659afa3ccaedd691914b02a64e82e252f2fa6a586a9",
}


@pytest.mark.parametrize(("type_name", "values", "expected"), GOLDEN_BYTES)
def test_bytes_are_those_of_ros2(type_name: str, values: dict[str, object], expected: str) -> None:
    assert standard().encode(type_name, values).hex() == expected


@pytest.mark.parametrize(("type_name", "digits"), GOLDEN_HASHES.items())
def test_type_hashes_are_those_of_ros2(type_name: str, digits: str) -> None:
    assert standard().type_hash(type_name) == f"RIHS01_{digits}"


def test_names_in_dds() -> None:
    assert standard().dds_name("std_msgs/msg/String") == "std_msgs::msg::dds_::String_"


def test_fields_tell_kind_shape_and_limits() -> None:
    assert standard().fields("sensor_msgs/msg/Imu")["linear_acceleration_covariance"] == FieldType(
        "float", "float64", 9
    )
    joints = standard().fields("sensor_msgs/msg/JointState")
    assert list(joints) == ["header", "name", "position", "velocity", "effort"]
    assert joints["header"] == FieldType("message", "std_msgs/msg/Header")
    assert joints["name"] == FieldType("string", "string", "sequence")
    assert standard().fields("std_msgs/msg/Int8")["data"] == FieldType("int", "int8", range=(-128, 127))
    assert standard().fields("std_msgs/msg/Char")["data"].range == (0, 255)
    assert standard().fields("std_msgs/msg/Empty") == {}


@pytest.mark.parametrize("name", ["std_msg/msg/String", "std_msgs/String", "String", "std_msgs/msg/Strin"])
def test_an_unknown_type_suggests_the_nearest(name: str) -> None:
    with pytest.raises(UnknownMessageTypeError, match="did you mean std_msgs/msg/String") as caught:
        standard().fields(name)
    assert caught.value.suggestion == "std_msgs/msg/String"


def test_fields_left_out_have_ros_defaults() -> None:
    pose = standard().decode("geometry_msgs/msg/Pose", standard().encode("geometry_msgs/msg/Pose", {}))
    assert pose["orientation"] == {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    # A default of a nested message holds wherever that message is used, also in messages of a list.
    array = standard().encode("geometry_msgs/msg/PoseArray", {"poses": [{"position": {"z": 2}}]})
    [nested] = _list(standard().decode("geometry_msgs/msg/PoseArray", array)["poses"])
    assert nested == {"position": {"x": 0.0, "y": 0.0, "z": 2.0}, "orientation": pose["orientation"]}


BAD_VALUES: list[tuple[str, dict[str, object], str, str]] = [
    ("std_msgs/msg/Bool", {"data": 1}, "data", "expected bool, found 1 (int)"),
    ("std_msgs/msg/Int8", {"data": 128}, "data", "expected int8 (-128 to 127), found 128"),
    ("std_msgs/msg/UInt64", {"data": -1}, "data", "expected uint64 (0 to 18446744073709551615)"),
    ("std_msgs/msg/Int32", {"data": True}, "data", "expected int32"),
    ("std_msgs/msg/Int32", {"data": 1.0}, "data", "expected int32"),
    ("std_msgs/msg/Float64", {"data": "1.0"}, "data", "expected float64, found '1.0' (str)"),
    ("std_msgs/msg/Float64", {"data": False}, "data", "expected float64"),
    ("std_msgs/msg/Float64", {"data": 10**400}, "data", "expected float64"),
    ("std_msgs/msg/Float32", {"data": 1e39}, "data", "expected float32 (at most 3.402823e+38 in size)"),
    ("std_msgs/msg/String", {"data": None}, "data", "expected string, found None"),
    ("std_msgs/msg/String", {"data": "a\0b"}, "data", "without a NUL"),
    ("std_msgs/msg/String", {"data": "\ud800"}, "data", "UTF-8"),
    ("sensor_msgs/msg/JointState", {"position": 1.0}, "position", "expected a list for float64[]"),
    ("sensor_msgs/msg/JointState", {"name": "arm"}, "name", "expected a list"),
    ("sensor_msgs/msg/JointState", {"position": [1.0, "x"]}, "position[1]", "expected float64"),
    ("sensor_msgs/msg/Imu", {"orientation_covariance": [0.0] * 8}, "orientation_covariance", "exactly 9 items"),
    ("geometry_msgs/msg/Pose", {"position": [0, 0, 0]}, "position", "the fields of a geometry_msgs/msg/Point"),
    ("geometry_msgs/msg/Pose", {"position": {"x": "1"}}, "position.x", "expected float64"),
    ("geometry_msgs/msg/Pose", {"positon": {}}, "", "did you mean position?"),
    ("geometry_msgs/msg/PoseArray", {"poses": [{}, {"position": {"q": 1}}]}, "poses[1].position", "a field of"),
    ("std_msgs/msg/Empty", {"structure_needs_at_least_one_member": 1}, "", "a field of std_msgs/msg/Empty"),
]


@pytest.mark.parametrize(("type_name", "values", "path", "text"), BAD_VALUES)
def test_a_value_that_does_not_fit_is_refused_by_path(
    type_name: str, values: dict[str, object], path: str, text: str
) -> None:
    with pytest.raises(MessageValueError) as caught:
        standard().encode(type_name, values)
    assert caught.value.path == path
    assert text in str(caught.value)
    assert str(caught.value).startswith(type_name)


@pytest.mark.parametrize("type_name", ["std_msgs/msg/Float32", "std_msgs/msg/Float64"])
@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
def test_floats_need_not_be_finite(type_name: str, number: float) -> None:
    data = standard().decode(type_name, standard().encode(type_name, {"data": number}))["data"]
    assert repr(data) == repr(number)


def test_bytes_serve_as_a_list_of_octets() -> None:
    image = standard().encode("sensor_msgs/msg/Image", {"data": b"\x01\xff"})
    assert standard().decode("sensor_msgs/msg/Image", image)["data"] == [1, 255]


@st.composite
def messages(draw: st.DrawFn) -> tuple[str, dict[str, object]]:
    """Any message of any standard type, with every field given."""
    type_name = draw(st.sampled_from(standard().type_names()))
    return type_name, draw(values_of(type_name))


def values_of(type_name: str) -> st.SearchStrategy[dict[str, object]]:
    return st.fixed_dictionaries({name: field_values(field) for name, field in standard().fields(type_name).items()})


def field_values(field: FieldType) -> st.SearchStrategy[object]:
    single: st.SearchStrategy[object]
    if field.kind == "message":
        single = values_of(field.type_name)
    elif field.kind == "string":
        single = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=4)
    elif field.kind == "bool":
        single = st.booleans()
    elif field.range is not None:
        single = st.integers(*field.range)
    else:
        single = st.floats(width=32 if field.type_name == "float32" else 64, allow_nan=False)
    if field.array is None:
        return single
    if field.array == "sequence":
        return st.lists(single, max_size=min(3, field.max_items or 3))
    return st.lists(single, min_size=field.array, max_size=field.array)


@examples(100)
@given(messages())
def test_what_is_encoded_is_decoded(message: tuple[str, dict[str, object]]) -> None:
    type_name, values = message
    assert standard().decode(type_name, standard().encode(type_name, values)) == values


@examples(100)
@given(messages(), st.binary(max_size=3))
def test_padding_of_up_to_three_bytes_is_ignored(message: tuple[str, dict[str, object]], padding: bytes) -> None:
    type_name, values = message
    assert standard().decode(type_name, standard().encode(type_name, values) + padding) == values


@examples(100)
@given(st.sampled_from(standard().type_names()), st.binary(max_size=64))
def test_any_bytes_are_a_message_or_malformed(type_name: str, garbage: bytes) -> None:
    for data in (garbage, b"\0\1\0\0" + garbage, b"\0\0\0\0" + garbage):
        try:
            assert isinstance(standard().decode(type_name, data), dict)
        except MalformedMessageError as error:
            assert error.type_name == type_name


@pytest.mark.parametrize(
    "data",
    [b"", b"\0\1", bytes.fromhex("000100000600000068656c"), bytes.fromhex("00010000ffffffff6100"), b"\0\7\0\0\0"],
)
def test_malformed_bytes_name_the_type(data: bytes) -> None:
    with pytest.raises(MalformedMessageError, match="not a std_msgs/msg/String"):
        standard().decode("std_msgs/msg/String", data)


def test_big_endian_peers_are_understood() -> None:
    assert standard().decode("std_msgs/msg/Int32", bytes.fromhex("00000000fffffffb")) == {"data": -5}


def test_a_station_adds_its_own_types(tmp_path: Path) -> None:
    folder = tmp_path / "cell_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Tool.msg").write_text(
        "# what the tool does\nuint8 IDLE=0\nstring<=8 name 'nut'  # quoted\nfloat32[2] limits [0.5, 2]\nbool ready 1\n"
        "int16[<=2] from\nchar letter\n"
    )
    (folder / "Cell.msg").write_text("Tool tool\nTool[] spare\ngeometry_msgs/Quaternion aim\nstd_msgs/Header header\n")
    (folder / "Ping.msg").write_text("")
    registry = MessageRegistry.from_folder(tmp_path)
    cell = registry.decode("cell_msgs/msg/Cell", registry.encode("cell_msgs/msg/Cell", {"spare": [{"from": [1, 2]}]}))
    tool = {"name": "nut", "limits": [0.5, 2.0], "ready": True, "from": [], "letter": 0}
    assert cell["tool"] == tool
    assert cell["spare"] == [tool | {"from": [1, 2]}]
    assert cell["aim"] == {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    assert registry.encode("cell_msgs/msg/Ping", {}).hex() == "0001000000"
    assert registry.fields("cell_msgs/msg/Tool")["name"].max_length == 8
    for values, text in (
        ({"name": "åäöåä"}, "at most 8 bytes of UTF-8"),
        ({"from": [1, 2, 3]}, "at most 2 items"),
        ({"letter": 256}, "0 to 255"),
    ):
        with pytest.raises(MessageValueError, match=text):
            registry.encode("cell_msgs/msg/Tool", values)


def test_the_hash_tells_definitions_apart_and_ignores_comments(tmp_path: Path) -> None:
    def hash_of(definition: str) -> str:
        path = tmp_path / "cell_msgs" / "msg" / "State.msg"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(definition)
        return MessageRegistry.from_folder(tmp_path).type_hash("cell_msgs/msg/State")

    assert hash_of("bool idle\n") == hash_of("# a comment\nuint8 MODE=1\n\nbool idle  # and one here\n")
    assert len({hash_of("bool idle"), hash_of("bool ready"), hash_of("uint8 idle"), hash_of("bool[] idle")}) == 4
    assert hash_of("char idle") == hash_of("uint8 idle")


def _list(value: object) -> list[object]:
    assert isinstance(value, list)
    return value
