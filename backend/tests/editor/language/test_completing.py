"""What can be written at a place of a text: above all what people did write there."""

from __future__ import annotations

import pytest

from sequence_planner.editor.language.completion import MOST_OPTIONS, Completion, complete
from sequence_planner.editor.language.field import FieldKind
from sequence_planner.editor.language.quantifiers import QuantifierPart, quantifiers_before
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.scope import Lexicon
from sequence_planner.language.lexer import tokens
from sequence_planner.language.parser import can_go_on
from sequence_planner.model.yaml.reader import EntryPath

from .drafts import STATIONS, Text, draft

ENABLED: EntryPath = ("abilities", "run_nut", "enabled")
TOOL, ROBOT = "resources/nutrunner.yaml", "resources/robot.yaml"
EXPRESSIONS = (FieldKind.CONDITION, FieldKind.FORMULA, FieldKind.ACTION)


def at_mark(file: str, path: EntryPath, marked: str, lexicon: Lexicon | None = None) -> Completion:
    """What can be written at the `|`."""
    lexicon = lexicon or draft("bolt_tightening").lexicon
    field = lexicon.field(file, path)
    assert field is not None
    before, _, behind = marked.partition("|")
    return complete(lexicon, field, before + behind, len(before))


def inserts(completion: Completion) -> list[str]:
    return [option.insert for option in completion.options]


def written_there(lexicon: Lexicon, each: Text, text: str, start: int, end: int) -> str | None:
    """What of the options at `start` of a text cut off there is what stands there, up to `end` at least."""
    found = complete(lexicon, each.field, text[:start], start)
    assert len(found.options) <= MOST_OPTIONS
    assert found.start <= found.end == start
    fitting = (insert for insert in inserts(found) if found.start + len(insert) >= end)
    return next((insert for insert in fitting if text[found.start :].startswith(insert)), None)


@pytest.mark.parametrize("station", STATIONS)
def test_every_word_of_a_station_is_among_the_options_where_it_stands(station: str) -> None:
    drafted = draft(station)
    different = {(each.field.kind, each.field.resource, each.text): each for each in drafted.texts}
    for each in different.values():
        if each.field.kind in EXPRESSIONS:
            written = tokens(each.text)[:-1]
            for number, token in enumerate(written):
                if quantifiers_before(written[:number]).expected is QuantifierPart.WORD:
                    continue  # people choose these
                assert written_there(drafted.lexicon, each, each.text, token.start, token.end), (
                    f"{each}: {each.text[: token.start]}‹{token.text}›"
                )
        elif ".." not in each.text:
            field = each.field
            assert each.text in inserts(complete(drafted.lexicon, field, "", 0)), str(each)
            assert each.text == inserts(complete(drafted.lexicon, field, each.text, len(each.text)))[0], str(each)


@pytest.mark.parametrize("station", STATIONS)
def test_what_is_inserted_leaves_a_text_that_can_be_read_on(station: str) -> None:
    drafted = draft(station)
    for each in drafted.texts[::7]:
        if each.field.kind not in EXPRESSIONS:
            continue
        for token in tokens(each.text)[:-1:3]:
            found = complete(drafted.lexicon, each.field, each.text[: token.start], token.start)
            for insert in inserts(found)[::5]:
                kind, text = each.field.kind, each.text[: found.start] + insert
                assert can_go_on(text, kind is FieldKind.ACTION, kind is FieldKind.FORMULA), (str(each), insert)


def test_in_place_of_a_name_stands_another() -> None:
    text = "tool_is_idle and robot.pose == home"
    for marked, start, end in (
        ("|tool_is_idle and robot.pose == home", 0, 12),
        ("tool|_is_idle and robot.pose == home", 0, 12),
        ("tool_is_idle and ro|bot.pose == home", 17, 27),
        ("tool_is_idle and robot.po|se == home", 17, 27),
        ("tool_is_idle and robot.pose == |home", 31, 35),
        ("tool_is_idle |and robot.pose == home", 13, 16),
        ("tool_is_idle and robot.pose| == home", 17, 27),
    ):
        found = at_mark(TOOL, ENABLED, marked)
        assert (found.start, found.end) == (start, end)
        assert text[start:end] in inserts(found), marked
    found = at_mark(TOOL, ENABLED, "bolts[bolt|_pair_1] == placed")
    assert (found.start, found.end) == (0, 18)
    assert inserts(found)[:3] == ["bolts[bolt_pair_1]", "bolts[bolt_pair_2]", "bolts[bolt_pair_3]"]


@pytest.mark.parametrize(
    ("text", "first"),
    [
        ("", ["enabled", "executing", "finished", "tool_is_idle", "tool_is_running_forward"]),
        ("robot.pose == ", ["unknown", "home", "above_engine", "bolt_pair_1", "bolt_pair_2", "bolt_pair_3"]),
        ("robot.pose != ab", ["above_engine"]),
        ("robot.pose in {", ["unknown", "home"]),
        ("robot.pose in {home, ab", ["above_engine"]),
        ("robot.pose in {home, above_engine", ["above_engine", "above_engine}", "above_engine,"]),
        ("robot.pose ", ["==", "!=", "in"]),
        ("tool_is_idle ", ["and", "or", "implies", "==", "!="]),
        ("robot.pose == home ", ["and", "or", "implies"]),
        ("robot.pose == robot.tar", ["robot.target_pose"]),
        ("forw", ["tool_is_running_forward", "run_tool_forward"]),
        ("not ", ["enabled", "executing"]),
        ("(tool_is_idle", ["tool_is_idle", "tool_is_idle)"]),
        ("robot.move_to_position(ab", ["robot.move_to_position(above_engine).enabled"]),
        ("robot.move_to_previous.", ["robot.move_to_previous.enabled"]),
        ("operation.", ["operation.place_bolt_pair(bolt_pair_1).active"]),
        ("ROBOT.MOV", ["robot.moving"]),
    ],
)  # fmt: skip
def test_what_fits_the_place_comes_first(text: str, first: list[str]) -> None:
    assert inserts(at_mark(TOOL, ENABLED, text + "|"))[: len(first)] == first


def test_a_parameter_stands_for_its_values() -> None:
    place = ("abilities", "place_bolt_pair", "enabled")
    file = "resources/operator.yaml"
    assert inserts(at_mark(file, place, "bolts[|"))[0] == "bolts[pair]"
    assert "pair" in inserts(at_mark(file, place, "requested_pair == |"))
    assert "pair" not in inserts(at_mark(file, place, "robot.moving == |"))
    assert "pair" not in inserts(at_mark(file, place, "bolts[pair] == |"))
    [option] = [each for each in at_mark(file, place, "requested_pair == pa|").options if each.label == "pair"]
    assert option.kind is NameKind.PARAMETER


@pytest.mark.parametrize(
    ("path", "kinds"),
    [
        (("start", "do", 0), {NameKind.OUTPUT, NameKind.ESTIMATED}),
        (("cancel", "do", 0), {NameKind.OUTPUT, NameKind.ESTIMATED}),
        (("effects", "tool_starts", "do", 0), {NameKind.MEASURED}),
    ],
)
def test_an_action_is_on_what_may_be_written_there(path: EntryPath, kinds: set[NameKind]) -> None:
    found = at_mark(TOOL, ("abilities", "run_nut", *path), "|")
    assert {each.kind for each in found.options} - {NameKind.RESOURCE, NameKind.KEYWORD} == kinds
    assert [each.insert for each in found.options if each.kind is NameKind.KEYWORD] == ["all"]
    assert inserts(at_mark(TOOL, ("abilities", "run_nut", *path), "tool_is_idle |")) == [":="]


def test_an_action_writes_values_of_its_variable() -> None:
    place = ("abilities", "run_nut", "start", "do", 0)
    assert inserts(at_mark(TOOL, place, "bolts[bolt_pair_1] := |"))[:3] == ["empty", "placed", "tightened"]
    assert inserts(at_mark(TOOL, place, "bolts[bolt_pair_1] := empty |")) == ["if"]
    assert {"true", "false", "not", "tool_is_idle"} <= set(inserts(at_mark(TOOL, place, "set_tool_idle := |")))


def test_letters_are_operators_in_formulas_only() -> None:
    assert {"F", "G", "X", "N"} <= set(inserts(at_mark("operations.yaml", ("new_engine", "local"), "|")))
    assert "U" in inserts(at_mark("operations.yaml", ("new_engine", "local"), "robot.moving |"))
    assert inserts(at_mark("operations.yaml", ("new_engine", "local"), "F (robot.mov|"))[0] == "robot.moving"
    assert "F" not in inserts(at_mark("operations.yaml", ("new_engine", "goal"), "|"))


@pytest.mark.parametrize("text", ["robot.pose = home and |", "&& |", "robot.pose == home) or |", "tool_is_idle # |"])
def test_names_are_offered_behind_mistakes_too(text: str) -> None:
    assert "tool_is_idle" in inserts(at_mark(TOOL, ENABLED, text))


@pytest.mark.parametrize(
    ("file", "path", "text", "first"),
    [
        (ROBOT, ("measured", "pose", "type"), "", ["bool", "bolt_pair", "bolt_state", "named_pose"]),
        (ROBOT, ("measured", "pose", "type"), "pose", ["pose", "named_pose"]),
        (ROBOT, ("measured", "pose", "initial"), "", ["unknown", "home"]),
        (ROBOT, ("abilities", "a", "parameters", "b"), "", ["bolt_pair", "bolt_state"]),
        (ROBOT, ("abilities", "a", "human", "acknowledgement"), "", ["moving", "tool_is_attached"]),
        ("specifications.yaml", ("a", "exclusive", 0), "nut", ["nutrunner.run_nut"]),
        ("specifications.yaml", ("a", "exclusive", 0), "robot.move", ["robot.move_to_position"]),
        ("work_masters.yaml", ("truck_engine", "operations", ""), "", ["place_bolt_pair(bolt_pair_1)"]),
        ("work_masters.yaml", ("truck_engine", "operations", "new_engine", "after", 0), "new", []),
    ],
)  # fmt: skip
def test_where_one_of_few_names_stands(file: str, path: EntryPath, text: str, first: list[str]) -> None:
    found = inserts(at_mark(file, path, text + "|"))
    assert (found[: len(first)] == first) if first else not found or found[0] != "new_engine"
