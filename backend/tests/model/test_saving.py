"""Editing files: whole or not at all, and never over what somebody else has written."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.model.paths import EditError
from sequence_planner.model.yaml.editor import replace
from sequence_planner.model.yaml.saving import digest, edit_file


def change(text: str) -> str:
    return replace(text, ("a", "b"), 2)


@pytest.mark.parametrize("ends", ["\n", "\r\n"], ids=["LF", "CRLF"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"], ids=["plain", "byte order mark"])
def test_only_the_changed_bytes_differ(tmp_path: Path, ends: str, mark: bytes) -> None:
    file = tmp_path / "é.yaml"
    lines = ["# ä 😀", "a:  # c", "  b: {}  # d", ""]
    file.write_bytes(mark + ends.join(lines).replace("{}", "1").encode())
    file.chmod(0o640)
    difference = edit_file(file, change)
    assert file.read_bytes() == mark + ends.join(lines).replace("{}", "2").encode()
    assert difference.split("\n")[3:] == [" # ä 😀", " a:  # c", "-  b: 1  # d", "+  b: 2  # d", ""]
    assert file.stat().st_mode & 0o777 == 0o640
    assert list(tmp_path.iterdir()) == [file]


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real.yaml").write_text("a: {b: 1}\n")
    link = tmp_path / "link.yaml"
    link.symlink_to("real.yaml")
    edit_file(link, change)
    assert link.is_symlink()
    assert (tmp_path / "real.yaml").read_text() == "a: {b: 2}\n"


def test_nothing_is_written_when_nothing_changes(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text("a: {b: 2}")
    before = file.stat().st_ino
    assert edit_file(file, change) == ""
    assert file.stat().st_ino == before


def test_a_file_that_somebody_else_has_changed_is_left_alone(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text("a: {b: 1}\n")
    seen = digest(file)
    file.write_text("a: {b: 7}\n")
    with pytest.raises(EditError, match=r"changed by somebody else in the meantime\. Nothing is lost"):
        edit_file(file, change, expected=seen)
    assert file.read_text() == "a: {b: 7}\n"
    edit_file(file, change, expected=digest(file))
    assert file.read_text() == "a: {b: 2}\n"


def test_a_failed_change_leaves_the_file_alone(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text("a: {c: 1}\n")
    with pytest.raises(EditError, match="`a` has no entry `b`"):
        edit_file(file, change)
    assert file.read_text() == "a: {c: 1}\n"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize(
    ("content", "message"), [(b"a: \xff", "it is not UTF-8 text"), (b"a:\r\n  b: 1\n", "line ends of both kinds")]
)
def test_files_that_cannot_be_edited(tmp_path: Path, content: bytes, message: str) -> None:
    file = tmp_path / "a.yaml"
    file.write_bytes(content)
    with pytest.raises(EditError, match=message):
        edit_file(file, change)
    with pytest.raises(EditError, match="cannot be read: No such file"):
        edit_file(tmp_path / "none.yaml", change)
