"""What attaching a topic makes of a model."""

from __future__ import annotations

from difflib import ndiff
from pathlib import Path, PurePosixPath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.editor.attach import (
    AttachError,
    Attachment,
    FoundTopic,
    StageProposal,
    attachment,
    definition_files,
    with_proposals,
    with_topic,
)
from sequence_planner.language.types import BOOLEAN
from sequence_planner.model.yaml.content import same
from sequence_planner.model.yaml.reader import read_text
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.station import prepare_station

from .pressing import press_registry, station

STATE, COMMAND = "press_msgs/msg/PressState", "press_msgs/msg/PressCommand"
FOUND = ("press_msgs/msg/PressState", "press_msgs/msg/Tool")


def incoming(type_name: str = STATE, name: str = "/press/state", found: tuple[str, ...] = FOUND) -> FoundTopic:
    return FoundTopic(name, type_name, "in", QualityOfService.SENSOR_DATA, "/press", found)


def outgoing() -> FoundTopic:
    return FoundTopic("/press/command", COMMAND, "out", QualityOfService.RELIABLE, "/press", (COMMAND,))


def made(folder: Path, topic: FoundTopic, resource: str = "press") -> tuple[Path, Attachment]:
    """The station with the topic, and the change that made it."""
    cell = station(folder)
    change = attachment(cell, press_registry(folder / "messages"), topic, resource)
    change.make(cell)
    return cell, change


def test_fields_become_variables_and_the_definitions_are_the_same_types(tmp_path: Path) -> None:
    cell, change = made(tmp_path, incoming())
    ready = prepare_station(cell)
    assert ready.pipelines.incoming["/press/state"].variables == ("press.closed", "press.mode")
    assert ready.automaton.variables["press.closed"].type == BOOLEAN
    assert ready.pipelines.incoming["/press/state"].topic.quality == QualityOfService.SENSOR_DATA
    assert ready.pipelines.incoming["/press/state"].deadline == 1.0
    registry = press_registry(tmp_path / "again")
    for name in FOUND:
        assert ready.registry.type_hash(name) == registry.type_hash(name)
    assert [next(iter(each.stage)) for each in change.proposals] == [
        "expression", "match", "expression", "rename", "match",
    ]  # fmt: skip


def test_every_proposal_can_be_taken_as_it_is_written(tmp_path: Path) -> None:
    cell, change = made(tmp_path, incoming())
    text = (cell / "resources" / "press.yaml").read_text()
    proposed = [line for line in text.splitlines() if line.strip().startswith("#   - ")]
    assert len(proposed) == len(change.proposals) == 5
    taken = text + "    pipeline:\n" + "".join(f"      {line.strip().removeprefix('#   ')}\n" for line in proposed)
    types = "".join(f"  {each.variable}: {{type: {each.type}}}\n" for each in change.proposals)
    (cell / "resources" / "press.yaml").write_text(f"{taken}measured:\n{types}")
    variables = prepare_station(cell).pipelines.incoming["/press/state"].variables
    assert {f"press.{each.variable}" for each in change.proposals} < set(variables)


def test_a_document_keeps_all_that_is_in_it(tmp_path: Path) -> None:
    before = (station(tmp_path / "before") / "resources" / "arm.yaml").read_text().splitlines()
    cell, _ = made(tmp_path, outgoing(), "arm")
    after = (cell / "resources" / "arm.yaml").read_text().splitlines()
    said = [each[2:] for each in ndiff(before, after) if each.startswith("+ ")]
    assert not [each for each in ndiff(before, after) if each.startswith("- ")]
    assert said == [
        "  # What else could be sent in its fields: stages of `pipeline`.",
        "  #   - constant: {speed: 0.0}",
        "  #   - constant: {program: ready}",
        "  /press/command:",
        "    type: press_msgs/msg/PressCommand",
        "    direction: out",
    ]
    assert prepare_station(cell).automaton.variables["arm.close"].type == BOOLEAN


def test_where_no_field_is_a_variable_the_first_proposal_is_made(tmp_path: Path) -> None:
    cell, change = made(tmp_path, incoming("std_msgs/msg/Float64", "/press/force", ()))
    assert change.measured == {"data_is_positive": {"type": "bool"}}
    assert prepare_station(cell).pipelines.incoming["/press/force"].variables == ("press.data_is_positive",)


def test_names_that_are_taken_get_others(tmp_path: Path) -> None:
    cell = station(tmp_path)
    registry = press_registry(tmp_path / "messages")
    attachment(cell, registry, incoming(), "press").make(cell)
    second = attachment(cell, registry, incoming(name="/other/state", found=()), "press")
    assert second.entry["pipeline"] == [{"rename": {"closed": "state_closed", "mode": "state_mode"}}]
    second.make(cell)
    assert prepare_station(cell).pipelines.incoming["/other/state"].variables == (
        "press.state_closed",
        "press.state_mode",
    )


@pytest.mark.parametrize(
    ("topic", "resource", "slug"),
    [
        (incoming(name="/arm/state"), "arm", "attached"),
        (incoming(), "../press", "bad-name"),
        (incoming(), "and", "bad-name"),
        (incoming("press_msgs/msg/Nothing"), "press", "nothing-to-measure"),
        (incoming(found=("press_msgs/action/Go",)), "press", "no-message"),
    ],
)
def test_what_cannot_be_attached_is_refused(tmp_path: Path, topic: FoundTopic, resource: str, slug: str) -> None:
    registry = press_registry(tmp_path / "messages")
    with pytest.raises(AttachError) as refused:
        attachment(station(tmp_path), registry, topic, resource)
    assert refused.value.slug == slug


def test_nothing_is_changed_when_a_file_was_changed_or_is_there_already(tmp_path: Path) -> None:
    cell = station(tmp_path)
    change = attachment(cell, press_registry(tmp_path / "messages"), incoming(), "arm")
    arm = cell / "resources" / "arm.yaml"
    arm.write_text(arm.read_text() + "# by somebody else\n")
    with pytest.raises(AttachError, match="was changed by somebody else"):
        change.make(cell)
    assert not (cell / "messages" / "press_msgs" / "msg" / "PressState.msg").exists()
    definition = cell / "messages" / "press_msgs" / "msg" / "Tool.msg"
    definition.write_text("bool locked\n")
    with pytest.raises(AttachError, match="cannot be changed"):
        attachment(cell, press_registry(tmp_path / "again"), incoming(), "press").make(cell)
    assert definition.read_text() == "bool locked\n"
    assert not (cell / "resources" / "press.yaml").exists()


def test_a_copy_is_changed_and_the_model_is_not(tmp_path: Path) -> None:
    cell = station(tmp_path)
    change = attachment(cell, press_registry(tmp_path / "messages"), incoming(), "press")
    with change.made_on_copy(cell) as (copy, difference):
        assert "/press/state" in prepare_station(copy).pipelines.incoming
    assert str(cell) in difference
    assert str(copy) not in difference
    assert not (cell / "resources" / "press.yaml").exists()


DOCUMENTS = st.sampled_from(
    [
        "title: Press\n",
        "# all of it\nmeasured:\n  a: {type: bool} # this\n",
        "topics:\n  /a:\n    type: x/msg/Y\n  # about b\n  /b: {type: x/msg/Y, direction: out}\n\nmeasured: {}\n",
        "topics: {/a: {type: x/msg/Y, direction: in}}\ntitle: T\n",
        "topics:\nmeasured:\n  a: {type: bool}\n",
        "topics:\n    /a:\n        type: x/msg/Y\n        direction: in",
    ]
)


@given(DOCUMENTS, st.booleans())
def test_in_any_document_only_the_entries_are_added(text: str, is_measured: bool) -> None:
    entry = {"type": "std_msgs/msg/Float64", "direction": "in", "deadline": 1.0}
    measured = {"data_is_positive": {"type": "bool"}} if is_measured else {}
    topic = incoming("std_msgs/msg/Float64", "/press/force", ())
    after = with_topic(text, topic, entry, measured)
    content, before = read_text(after, "after").content, read_text(text, "before").content
    assert isinstance(content, dict)
    assert isinstance(before, dict)
    assert same(content["topics"], {**(before.get("topics") or {}), "/press/force": entry})
    assert same(content.get("measured"), {**(before.get("measured") or {}), **measured} or before.get("measured"))
    commented = with_proposals(after, topic, [StageProposal({"expression": {"b": "data > 1"}})])
    assert same(read_text(commented, "commented").content, content)
    assert "#   - expression: {b: data > 1}" in commented
    assert [line for line in commented.splitlines() if line in after.splitlines()] == after.splitlines()


def test_definitions_are_written_so_that_they_can_be_read(tmp_path: Path) -> None:
    registry = MessageRegistry.from_folder(None)
    files = definition_files(registry, ["sensor_msgs/msg/JointState", "geometry_msgs/msg/PoseStamped"], "/arm")
    text = files[PurePosixPath("messages/sensor_msgs/msg/JointState.msg")]
    assert text.splitlines()[1:] == [
        "std_msgs/Header header", "string[] name", "float64[] position", "float64[] velocity", "float64[] effort",
    ]  # fmt: skip
