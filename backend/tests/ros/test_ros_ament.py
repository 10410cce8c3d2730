"""The packages written for colcon hold what rosidl needs."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from sequence_planner.ros.types.errors import MessageDefinitionError
from sequence_planner.ros.types.interfaces import write_ament_package


@pytest.fixture
def messages(tmp_path: Path) -> Path:
    definitions = {
        "tool_msgs/msg/State.msg": "bool idle\n",
        "cell_msgs/msg/Part.msg": "string name\n",
        "cell_msgs/msg/Cell.msg": "Part[] parts\ntool_msgs/State tool\nstd_msgs/Header header\n",
    }
    for name, text in definitions.items():
        path = tmp_path / "messages" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "messages"


def test_each_package_names_its_messages_and_what_they_use(messages: Path, tmp_path: Path) -> None:
    source = tmp_path / "ws" / "src"
    assert write_ament_package(messages, source) == [source / "cell_msgs", source / "tool_msgs"]
    manifest = ElementTree.parse(source / "cell_msgs" / "package.xml").getroot()
    assert manifest.findtext("name") == "cell_msgs"
    assert [element.text for element in manifest.findall("depend")] == ["std_msgs", "tool_msgs"]
    assert manifest.findtext("member_of_group") == "rosidl_interface_packages"
    cmake = (source / "cell_msgs" / "CMakeLists.txt").read_text()
    assert "project(cell_msgs)" in cmake
    assert "find_package(tool_msgs REQUIRED)" in cmake
    assert (
        'rosidl_generate_interfaces(${PROJECT_NAME}\n  "msg/Cell.msg"\n  "msg/Part.msg"\n'
        "  DEPENDENCIES std_msgs tool_msgs\n)" in cmake
    )
    assert "DEPENDENCIES" not in (source / "tool_msgs" / "CMakeLists.txt").read_text()
    assert (source / "cell_msgs" / "msg" / "Part.msg").read_text() == "string name\n"


def test_writing_again_replaces_what_was_written(messages: Path, tmp_path: Path) -> None:
    source = tmp_path / "src"
    write_ament_package(messages, source)
    (messages / "cell_msgs" / "msg" / "Part.msg").rename(messages / "cell_msgs" / "msg" / "Piece.msg")
    (messages / "cell_msgs" / "msg" / "Cell.msg").write_text("Piece[] parts\n")
    write_ament_package(messages, source)
    assert sorted(path.name for path in (source / "cell_msgs" / "msg").iterdir()) == ["Cell.msg", "Piece.msg"]


def test_what_others_wrote_is_left_alone(messages: Path, tmp_path: Path) -> None:
    theirs = tmp_path / "src" / "tool_msgs" / "package.xml"
    theirs.parent.mkdir(parents=True)
    theirs.write_text("<package/>")
    with pytest.raises(FileExistsError, match="tool_msgs is there already"):
        write_ament_package(messages, tmp_path / "src")
    with pytest.raises(FileExistsError):
        write_ament_package(messages, messages)
    assert theirs.read_text() == "<package/>"
    assert not (tmp_path / "src" / "cell_msgs").exists()


def test_bad_definitions_write_nothing(messages: Path, tmp_path: Path) -> None:
    (messages / "tool_msgs" / "msg" / "State.msg").write_text("bool Idle\n")
    with pytest.raises(MessageDefinitionError):
        write_ament_package(messages, tmp_path / "src")
    assert not (tmp_path / "src").exists()
