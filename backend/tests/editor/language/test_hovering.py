"""What a name of a text is."""

from __future__ import annotations

import pytest

from sequence_planner.editor.language.field import FieldKind
from sequence_planner.editor.language.hover import Hover, hover
from sequence_planner.editor.language.schemas import HoverView, NameKind
from sequence_planner.editor.language.service import hover_view
from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import usages
from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.language.types import BOOLEAN, Place
from sequence_planner.model.yaml.reader import EntryPath

from ..references.stations import of_folder
from .drafts import MODELS, STATIONS, draft, words

ROBOT, TOOL = "resources/robot.yaml", "resources/nutrunner.yaml"
MOVE: EntryPath = ("abilities", "move_to_position", "finish", "when")


def hovered(file: str, path: EntryPath, marked: str) -> Hover | None:
    lexicon = draft("bolt_tightening").lexicon
    field = lexicon.field(file, path)
    assert field is not None
    before, _, behind = marked.partition("|")
    return hover(lexicon, field, before + behind, len(before))


@pytest.mark.parametrize(
    ("file", "path", "text", "kind", "pattern", "place"),
    [
        (ROBOT, MOVE, "po|se == position", NameKind.MEASURED, "robot.pose", (ROBOT, 46, 3)),
        (ROBOT, MOVE, "robot.pose| == position", NameKind.MEASURED, "robot.pose", (ROBOT, 46, 3)),
        (ROBOT, MOVE, "pose == |position", NameKind.PARAMETER, "position", (ROBOT, 90, 18)),
        (ROBOT, MOVE, "pose == ho|me", NameKind.VALUE, "home", ("station.yaml", 20, 14)),
        (ROBOT, MOVE, "|executing", NameKind.FLAG, "robot.move_to_position(position).executing", (ROBOT, 101, 16)),
        (
            ROBOT,
            MOVE,
            "robot.move_to_position(position).exec|uting",
            NameKind.FLAG,
            "robot.move_to_position(position).executing",
            (ROBOT, 101, 16),
        ),
        (ROBOT, MOVE, "move_to_position(pos|ition).executing", NameKind.PARAMETER, "position", (ROBOT, 90, 18)),
        (ROBOT, MOVE, "bolts[bolt_pair|_1] == empty", NameKind.VALUE, "bolt_pair_1", ("station.yaml", 10, 14)),
        (
            ROBOT,
            MOVE,
            "bol|ts[bolt_pair_1] == empty and and",
            NameKind.ESTIMATED,
            "bolts[bolt_pair_1]",
            ("station.yaml", 30, 3),
        ),
        (
            ROBOT,
            MOVE,
            "oper|ation.new_engine.active",
            NameKind.ACTIVITY,
            "operation.new_engine.active",
            ("operations.yaml", 15, 1),
        ),
        (ROBOT, ("measured", "pose", "type"), "po|se", NameKind.ENUMERATION, "pose", ("station.yaml", 23, 3)),
        (ROBOT, ("measured", "pose", "initial"), "ho|me", NameKind.VALUE, "home", ("station.yaml", 24, 23)),
        (
            "specifications.yaml",
            ("a", "exclusive", 0),
            "robot.move_to_position|",
            NameKind.ABILITY,
            "robot.move_to_position",
            (ROBOT, 88, 3),
        ),
        (
            "work_masters.yaml",
            ("truck_engine", "operations", "new_engine"),
            "new|_engine",
            NameKind.OPERATION,
            "new_engine",
            ("operations.yaml", 15, 1),
        ),
        (
            "resources/operator.yaml",
            ("abilities", "place_bolt_pair", "human", "acknowledgement"),
            "ackn|owledged",
            NameKind.MEASURED,
            "operator.acknowledged",
            ("resources/operator.yaml", 12, 3),
        ),
    ],
)
def test_a_name_is_known_with_its_kind_and_place(
    file: str, path: EntryPath, text: str, kind: NameKind, pattern: str, place: tuple[str, int, int]
) -> None:
    found = hovered(file, path, text)
    assert found is not None
    assert (found.kind, found.pattern, found.place) == (kind, pattern, Place(*place))
    view = hover_view(found)
    assert view.declared is not None
    assert view.declared.file == place[0]
    assert HoverView.model_validate_json(view.model_dump_json()) == view


def test_a_reference_through_a_parameter_is_a_family() -> None:
    found = hovered("operations.yaml", ("place_bolt_pair", "goal"), "bolts|[pair] == placed")
    assert found is not None
    assert (found.start, found.end, found.name, found.pattern) == (0, 11, "bolts[pair]", "bolts[pair]")
    assert found.names == ("bolts[bolt_pair_1]", "bolts[bolt_pair_2]", "bolts[bolt_pair_3]")
    assert (str(found.type), found.initial, found.resource) == ("{empty, placed, tightened}", "empty", None)


def test_the_flag_of_a_new_ability_is_known() -> None:
    found = hovered(ROBOT, ("abilities", "new", "finish", "when"), "exe|cuting")
    assert found is not None
    assert (found.kind, found.names, found.type) == (NameKind.FLAG, ("robot.new.executing",), BOOLEAN)


@pytest.mark.parametrize("text", ["|", "tru|e", "pose |== home", "n|ot moving", "no|thing == home", "pose =|= 3", "3|"])
def test_nothing_is_said_of_what_is_no_name(text: str) -> None:
    assert hovered(ROBOT, MOVE, text) is None


@pytest.mark.parametrize("station", STATIONS)
def test_every_name_of_a_station_is_known(station: str) -> None:
    drafted = draft(station)
    for each in drafted.texts:
        at = 0
        for word in words(each.text):
            at = each.text.index(word, at)
            found = hover(drafted.lexicon, each.field, each.text, at)
            is_word = word.isidentifier() and word not in (*KEYWORDS, "where", "F")
            if is_word and each.field.kind is not FieldKind.TYPE:
                assert found is not None, f"{each}: {word} in {each.text}"
                assert found.start <= at < found.end
            at += len(word)


@pytest.mark.parametrize(
    ("file", "path", "text", "part"),
    [
        (ROBOT, MOVE, "po|se == position", "variable:robot.pose"),
        (ROBOT, MOVE, "bol|ts[bolt_pair_1] == empty", "variable:bolts"),
        (ROBOT, MOVE, "|executing", "ability:robot.move_to_position"),
        (ROBOT, MOVE, "operation.place_bolt_pair(bolt_pair_1).act|ive", "operation:place_bolt_pair"),
        (ROBOT, MOVE, "bolts[bolt_pair_1] == pla|ced", "value:bolt_state.placed"),
        (ROBOT, ("measured", "pose", "type"), "po|se", "enumeration:pose"),
        ("specifications.yaml", ("a", "exclusive", 0), "robot.move_to_position|", "ability:robot.move_to_position"),
        ("work_masters.yaml", ("truck_engine", "operations", "new_engine"), "new|_engine", "operation:new_engine"),
    ],
)
def test_a_name_can_be_looked_for(file: str, path: EntryPath, text: str, part: str) -> None:
    found = hovered(file, path, text)
    assert found is not None
    assert found.part == part
    files = of_folder(MODELS / "bolt_tightening")
    assert any(each.declares for each in usages(files, parse_part(part)).found)
