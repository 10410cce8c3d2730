"""Texts of resource types are completed, checked and explained as what they are for instances."""

from __future__ import annotations

import pytest

from sequence_planner.editor.language.field import FieldKind
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.scope import Lexicon
from sequence_planner.editor.language.types.places import AskedPlace, hover_of_part, parameters_of, text_place
from sequence_planner.model.loader import load_station
from support.places import MODELS

from .drafts import draft

TYPE = "types/robot.yaml"
EXECUTING = ("abilities", "move_to", "executing")


@pytest.fixture(scope="module")
def lexicon() -> Lexicon:
    """The two robots of one type."""
    return Lexicon.of(load_station(MODELS / "robots_with_buffer"))


def place(lexicon: Lexicon, *path: str | int, file: str = TYPE) -> AskedPlace:
    found = text_place(lexicon, file, path)
    assert found is not None
    return found


def options(lexicon: Lexicon, path: tuple[str, ...], text: str) -> list[str]:
    return [each.label for each in place(lexicon, *path).completion(text, len(text)).options]


def test_a_wrong_name_is_told_where_it_is_written_behind_a_parameter(lexicon: Lexicon) -> None:
    text = "at == conveyor and target == conveyor and att == conveyor"
    (problem,) = place(lexicon, *EXECUTING).problems(text)
    assert text[problem.start : problem.end] == "att"
    assert problem.message == "unknown variable `att`; did you mean `at`?"


def test_what_is_wrong_for_one_instance_names_it(lexicon: Lexicon) -> None:
    (problem,) = place(lexicon, *EXECUTING).problems("target == outfeed")
    assert problem.message.startswith("in robot_1: ")
    assert not place(lexicon, *EXECUTING).problems("target == conveyor")


def test_names_of_the_resource_and_parameters_are_offered(lexicon: Lexicon) -> None:
    assert "at" in options(lexicon, EXECUTING, "target == conveyor and a")
    assert options(lexicon, EXECUTING, "at == conv")[0] == "conveyor"
    assert "stops" not in options(lexicon, EXECUTING, "at == st")  # an enumeration is no value
    assert options(lexicon, ("output", "target", "type"), "sto")[0] == "stops"
    assert options(lexicon, ("measured", "at", "initial"), "con") == ["conveyor"]


def test_what_is_offered_takes_the_place_of_what_is_typed(lexicon: Lexicon) -> None:
    text = "at == conveyor and targ == conveyor"
    found = place(lexicon, *EXECUTING).completion(text, text.index("targ") + 4)
    assert text[found.start : found.end] == "targ"
    found = place(lexicon, *EXECUTING).completion("conveyor == robot_1.a", 21)
    assert "conveyor == robot_1.a"[found.start : found.end] == "robot_1.a"


def test_a_parameter_is_explained_by_what_it_is_for_each_instance(lexicon: Lexicon) -> None:
    found = place(lexicon, *EXECUTING).hover("at != conveyor", 8)
    assert found is not None and found.place is not None
    assert (found.start, found.end, found.kind) == (6, 14, NameKind.PARAMETER)
    assert found.expansion == "infeed in robot_1, outfeed in robot_2"
    assert found.place.file.endswith(TYPE)
    assert found.part == "parameter:type:robot.conveyor"
    behind = place(lexicon, *EXECUTING).hover("conveyor != at", 13)
    assert behind is not None and (behind.start, behind.end, behind.part) == (12, 14, "variable:robot_1.at")


def test_arguments_are_known_by_the_parameters_of_the_type(lexicon: Lexicon) -> None:
    file = "resources/robot_2.yaml"
    assert list(map(str, parameters_of(lexicon, file))) == ["namespace", "stops", "conveyor"]
    found = place(lexicon, "arguments", "conveyor", file=file)
    assert found.field_kind is FieldKind.INITIAL
    assert [each.label for each in found.completion("", 0).options] == ["buffer", "outfeed"]
    assert text_place(lexicon, file, ("arguments", "namespace")) is None


def test_no_more_is_said_of_a_type_than_there_is(lexicon: Lexicon) -> None:
    assert text_place(lexicon, "types/none.yaml", EXECUTING) is None
    assert text_place(lexicon, TYPE, ("abilities", "move_to", "nonsense")) is None


def test_what_is_declared_is_explained_at_its_declaration(lexicon: Lexicon) -> None:
    variable = hover_of_part(lexicon, "variable", "robot_2.at")
    assert variable is not None and (variable.kind, variable.initial) == (NameKind.MEASURED, "outfeed")
    ability = hover_of_part(lexicon, "ability", "robot_1.move_to")
    assert ability is not None and ability.title == "Move to the {stop}"
    parameter = hover_of_part(lexicon, "parameter", "type:robot.stops")
    assert parameter is not None and parameter.expansion == "infeed_side in robot_1, outfeed_side in robot_2"
    short = draft("shorthand").lexicon
    predicate = hover_of_part(short, "predicate", "is_done")
    assert predicate is not None and predicate.definition is not None
    assert predicate.definition.startswith("bolts[which] == tight and (which == p1 or")
    assert predicate.expansion == "which = p1: bolts[p1] == tight"
    for kind, name in (("set", "free"), ("relation", "near"), ("map", "grip_for"), ("value", "spot.home")):
        found = hover_of_part(short, kind, name)
        assert found is not None and str(found.kind) == kind, name
    assert hover_of_part(short, "predicate", "nothing") is None
