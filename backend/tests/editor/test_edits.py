"""Edits of a draft: each changes its part and nothing else, and none overwrites what somebody else did."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.editor.draft import (
    AddEntry,
    MoveEntry,
    PartChangedError,
    RemoveEntry,
    SetEntry,
    WriteText,
    applied,
)
from sequence_planner.editor.merging import MergeConflictError, merged
from sequence_planner.model.files import LONGEST_FILE, MOST_CHARACTERS
from sequence_planner.model.paths import EditError
from sequence_planner.model.yaml.editor import value_at
from support.places import MODELS

ROBOT = """\
# The robot of the cell.
title: Robot
abilities:
  # Where it goes.
  move:
    enabled: ready  # not before
    start: {do: ["target := out"]}
measured:
  ready: {type: bool}
"""
FILES = {"resources/robot.yaml": ROBOT, "station.yaml": "name: cell\n"}
FILE = "resources/robot.yaml"


def edited(*edits: SetEntry | AddEntry | RemoveEntry | MoveEntry | WriteText) -> str:
    return applied(FILES, edits)[FILE]


def test_an_entry_is_set_and_every_comment_stays() -> None:
    text = edited(SetEntry(file=FILE, path=["abilities", "move", "enabled"], was="ready", value="ready and not late"))
    assert text == ROBOT.replace("enabled: ready ", "enabled: ready and not late ")


def test_edits_are_carried_out_one_after_the_other() -> None:
    text = edited(
        AddEntry(file=FILE, path=["output", "target"], value={"type": "place"}),
        AddEntry(file=FILE, path=["output", "speed"], value={"type": "0..3"}, before="target"),
        MoveEntry(file=FILE, path=["measured"], was={"ready": {"type": "bool"}}, before="abilities"),
        RemoveEntry(file=FILE, path=["title"], was="Robot"),
    )
    content = value_at(text, ())
    assert list(content) == ["output", "measured", "abilities"]
    assert list(content["output"].items()) == [("speed", {"type": "0..3"}), ("target", {"type": "place"})]
    assert "# Where it goes." in text


def test_what_is_not_there_yet_is_made_on_the_way() -> None:
    new = AddEntry(file="resources/tool.yaml", path=["abilities", "run", "start", "do", 0], value="a := true")
    after = applied(FILES, [new])
    assert value_at(after["resources/tool.yaml"], ()) == {"abilities": {"run": {"start": {"do": ["a := true"]}}}}
    empty = {"operations.yaml": "# What is made here.\n"}
    after = applied(empty, [AddEntry(file="operations.yaml", path=["drill"], value={"goal": "done"})])
    assert after["operations.yaml"].startswith("# What is made here.\n")
    assert value_at(after["operations.yaml"], ()) == {"drill": {"goal": "done"}}
    hollow = {"operations.yaml": "drill:\n"}
    after = applied(hollow, [AddEntry(file="operations.yaml", path=["drill", "goal"], value="done")])
    assert value_at(after["operations.yaml"], ()) == {"drill": {"goal": "done"}}


def test_what_is_added_stands_where_documents_have_it() -> None:
    ability = ["abilities", "move"]
    text = edited(
        AddEntry(file=FILE, path=[*ability, "finish", "when"], value="done"),
        AddEntry(file=FILE, path=[*ability, "timeouts", "finish"], value=3),
        AddEntry(file=FILE, path=[*ability, "timeouts", "react"], value=1),
        AddEntry(file=FILE, path=[*ability, "title"], value="Move"),
        AddEntry(file=FILE, path=["topics", "/b"], value={"type": "a/msg/B", "direction": "in"}),
        AddEntry(file=FILE, path=["topics", "/a"], value={"type": "a/msg/A", "direction": "in"}),
        AddEntry(file=FILE, path=["output", "on"], value={"type": "bool"}),
    )
    # What stood otherwise stays so; names that an engineer gives follow each other as they were given.
    assert list(value_at(text, ())) == ["title", "topics", "output", "abilities", "measured"]
    assert list(value_at(text, tuple(ability))) == ["title", "timeouts", "enabled", "start", "finish"]
    assert list(value_at(text, (*ability, "timeouts"))) == ["react", "finish"]
    assert list(value_at(text, ("topics",))) == ["/b", "/a"]
    assert "  # Where it goes.\n  move:\n    title: Move\n" in text
    assert "enabled: ready  # not before" in text
    specification = applied(FILES, [
        AddEntry(file="specifications.yaml", path=["apart"], value={"while": "ready"}),
        AddEntry(file="specifications.yaml", path=["apart", "never"], value="done"),
    ])  # fmt: skip
    assert list(value_at(specification["specifications.yaml"], ("apart",))) == ["never", "while"]


@pytest.mark.parametrize(
    "edit",
    [
        SetEntry(file=FILE, path=["abilities", "move", "enabled"], was="idle", value="x"),
        SetEntry(file=FILE, path=["abilities", "turn", "enabled"], was="ready", value="x"),
        RemoveEntry(file=FILE, path=["abilities", "move"], was={"enabled": "ready"}),
        MoveEntry(file=FILE, path=["title"], was="robot"),
        SetEntry(file="resources/gone.yaml", path=["title"], was="Robot", value="x"),
        WriteText(file=FILE, was=ROBOT.replace("title: Robot", "title: Arm"), text=ROBOT.replace("Robot", "Hand")),
        WriteText(file="resources/gone.yaml", was="title: a\n", text="title: b\n"),
    ],
)
def test_what_was_made_from_something_else_is_refused(edit: SetEntry | WriteText) -> None:
    with pytest.raises(PartChangedError, match=edit.file):
        edited(edit)


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (AddEntry(file="../secret.yaml", path=["a"], value=1), "no file of a model"),
        (WriteText(file="stages/own.py", was=None, text="import os"), "no file of a model"),
        (WriteText(file="resources/a b.yaml", was=None, text=""), "no file of a model"),
        (AddEntry(file=FILE, path=["title"], value="x"), "there already"),
        (AddEntry(file=FILE, path=["title", "x"], value="x"), "holds no entries"),
        (WriteText(file=FILE, was=ROBOT, text="title: \0"), "0x0000"),
    ],
)
def test_what_cannot_be_done_is_said(edit: AddEntry | WriteText, said: str) -> None:
    with pytest.raises(EditError, match=said):
        edited(edit)


def test_a_text_that_cannot_be_read_is_kept_and_edited_as_text_alone() -> None:
    broken = applied(FILES, [WriteText(file=FILE, was=ROBOT, text="title: [\n")])
    with pytest.raises(EditError, match="before it can be read"):
        applied(broken, [SetEntry(file=FILE, path=["title"], was="Robot", value="x")])
    assert applied(broken, [WriteText(file=FILE, was="title: [\n", text=ROBOT)]) == FILES


def test_other_lines_of_the_same_file_are_brought_together() -> None:
    mine, theirs = ROBOT.replace("Robot\n", "Arm\n"), ROBOT.replace("bool", "0..3")
    files = applied({FILE: theirs}, [WriteText(file=FILE, was=ROBOT, text=mine)])
    assert files[FILE] == theirs.replace("Robot\n", "Arm\n")


def test_a_file_is_taken_away_unless_somebody_has_changed_it() -> None:
    assert applied(FILES, [WriteText(file=FILE, was=ROBOT, text=None)]) == {"station.yaml": "name: cell\n"}
    with pytest.raises(PartChangedError):
        applied({FILE: ROBOT + "# more\n"}, [WriteText(file=FILE, was=ROBOT, text=None)])


LINES = st.lists(st.sampled_from(["a\n", "b\n", "c\n", "d\n"]), max_size=6).map("".join)
TEXTS = st.one_of(st.none(), LINES)


@given(TEXTS, TEXTS)
def test_what_one_alone_has_done_is_what_comes_of_it(old: str | None, new: str | None) -> None:
    assert merged(old, new, old) == new
    assert merged(old, old, new) == new
    assert merged(old, new, new) == new


@given(LINES, LINES, LINES, LINES)
def test_two_who_changed_other_parts_get_both(above: str, below: str, new_above: str, new_below: str) -> None:
    between = "1\n2\n3\n"
    old = above + between + below
    assert merged(old, new_above + between + below, above + between + new_below) == new_above + between + new_below


@given(TEXTS, TEXTS, TEXTS)
def test_it_does_not_matter_who_was_first(old: str | None, one: str | None, other: str | None) -> None:
    def outcome(first: str | None, second: str | None) -> str | bool | None:
        try:
            return merged(old, first, second)
        except MergeConflictError:
            return False

    assert outcome(one, other) == outcome(other, one)


def test_a_model_has_no_more_text_than_can_be_looked_at() -> None:
    files = {f"resources/r{number}.yaml": "x" * LONGEST_FILE for number in range(MOST_CHARACTERS // LONGEST_FILE)}
    with pytest.raises(EditError, match=f"at most {MOST_CHARACTERS} in all its files"):
        applied(files, [WriteText(file="resources/more.yaml", was=None, text="x")])


PICTURES = sorted(MODELS.glob("*/mimic.yaml"))


def numbers_in(content: object, path: tuple[str | int, ...] = ()) -> list[tuple[tuple[str | int, ...], float]]:
    """Every number of a file, with the way to it."""
    if isinstance(content, dict):
        return [found for key, each in content.items() for found in numbers_in(each, (*path, str(key)))]
    if isinstance(content, list):
        return [found for key, each in enumerate(content) for found in numbers_in(each, (*path, key))]
    return [(path, content)] if isinstance(content, int | float) and not isinstance(content, bool) else []


@given(st.data())
def test_a_number_of_a_picture_is_set_and_nothing_else_in_its_file_changes(data: st.DataObject) -> None:
    """What is dragged changes numbers alone: all around them stays as a person has written it."""
    text = data.draw(st.sampled_from(PICTURES)).read_text(encoding="utf-8")
    path, was = data.draw(st.sampled_from(numbers_in(value_at(text, ()))))
    value = data.draw(st.integers(-900, 900).map(lambda hundredths: hundredths / 4))
    edit = SetEntry(file="mimic.yaml", path=list(path), was=was, value=int(value) if value == int(value) else value)
    after = applied({"mimic.yaml": text}, [edit])["mimic.yaml"]
    shape = re.compile(r"-?\d+(\.\d+)?")
    assert shape.sub("", after) == shape.sub("", text)
    others = [(a, b) for a, b in zip(shape.finditer(text), shape.finditer(after), strict=True) if a[0] != b[0]]
    assert len(others) == (value != was)
    assert value_at(after, path) == value


def test_a_number_is_the_same_with_a_point_and_without() -> None:
    """A browser reads `418.0` as 418, and says so of what it edits."""
    edit = SetEntry(file="mimic.yaml", path=["size", 0], was=418, value=420)
    assert applied({"mimic.yaml": "size: [418.0, 200] # wide\n"}, [edit]) == {"mimic.yaml": "size: [420, 200] # wide\n"}
    with pytest.raises(PartChangedError):
        applied({"mimic.yaml": "size: [true, 200]\n"}, [edit.model_copy(update={"was": 1})])
