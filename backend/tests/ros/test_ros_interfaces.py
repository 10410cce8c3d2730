"""Services and actions: what their files define, what ROS 2 derives from them, and their hashes."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest
from ros_networks import standard

from sequence_planner.ros.types.errors import MessageDefinitionError, UnknownMessageTypeError
from sequence_planner.ros.types.interfaces import write_ament_package
from sequence_planner.ros.types.messages import MessageRegistry

# From the code that rosidl generated in ROS 2 Jazzy.
GOLDEN_HASHES = {
    "example_interfaces/srv/AddTwoInts": "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
    "type_description_interfaces/srv/GetTypeDescription": (
        "69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5"
    ),
    "action_msgs/srv/CancelGoal": "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a",
    "example_interfaces/action/Fibonacci_SendGoal": "d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557",
    "example_interfaces/action/Fibonacci_GetResult": "1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57",
}
GOLDEN_ACTION_HASHES = {
    "": "baff49454958880a41293c548de416870fbb9d8abb27c8003260c721f713a24e",
    "_Goal": "0da682feccd6e1cae6098d44da66a43174e1feafbe6f7b096422f75838cfb6b7",
    "_Result": "c9021b4e49202b00549de48feaedb1317f356e5902b733a966404b4c5f5286a9",
    "_Feedback": "5bec308d18bf221fa9b075aca9f2d9b8787fed79a0ea3e4b64ca2577d1d68261",
    "_SendGoal": "f20274642c68c8129a7cfd872cba5837339bfab9f00d9a9d5ddb96d0925dafa7",
    "_SendGoal_Request": "94f8edd47fcf07c89ad88b5217480b3f083a4edd46104e0bb3e90452e52fc213",
    "_SendGoal_Response": "310f0e7813434b816c037b4d67eb4e1aebf7bc9c0cca4bb2f74df93740f37085",
    "_SendGoal_Event": "67592a488e251f3798c4e68aef22126ff2ded44e7d3321a2e2921ff0441641ec",
    "_GetResult": "2873aeee2f19018ab084c7cd5625912fa3eb0d92a85ba2646757819d4e774888",
    "_GetResult_Request": "81f86d0b1a604de4d03901f8737713400e602fada94dda846da661a188c54761",
    "_GetResult_Response": "1eb3e935f928ad7d4405aff7e8dc09d407d6d36256a6e8e2ba39906fe02ab793",
    "_GetResult_Event": "49b50014673ebdde84b33fb49fe686b06e44dd8715a0db6650d0902c4ef3fc05",
    "_FeedbackMessage": "04a77bbfd082fb70b61325db4d33ed3962be850af4a43897567388754343c865",
}


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(("type_name", "digits"), GOLDEN_HASHES.items())
def test_hashes_of_standard_services_are_those_of_ros2(type_name: str, digits: str) -> None:
    assert standard().type_hash(type_name) == f"RIHS01_{digits}"


def test_hashes_of_a_stations_action_are_those_of_ros2(tmp_path: Path) -> None:
    text = "int32 order\n---\nint32[] sequence\n---\nint32[] partial_sequence\n"
    write(tmp_path, "myroboticarm_msgs/action/Fibonacci.action", text)
    registry = MessageRegistry.from_folder(tmp_path)
    hashes = {part: registry.type_hash(f"myroboticarm_msgs/action/Fibonacci{part}") for part in GOLDEN_ACTION_HASHES}
    assert hashes == {part: f"RIHS01_{digits}" for part, digits in GOLDEN_ACTION_HASHES.items()}


def test_a_stations_services_and_actions_carry_values(tmp_path: Path) -> None:
    write(tmp_path, "cell_msgs/msg/Part.msg", "uint8 NUT=1\nstring LABEL='x'\nuint8 kind\n")
    write(
        tmp_path,
        "cell_msgs/srv/Find.srv",
        "int8 FAST=-1\nPart part\nstring<=8 where 'bin'\n---\ngeometry_msgs/Pose[] at\n",
    )
    write(tmp_path, "cell_msgs/action/Pick.action", "Part part\n---\n---\nfloat32 done\n")
    registry = MessageRegistry.from_folder(tmp_path)
    find, pick = registry.service("cell_msgs/srv/Find"), registry.action("cell_msgs/action/Pick")
    assert registry.decode(find.request, registry.encode(find.request, {})) == {"part": {"kind": 0}, "where": "bin"}
    answer = registry.decode(find.response, registry.encode(find.response, {"at": [{"position": {"x": 1}}]}))
    at = {"position": {"x": 1.0, "y": 0.0, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
    assert answer == {"at": [at]}
    goal = {"goal_id": {"uuid": list(range(16))}, "goal": {"part": {"kind": 1}}}
    assert registry.decode(pick.send_goal.request, registry.encode(pick.send_goal.request, goal)) == goal
    result = {"status": 4, "result": {}}
    assert registry.decode(pick.get_result.response, registry.encode(pick.get_result.response, result)) == result
    event = registry.decode(find.event, registry.encode(find.event, {"request": [{"where": "box"}]}))
    assert (event["request"], event["response"]) == ([{"part": {"kind": 0}, "where": "box"}], [])
    assert registry.constants("cell_msgs/msg/Part") == {"NUT": 1, "LABEL": "x"}
    assert registry.constants(find.request) == {"FAST": -1}
    assert "cell_msgs/srv/Find" in registry.service_names()
    assert "cell_msgs/action/Pick" in registry.action_names()
    assert not any("cell_msgs/srv" in name for name in registry.type_names())


def test_standard_constants_are_known() -> None:
    assert standard().constants("action_msgs/msg/GoalStatus")["STATUS_SUCCEEDED"] == 4
    assert standard().constants("action_msgs/srv/CancelGoal_Response")["ERROR_UNKNOWN_GOAL_ID"] == 2


def test_an_unknown_service_suggests_the_nearest() -> None:
    with pytest.raises(UnknownMessageTypeError, match=r"no service type.*did you mean std_srvs/srv/Trigger"):
        standard().service("std_srvs/srv/Triger")
    with pytest.raises(UnknownMessageTypeError, match=r"no action type.*did you mean example_interfaces/action/Fib"):
        standard().action("example_interfaces/action/Fibonaci")


@pytest.mark.parametrize(
    ("name", "text", "place", "reason"),
    [
        ("srv/Find.srv", "bool a\n", "1:1", "a service has 2 parts (request, response)"),
        ("srv/Find.srv", "bool a\n---\n\n---\n", "4:1", "a service has 2 parts"),
        ("action/Pick.action", "---\n", "1:1", "an action has 3 parts (goal, result, feedback)"),
        ("srv/Find.srv", "---\n\n  bool Idle\n", "3:8", "use lower case"),
        ("srv/Find.srv", "---\nbool a\n bool a\n", "3:7", "already declared in line 2"),
        ("action/Pick.action", "---\n  Prt part\n---\n", "2:3", "no message type cell_msgs/msg/Prt"),
        ("srv/Find.srv", "int8 level 300\n---\n", "1:1", "the default of level should be int8"),
        ("srv/find.srv", "---\n", "1:1", "not a service name"),
        ("msg/State.msg", "string name hello\n", "1:13", "quotes"),
        ("msg/State.msg", "bool a\n---\n", "2:1", "cannot read '---'"),
    ],
)
def test_a_bad_definition_is_named_by_file_line_and_column(
    tmp_path: Path, name: str, text: str, place: str, reason: str
) -> None:
    path = write(tmp_path, f"cell_msgs/{name}", text)
    with pytest.raises(MessageDefinitionError) as caught:
        MessageRegistry.from_folder(tmp_path)
    assert str(caught.value).startswith(f"{path}:{place}: ")
    assert reason in caught.value.text


def test_the_package_for_colcon_holds_services_and_actions(tmp_path: Path) -> None:
    write(tmp_path, "messages/cell_msgs/srv/Find.srv", "---\ngeometry_msgs/Pose at\n")
    write(tmp_path, "messages/cell_msgs/action/Pick.action", "---\n---\nfloat32 done\n")
    [folder] = write_ament_package(tmp_path / "messages", tmp_path / "src")
    cmake = (folder / "CMakeLists.txt").read_text()
    assert '"srv/Find.srv"\n  "action/Pick.action"\n  DEPENDENCIES action_msgs geometry_msgs\n' in cmake
    assert (folder / "srv" / "Find.srv").is_file()
    manifest = ElementTree.parse(folder / "package.xml").getroot()
    assert [element.text for element in manifest.findall("depend")] == ["action_msgs", "geometry_msgs"]


def test_a_copy_of_a_standard_service_is_harmless_and_another_one_of_its_name_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path, "std_srvs/srv/Trigger.srv", "---\nbool success # whether it worked\nstring message\n")
    name = "std_srvs/srv/Trigger"
    assert MessageRegistry.from_folder(tmp_path).type_hash(name) == standard().type_hash(name)
    path.write_text("---\nbool success\n")
    with pytest.raises(MessageDefinitionError, match="Trigger_Response differs from the standard one"):
        MessageRegistry.from_folder(tmp_path)
