"""What an editor shows while somebody writes a station: what is wrong, what mends it, what can stand somewhere."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest

from support.editor import Editor
from support.places import TESTS
from support.waiting import until


def test_a_wrong_name_is_underlined_and_mended(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "resources" / "nutrunner.yaml")
    before = editor.text(uri)
    editor.type(uri, "robot.pose == bolt_pair_1 and", "robot.pos == bolt_pair_1 and")
    shown = editor.until_shown(uri, "unknown variable `robot.pos`")
    lines = editor.text(uri).split("\n")
    start, end = shown["range"]["start"], shown["range"]["end"]
    assert lines[start["line"]][start["character"] : end["character"]] == "robot.pos"
    assert (shown["severity"], shown["source"]) == (1, "sequence-planner")
    actions = editor.ask(
        "textDocument/codeAction", textDocument={"uri": uri}, range=shown["range"], context={"diagnostics": [shown]}
    )
    fixes = [each for each in actions if each["kind"] == "quickfix"]
    assert [each["title"] for each in fixes] == ["Write `robot.pose`"]
    assert fixes[0]["isPreferred"]
    editor.apply(fixes[0]["edit"])
    assert editor.text(uri) == before
    editor.until_clean(uri)
    editor.close(uri)


def test_what_is_wrong_elsewhere_is_shown_there(editor: Editor, station: Path) -> None:
    """A whole station is looked at, of which one document is open, and not as it is saved."""
    uri = editor.open(station / "station.yaml")
    nutrunner = (station / "resources" / "nutrunner.yaml").as_uri()
    editor.type(uri, "bolt_pair_3", "bolt_pair_4")
    editor.until_shown(nutrunner, "bolt_pair_3")
    editor.type(uri, "bolt_pair_4", "bolt_pair_3")
    editor.until_clean(nutrunner)
    editor.close(uri)


def test_findings_leave_with_the_last_document(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "operations.yaml")
    other = editor.open(station / "station.yaml")
    editor.type(uri, "goal:", "gaol:")
    editor.until_shown(uri, "`gaol` is not known here; did you mean `goal`?")
    editor.close(other)
    editor.type(uri, "gaol:", "gooal:")
    editor.until_shown(uri, "`gooal`")
    editor.close(uri)
    until(lambda: not editor.diagnostics[uri], "nothing is shown")


def test_a_pipeline_and_what_is_suspicious_are_looked_at_too(editor: Editor, station: Path) -> None:
    resource = station / "resources" / "nutrunner.yaml"
    text = resource.read_text(encoding="utf-8")
    pipeline = "    deadline: 1.0\n    pipeline:\n      - rename: {nothing_like_it: tool_is_idle}\n"
    resource.write_text(text.replace("    deadline: 1.0\n", pipeline, 1), encoding="utf-8")
    uri = editor.open(resource)
    editor.until_shown(uri, "there is no field `nothing_like_it` here")
    editor.type(uri, "    pipeline:\n      - rename: {nothing_like_it: tool_is_idle}\n", "")
    other = editor.open(station / "station.yaml")
    editor.type(other, "  bolts:\n", "  spare: {type: bool}\n  bolts:\n")
    shown = editor.until_shown(other, "nothing reads `spare`")
    assert (shown["severity"], shown["code"]) == (2, "never-read")
    editor.close(uri)
    editor.close(other)


def test_unfinished_yaml_keeps_names_known(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "resources" / "nutrunner.yaml")
    editor.options(uri, "    enabled: >-\n      not tool")
    editor.type(uri, "    cancel:\n", "    cancel: [\n")
    editor.until_shown(uri, "this is not YAML")
    editor.type(uri, "executing: tool_is_running_forward", "executing: robot.")
    assert "robot.pose" in editor.options(uri, "executing: robot.")
    editor.close(uri)


RUN = "    title: {en: Run the nutrunner, sv: Kör mutterdragaren}\n"
PLACES = [
    ("resources/nutrunner.yaml", RUN, "    restart: |\n", ["true", "false"]),
    ("resources/nutrunner.yaml", RUN, "    tit|\n", ["title"]),
    (
        "resources/nutrunner.yaml",
        RUN,
        "    human:\n      |\n",
        ["task", "acknowledgement"],
    ),
    ("resources/nutrunner.yaml", "timeouts: {react: 5, finish: 30}", "timeouts: {react: 5, |}", ["finish", "then"]),
    ("resources/nutrunner.yaml", "timeouts: {react: 5, finish: 30}", "timeouts: {then: |}", ["alarm", "replan"]),
    ("resources/nutrunner.yaml", "executing: tool_is_running_forward", "executing: tool_is_i|", ["tool_is_idle"]),
    (
        "resources/nutrunner.yaml",
        "executing: tool_is_running_forward",
        "executing: robot.pose == |",
        ["home", "bolt_pair_1"],
    ),
    ("resources/nutrunner.yaml", "executing: tool_is_running_forward", 'executing: "robot.p|', ["robot.pose"]),
    (
        "resources/nutrunner.yaml",
        "do: [run_tool_forward := true, set_tool_idle := false]",
        "do: [run_tool|",
        ["run_tool_forward"],
    ),
    (
        "resources/nutrunner.yaml",
        "      (bolts[bolt_pair_1] == placed",
        "      (bolts[bolt_pair_1] == |",
        ["empty", "placed"],
    ),
    ("resources/nutrunner.yaml", "direction: in", "direction: |", ["in", "out"]),
    (
        "resources/nutrunner.yaml",
        "type: truck_engine_msgs/msg/NutrunnerState",
        "type: truck_engine|",
        ["truck_engine_msgs/msg/NutrunnerState"],
    ),
    ("resources/nutrunner.yaml", "priority: high", "priority: |", ["high", "medium", "low"]),
    (
        "resources/nutrunner.yaml",
        "    when: tool_is_running_forward and not",
        "    when: tool_is_run|",
        ["tool_is_running_forward"],
    ),
    ("resources/operator.yaml", "parameters: {pair: bolt_pair}", "parameters: {pair: |}", ["bolt_pair", "pose"]),
    ("resources/operator.yaml", "acknowledgement: acknowledged", "acknowledgement: ack|", ["acknowledged"]),
    ("resources/operator.yaml", "enabled: bolts[pair] == empty", "enabled: bolts[pair] == pl|", ["placed"]),
    ("resources/operator.yaml", "do: [requested_pair := pair]", "do: [requested_pair := |]", ["pair"]),
    (
        "resources/operator.yaml",
        "acknowledged: {type: bool, initial: false",
        "acknowledged: {type: |",
        ["bool", "pose"],
    ),
    (
        "resources/operator.yaml",
        "title: {en: Operator",
        "|\ntitle: {en: Operator",
        ["services", "flows"],
    ),
    ("station.yaml", "\nrest: >-\n", "\nrest: robot.po|\nx: >-\n", ["robot.pose"]),
    ("operations.yaml", "  goal:", "  prio|\n  goal:", ["priority"]),
    ("operations.yaml", "new_engine:\n", "all: {alternative: [new|]}\nnew_engine:\n", ["new_engine"]),
    (
        "operations.yaml",
        "new_engine:\n",
        "all: {sequence: [{parallel: pl|}]}\nnew_engine:\n",
        ["place_bolt_pair(bolt_pair_1)"],
    ),
    ("operations.yaml", "new_engine:\n", "all:\n  arb|\nnew_engine:\n", ["arbitrary"]),
    ("work_masters.yaml", "  operations:\n", "  parallel: [ti|]\n  operations:\n", ["tighten_bolt_pair(bolt_pair_1)"]),
    ("operations.yaml", "  goal:", "  goal: bolts[|\n  xx:", ["bolts[bolt_pair_1]"]),
    ("specifications.yaml", "  never:", "  |\n  never:", ["exclusive", "zone"]),
    ("specifications.yaml", "  never:", "  zone:\n    rob|\n  never:", ["robot"]),
    ("specifications.yaml", "  never:", "  exclusive: [robot.|]\n  never:", ["robot.move_to_position"]),
    ("work_masters.yaml", "bolts[bolt_pair_1] := empty", "bolts[bolt_pair_1] := |", ["empty"]),
    (
        "work_masters.yaml",
        "{after: [place_bolt_pair(bolt_pair_1)]}",
        "{after: [place|]}",
        ["place_bolt_pair(bolt_pair_2)"],
    ),
    ("work_masters.yaml", "    new_engine:\n", "    prep|\n    new_engine:\n", ["prepare_planning_scene"]),
]


@pytest.mark.parametrize(("file", "old", "new", "offered"), PLACES, ids=[f"{each[0]}: {each[2]!r}" for each in PLACES])
def test_what_can_stand_there(editor: Editor, station: Path, file: str, old: str, new: str, offered: list[str]) -> None:
    uri = editor.open(station / file)
    assert old in editor.text(uri)
    before, _, behind = new.partition("|")
    editor.type(uri, old, before + behind)
    index = editor.text(uri).index(before + behind) + len(before)
    mark = editor.text(uri)[:index]
    found = editor.options(uri, mark)
    assert set(offered) <= set(found)
    editor.close(uri)


def test_an_option_takes_the_place_of_what_is_typed(editor: Editor, station: Path) -> None:
    """Also in a text that is folded, behind letters that take two units of UTF-16."""
    uri = editor.open(station / "resources" / "nutrunner.yaml")
    editor.type(uri, RUN.strip(), "title: 𝔫𝔲𝔱 ")
    editor.type(
        uri,
        "      not tool_is_running_forward and tool_is_idle and",
        "      not tool_is_running_forward and tool_is_i and",
    )
    found = editor.ask("textDocument/completion", **editor.at(uri, "forward and tool_is_i"))
    option = next(each for each in found["items"] if each["label"] == "tool_is_idle")
    editor.apply({"changes": {uri: [option["textEdit"]]}})
    assert "      not tool_is_running_forward and tool_is_idle and set_tool_idle and\n" in editor.text(uri)
    editor.close(uri)


def test_what_a_name_is_told(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "resources" / "nutrunner.yaml")
    found = editor.ask("textDocument/hover", **editor.at(uri, "robot.pose == bolt_pair_1", 8))
    assert found["contents"]["value"].startswith("**measured** `robot.pose`: `{unknown, home, above_engine")
    assert "declared in resources/robot.yaml:" in found["contents"]["value"]
    start, end = (found["range"][each]["character"] for each in ("start", "end"))
    line = editor.text(uri).split("\n")[found["range"]["start"]["line"]]
    assert line[start:end] == "robot.pose"
    key = editor.ask("textDocument/hover", **editor.at(uri, "    executing:", 6))
    told = "`executing`: It is under way; where that is something else than what `until` says."
    assert key["contents"]["value"] == told
    assert editor.ask("textDocument/hover", **editor.at(uri, "# The command and", 4)) is None
    editor.close(uri)


def test_a_condition_in_its_usual_form(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "resources" / "nutrunner.yaml")
    editor.type(
        uri,
        "when: run_tool_forward and programmed_torque_reached",
        "when: (run_tool_forward)and((programmed_torque_reached))",
    )
    where = editor.at(uri, "when: (run_tool", 8)["position"]
    actions = editor.ask(
        "textDocument/codeAction",
        textDocument={"uri": uri},
        range={"start": where, "end": where},
        context={"diagnostics": [], "only": ["refactor"]},
    )
    assert [each["title"] for each in actions] == ["Write it as `run_tool_forward and programmed_torque_reached`"]
    editor.apply(actions[0]["edit"])
    assert "      when: run_tool_forward and programmed_torque_reached\n" in editor.text(uri)
    editor.close(uri)


def test_what_the_supervisor_adds(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "resources" / "robot.yaml")
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 999, "character": 0}}

    def hints() -> list[dict[str, object]]:
        return editor.ask("textDocument/inlayHint", textDocument={"uri": uri}, range=whole) or []

    until(hints, "hints of guards")
    assert "workspace/inlayHint/refresh" in editor.asked
    labels = {str(each["label"]): each for each in hints()}
    (label,) = [each for each in labels if "position" in each]
    assert label.startswith("supervisor: operator.requested_pair != position and (bolts[position] != placed or ")
    assert label.endswith("…, for all position in bolt_pair")
    tooltip = labels[label]["tooltip"]
    assert isinstance(tooltip, dict)
    lets, guard, why, *meant = tooltip["value"].split("\n\n")
    assert lets == (
        "The supervisor lets `robot.move_to_position(position)`, for all position in bolt_pair, start only while"
    )
    assert guard.endswith("nutrunner.run_nut.executing)`")
    assert why == "because of `no_standing_tool_on_placed_bolts(position)`"
    assert len(meant) == 3
    assert meant[1].startswith(
        "`robot.move_to_position(bolt_pair_2)`: `operator.requested_pair != bolt_pair_2 and (bolts[bolt_pair_2] != "
    )
    position = labels[label]["position"]
    assert isinstance(position, dict)
    lines = editor.text(uri).split("\n")
    assert lines[position["line"]].strip().startswith("start:")
    assert position["character"] == len(lines[position["line"]])
    editor.tell("workspace/didChangeConfiguration", settings={"sequencePlanner": {"supervisorHints": False}})
    assert hints() == []
    editor.tell("workspace/didChangeConfiguration", settings={"sequencePlanner": {"supervisorHints": True}})
    assert hints()
    editor.close(uri)


def _asked(editor: Editor, uri: str, mark: str, **context: object) -> list[dict[str, Any]]:
    """The actions that rewrite what stands at a mark."""
    position = editor.at(uri, mark, 0)["position"]
    found = editor.ask(
        "textDocument/codeAction",
        textDocument={"uri": uri},
        range={"start": position, "end": position},
        context={"diagnostics": [], **context},
    )
    return [each for each in found if each["kind"] == "refactor.rewrite"]


def test_what_can_be_said_shorter_is_offered_where_it_is_written(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "operations.yaml")
    other = editor.open(station / "resources" / "engine.yaml")
    actions = {each["title"]: each for each in _asked(editor, uri, "bolts[bolt_pair_2] == tightened", triggerKind=1)}
    assert actions.keys() == {
        "Write `all pair in bolt_pair: bolts[pair] == tightened`",
        "Name a predicate `all_tightened`, in 2 places",
    }
    editor.apply(actions["Name a predicate `all_tightened`, in 2 places"]["edit"])
    assert "bolts[bolt_pair_2] == tightened" not in editor.text(uri) + editor.text(other)
    assert "enabled: all_tightened\n" in editor.text(other)
    named = editor.open(station / "station.yaml")
    editor.until_clean(named)
    editor.until_clean(uri)
    editor.close(uri)
    editor.close(other)
    editor.close(named)


def test_a_type_of_resources_alike_is_a_file_of_its_own(editor: Editor, robots: Path) -> None:
    shutil.rmtree(robots / "types")
    for written in (TESTS / "model" / "written_out").glob("*.yaml"):
        shutil.copy(written, robots / "resources")
    uri = editor.open(robots / "resources" / "robot_1.yaml")
    actions = {each["title"]: each for each in _asked(editor, uri, "part_on_conveyor", triggerKind=1)}
    editor.apply(actions["Make `robot_1` and `robot_2` instances of a type `robot`"]["edit"])
    assert "type: robot\n" in editor.text(uri)
    assert (robots / "resources" / "robot_2.yaml").read_text(encoding="utf-8").count("type: robot\n") == 1
    type_ = editor.open(robots / "types" / "robot.yaml")
    assert "parameters:\n" in editor.text(type_)
    editor.until_clean(type_)
    editor.until_clean(uri)
    editor.close(type_)
    editor.close(uri)


def test_a_lamp_beside_a_line_does_not_wait_for_proofs(editor: Editor, station: Path) -> None:
    uri = editor.open(station / "operations.yaml")
    assert _asked(editor, uri, "bolts[bolt_pair_2] == tightened", triggerKind=2) == []
    assert _asked(editor, uri, "bolts[bolt_pair_2] == tightened", triggerKind=1, only=["quickfix"]) == []
    assert _asked(editor, uri, "title:", triggerKind=1) == []
    editor.type(uri, "bolts[bolt_pair_2] == tightened", "bolts[bolt_pair_2] == tight")
    assert _asked(editor, uri, "bolts[bolt_pair_1] == tightened", triggerKind=1) == []
    editor.close(uri)
