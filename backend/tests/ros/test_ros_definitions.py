"""A `.msg` file that cannot be used is refused with its file, its line and what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.ros.types.errors import MessageDefinitionError
from sequence_planner.ros.types.messages import MessageRegistry

BAD_LINES = [
    ("wstring name", "use string"),
    ("Header header", "write std_msgs/Header"),
    ("time stamp", "write builtin_interfaces/Time"),
    ("double[] values", "write float64"),
    ("bool", "`type name`"),
    ("bool a b c", "the default of a should be bool"),
    ("bool 2nd", "`type name"),
    ("bool isIdle", "use lower case"),
    ("bool is__idle", "single underscores"),
    ("bool idle_", "single underscores"),
    ("bool before", "already declared in line 1"),
    ("geometry_msgs/Pos3 p", "no message type geometry_msgs/msg/Pos3, did you mean geometry_msgs/msg/Pose"),
    ("boool idle", "no message type cell_msgs/msg/boool"),
    ("State inner", "a message within itself"),
    ("int8 level 300", "the default of level should be int8"),
    ("int8 level 1.5", "the default of level should be int8"),
    ("float64[3] axis [1.0, 2.0]", "exactly 3 items"),
    ("string name hello  # or this?", "quotes"),
    ("bool ready 2", "the default of ready should be bool"),
]


def write(folder: Path, name: str, text: str, package: str = "cell_msgs") -> Path:
    path = folder / package / "msg" / f"{name}.msg"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(("line", "text"), BAD_LINES)
def test_a_bad_line_is_named(tmp_path: Path, line: str, text: str) -> None:
    path = write(tmp_path, "State", f"bool before\n# a comment\n\n{line}\nbool after\n")
    with pytest.raises(MessageDefinitionError) as caught:
        MessageRegistry.from_folder(tmp_path)
    assert (caught.value.path, caught.value.line) == (path, 4)
    assert text in caught.value.text
    assert str(caught.value).startswith(f"{path}:4:")


def test_messages_that_contain_each_other_are_refused(tmp_path: Path) -> None:
    write(tmp_path, "A", "B b\n")
    write(tmp_path, "B", "int8 n\nA[] a\n")
    with pytest.raises(MessageDefinitionError, match="cell_msgs/msg/A in cell_msgs/msg/B in cell_msgs/msg/A"):
        MessageRegistry.from_folder(tmp_path)


@pytest.mark.parametrize(
    ("package", "name", "text"),
    [("Cell_msgs", "State", "not a package name"), ("cell_msgs", "nut_state", "not a message name")],
)
def test_a_bad_name_is_refused(tmp_path: Path, package: str, name: str, text: str) -> None:
    write(tmp_path, name, "bool idle\n", package)
    with pytest.raises(MessageDefinitionError, match=text):
        MessageRegistry.from_folder(tmp_path)


def test_a_standard_type_cannot_be_redefined(tmp_path: Path) -> None:
    write(tmp_path, "String", "bool data\n", "std_msgs")
    with pytest.raises(MessageDefinitionError, match="give the package another name"):
        MessageRegistry.from_folder(tmp_path)


def test_a_copy_of_a_standard_type_is_harmless(tmp_path: Path) -> None:
    write(tmp_path, "String", "# as in std_msgs\nstring data\n", "std_msgs")
    standard = MessageRegistry.from_folder(None)
    copied = MessageRegistry.from_folder(tmp_path)
    assert copied.type_hash("std_msgs/msg/String") == standard.type_hash("std_msgs/msg/String")


def test_a_missing_folder_and_a_binary_file_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MessageDefinitionError, match="no such folder"):
        MessageRegistry.from_folder(tmp_path / "messages")
    write(tmp_path, "State", "").write_bytes(b"bool idle # \xff")
    with pytest.raises(MessageDefinitionError, match="UTF-8"):
        MessageRegistry.from_folder(tmp_path)


def test_line_ends_of_windows_do_not_matter(tmp_path: Path) -> None:
    write(tmp_path, "State", "bool idle\r\n\r\nfloat32 torque\r\n")
    assert list(MessageRegistry.from_folder(tmp_path).fields("cell_msgs/msg/State")) == ["idle", "torque"]
