"""Resource files that differ in a few words are offered as one type and its instances."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.editor.draft import applied
from sequence_planner.editor.folds.finder import Fold, FoldFinder
from sequence_planner.editor.folds.sameness import difference
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.execution.record.recorder import model_digest
from sequence_planner.model.files import read_files, write_files
from sequence_planner.model.yaml.content import plain
from sequence_planner.model.yaml.reader import read_text
from sequence_planner.station import MeantStation, read_station
from support.examples import examples
from support.places import MODELS, TESTS

ROBOTS = MODELS / "robots_with_buffer"


def _read(files: dict[str, str]) -> MeantStation:
    with tempfile.TemporaryDirectory() as folder:
        write_files(files, Path(folder))
        return read_station(Path(folder))


def _types(files: dict[str, str]) -> list[Fold]:
    with tempfile.TemporaryDirectory() as folder:
        return [fold for fold in FoldFinder(Path(folder)).folds(files).folds if fold.kind is FoldKind.TYPE]


@pytest.fixture(scope="module")
def written_out(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The two robots as they were before they had a type."""
    folder = Path(shutil.copytree(ROBOTS, tmp_path_factory.mktemp("robots") / "robots"))
    shutil.rmtree(folder / "types")
    for file in (TESTS / "model" / "written_out").glob("*.yaml"):
        shutil.copy(file, folder / "resources")
    return read_files(folder)


def test_two_robots_are_of_one_type(written_out: dict[str, str]) -> None:
    (fold,) = _types(written_out)
    assert (fold.title, fold.name) == ("Make `robot_1` and `robot_2` instances of a type `robot`", "robot")
    assert [place.file for place in fold.places] == ["resources/robot_1.yaml", "resources/robot_2.yaml"]
    made = _content(fold.files["types/robot.yaml"])
    assert made["parameters"] == {
        "sides": "enumeration",
        "own_side": {"kind": "value", "of": "sides"},
        "namespace": "text",
    }
    assert list(made["topics"]) == ["/{namespace}/state", "/{namespace}/command"]
    assert made["measured"] == {"at": {"type": "place", "initial": "own_side"}}
    assert list(made["abilities"]) == ["move_to", "open_gripper"]
    second = _content(fold.files["resources/robot_2.yaml"])
    assert list(second) == ["type", "arguments", "title", "abilities"]
    assert second["arguments"] == {"sides": "outfeed_side", "own_side": "outfeed", "namespace": "robot_2"}
    assert list(second["abilities"]["move_to"]) == ["enabled"]
    assert fold.saved_lines > 20


def test_it_is_what_people_made_of_it(written_out: dict[str, str]) -> None:
    """What differs is the words of the parameters: types and instances hold the same entries."""
    (fold,) = _types(written_out)
    by_hand = read_files(ROBOTS)
    for file in ("types/robot.yaml", "resources/robot_1.yaml", "resources/robot_2.yaml"):
        assert _names(_content(fold.files[file])) == _names(_content(by_hand[file]))
    assert model_digest(_read({**written_out, **fold.files}).automaton) == model_digest(_read(by_hand).automaton)


def test_comments_stay_where_they_are_about_something(written_out: dict[str, str]) -> None:
    (fold,) = _types(written_out)
    first, type_ = fold.files["resources/robot_1.yaml"], fold.files["types/robot.yaml"]
    told = "# To the buffer with a part, back to the infeed without one: there the next part lies in the way.\n"
    assert told in first and told not in type_
    slips = (
        "  # A part that slips out of the gripper on its way: nobody counts on it, and the station must survive it.\n"
    )
    assert slips in type_ and slips not in first
    assert type_.startswith("# yaml-language-server: $schema=../../../docs/schemas/type.schema.json\nparameters:\n")
    assert first.startswith("# yaml-language-server: $schema=../../../docs/schemas/instance.schema.json\ntype: robot\n")


def test_a_comment_that_would_be_lost_is_not_lost(written_out: dict[str, str]) -> None:
    second = written_out["resources/robot_2.yaml"]
    files = {**written_out, "resources/robot_2.yaml": second.replace("  open_gripper:", "  # Twice.\n  open_gripper:")}
    assert _types(files) == []


def test_the_type_is_called_as_it_is_told(written_out: dict[str, str], tmp_path: Path) -> None:
    (fold,) = _types(written_out)
    named = FoldFinder(tmp_path).fold(written_out, fold.id, "arm")
    assert named.files.keys() == {"types/arm.yaml", "resources/robot_1.yaml", "resources/robot_2.yaml"}
    assert "\ntype: arm\n" in named.files["resources/robot_1.yaml"]
    assert applied(written_out, named.edits) == {**written_out, **named.files}


def test_resources_that_have_little_in_common_stay_apart() -> None:
    assert _types(read_files(MODELS / "docking_agv")) == []
    assert _types(read_files(MODELS / "truck_engine_station")) == []


def _content(text: str) -> Any:  # noqa: ANN401 (content of any form)
    return plain(read_text(text, "it").content)


def _names(content: object) -> object:
    """The names of entries, but for parameters and what they are, and for the words of variables, which came later."""
    if not isinstance(content, dict):
        return None
    left_out = {
        "parameters",
        "arguments",
        "phrase",
        "titles",
        *(["title"] if isinstance(content.get("title"), dict) else []),
    }
    found = {key: _names(each) for key, each in content.items() if key not in left_out}
    return {key: each for key, each in found.items() if each != {}}


def _assert_same_connections(one: MeantStation, other: MeantStation) -> None:
    assert one.station.resources.keys() == other.station.resources.keys()
    for name, resource in one.station.resources.items():
        same = other.station.resources[name]
        assert resource.topics.keys() == same.topics.keys()
        for topic, said in resource.topics.items():
            now = same.topics[topic]
            assert (said.type, said.direction, said.deadline, said.every, said.ignore) == (
                now.type,
                now.direction,
                now.deadline,
                now.every,
                now.ignore,
            )
            assert repr(said.pipeline) == repr(now.pipeline)


# Types written out by hand.

STATION = """\
name: line
enumerations:
  load: [none, blank, finished]
  size: [small, large]
  place: [between, front, back]
rest: true
"""
MESSAGES = {
    "messages/line_msgs/msg/BeltState.msg": "bool at_end\nstring what\n",
    "messages/line_msgs/msg/BeltCommand.msg": "bool drive\nint32 speed\n",
}
BELT = """\
title: {title}

topics:
  /{space}/state:
    type: line_msgs/msg/BeltState
    direction: in
    deadline: {deadline}
    ignore: [what]
  /{space}/command:
    type: line_msgs/msg/BeltCommand
    direction: out
    every: 0.5
    pipeline:
      - constant: {{speed: {speed}}}

estimated:
  carried: {{type: {loads}}}
  worn: {{type: 0..{most}}}
  goal: {{type: place, initial: {place}}}

abilities:
{before}  run:
    title: Run {space} to the {place}
    enabled: not drive and not at_end and goal == {place} and not {other}.at_end and worn < {most}
    start: {{do: [drive := true]}}
    executing: drive and not at_end # the belt turns
    finish:
      when: drive and at_end
      do: [drive := false, worn := worn + 1 if worn < {most}]
    effects:
      # At its end.
      arrives: {{when: drive and not at_end, do: [at_end := true], takes: {takes}}}
{after}"""
OWN = "  {name}: {{enabled: '{what}', start: {{do: [carried := {value}]}}}}\n"


@st.composite
def belts(draw: st.DrawFn) -> dict[str, str]:
    """Stations with belts that differ in what a type could have as parameters, and in an ability of their own."""
    count = draw(st.integers(2, 3))
    names = [f"belt_{number}" for number in range(1, count + 1)]
    same = draw(st.fixed_dictionaries({"deadline": st.sampled_from([1.0, 2]), "most": st.integers(1, 3)}))
    files = {"station.yaml": STATION, **MESSAGES}
    for name in names:
        loads = draw(st.sampled_from(["load", "size"]))
        value = {"load": "blank", "size": "large"}[loads]
        own = OWN.format(
            name=f"put_{draw(st.sampled_from('ab'))}", what=draw(st.sampled_from(["true", "at_end"])), value=value
        )
        is_before = draw(st.sampled_from([None, True, False]))
        fields = {
            "title": draw(st.sampled_from([name, "A belt"])),
            "space": draw(st.sampled_from([name, f"hall/{name}"])),
            "speed": draw(st.integers(1, 3)),
            "place": draw(st.sampled_from(["front", "back"])),
            "takes": draw(st.sampled_from(["2", "3.5", "[1, 2]"])),
            "other": draw(st.sampled_from(names)),
            **same,
            **({"most": draw(st.integers(1, 3))} if draw(st.booleans()) else {}),
        }
        files[f"resources/{name}.yaml"] = BELT.format(
            loads=loads, before=own if is_before else "", after=own if is_before is False else "", **fields
        )
    return files


@given(belts())
@examples(25)
def test_what_was_written_out_is_folded_back_and_means_the_same(files: dict[str, str]) -> None:
    before = _read(files)
    (fold,) = _types(files)
    now = _read({**files, **fold.files})
    _assert_same_connections(before, now)
    assert difference(before.automaton, now.automaton) is None
    assert model_digest(before.automaton) == model_digest(now.automaton)
    type_ = fold.files[f"types/{fold.name}.yaml"]
    assert (type_.count("# the belt turns"), type_.count("arrives:")) == (1, 1)
    is_told_in_it = "arrives:" not in fold.files["resources/belt_1.yaml"]  # else its times are, and the comment
    assert type_.count("# At its end.") == is_told_in_it
    for file in files:
        if file.startswith("resources/"):
            assert "# the belt turns" not in fold.files[file]
            assert "finish" not in fold.files[file]
