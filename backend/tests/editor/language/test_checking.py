"""What is found in a text is what grounding finds there."""

from __future__ import annotations

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from sequence_planner.automaton.grounding.station import ground
from sequence_planner.editor.language.service import TextProblem, check
from sequence_planner.language.syntax import Span
from sequence_planner.model.loader import Station
from sequence_planner.model.source import ModelError
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.pipelines.inference import variables_inferred
from sequence_planner.ros.types.messages import MessageRegistry
from support.examples import examples

from ..references.stations import messages_of
from .drafts import ELSEWHERE, STATIONS, Text, draft, with_text, words

KIT = "resources/robot.yaml"
TOOL = "resources/nutrunner.yaml"
START: EntryPath = ("abilities", "run_nut", "start", "do", 0)
MOVE = ("abilities", "move_to_position")


def problems(file: str, path: EntryPath, text: str, parameters: dict[str, str] | None = None) -> list[TextProblem]:
    lexicon = draft("bolt_tightening").lexicon
    field = lexicon.field(file, path, parameters)
    assert field is not None
    return list(check(lexicon, field, text))


@pytest.mark.parametrize("station", STATIONS)
def test_nothing_is_found_in_the_texts_of_a_station_that_grounds(station: str) -> None:
    drafted = draft(station)
    assert len(drafted.texts) > 45
    for each in drafted.texts:
        assert check(drafted.lexicon, each.field, each.text) == (), str(each)


@pytest.mark.parametrize(
    ("file", "path", "text", "start", "end", "message"),
    [
        (
            TOOL,
            START,
            "robot.pose := home",
            0,
            18,
            "a start writes output or estimated variables, and `robot.pose` is a measured variable",
        ),
        (TOOL, START, "set_tool_idle := true", 0, 21, None),
        (
            TOOL,
            (*START[:-1], 2),
            "set_tool_idle := true",
            0,
            21,
            "`nutrunner.set_tool_idle` is written twice by one transition: keep one of the two",
        ),
        (TOOL, START, "run_tool_forward = true", 17, 18, "`=` has no meaning here; write == (or := in an action)"),
        (TOOL, START, "run_tool_forward :=", 19, 19, "expected a name, a value or `(`, found the end of the text"),
        (
            TOOL,
            ("abilities", "run_nut", "effects", "tool_starts", "when"),
            "bolts[bolt_pair_1] == placed",
            0,
            18,
            "an effect depends on measured and output variables only, and `bolts[bolt_pair_1]` is neither",
        ),
        (
            KIT,
            ("abilities", "move_to_previous", "start", "do", 0),
            "target_pose := pose",
            15,
            19,
            (
                "`robot.target_pose := robot.pose` may write unknown where robot.pose == unknown, which is not "
                "in {home, above_engine, bolt_pair_1, bolt_pair_2, bolt_pair_3}: add a condition to the guard, "
                "or with `if` to the action, under which it fits"
            ),
        ),
        (KIT, (*MOVE, "start", "do", 0), "target_pose := pose", 0, 0, None),
        (
            KIT,
            (*MOVE, "enabled"),
            "pose == positon",
            8,
            15,
            "unknown variable or value `positon`; did you mean `position`?",
        ),
        (
            KIT,
            (*MOVE, "parameters", "position"),
            "named_poses",
            0,
            11,
            "unknown enumeration `named_poses`; did you mean `named_pose`?",
        ),
        (
            KIT,
            ("measured", "pose", "type"),
            "poses",
            0,
            5,
            "unknown type `poses`: write bool, a range such as 0..3, or an enumeration; did you mean `pose`?",
        ),
        (
            KIT,
            ("measured", "pose", "initial"),
            "hom",
            0,
            3,
            (
                "`hom` is no initial value of `robot.pose`, which ranges over {unknown, home, above_engine, "
                "bolt_pair_1, bolt_pair_2, bolt_pair_3}; did you mean `home`?"
            ),
        ),
        (
            "resources/operator.yaml",
            ("abilities", "place_bolt_pair", "human", "acknowledgement"),
            "requested_pair",
            0,
            14,
            "`requested_pair` must be a measured bool of `operator`",
        ),
        (
            "specifications.yaml",
            ("new", "exclusive", 0),
            "robot.move",
            0,
            10,
            "there is no ability `robot.move`; did you mean `robot.move_to_previous`?",
        ),
        (
            "specifications.yaml",
            ("new", "zone", "robot"),
            "pse == home",
            0,
            3,
            "unknown variable `pse`; did you mean `pose`?",
        ),
        (
            "specifications.yaml",
            ("new", "order", 0),
            "robot.pose == hme",
            14,
            17,
            "unknown variable or value `hme`; did you mean `home`?",
        ),
        ("operations.yaml", ("new_engine", "local"), "X (robot.moving) U", 18, 18, None),
        (
            "operations.yaml",
            ("new_engine", "goal"),
            "F robot.moving",
            0,
            14,
            (
                "`F` is a temporal operator here: temporal operators stand only in `local` formulas of "
                "operations and in goals of plain automata"
            ),
        ),
        ("work_masters.yaml", ("truck_engine", "brings", 0), "bolts[bolt_pair_2] := empty", 0, 0, None),
        (
            "work_masters.yaml",
            ("truck_engine", "operations", "new_engine"),
            "new_engin",
            0,
            9,
            "there is no operation `new_engin`; did you mean `new_engine`?",
        ),
        (
            "work_masters.yaml",
            ("truck_engine", "operations", "new_engine", "after", 0),
            "new_engin",
            0,
            9,
            "`new_engin` is no operation of this job; did you mean `new_engine`?",
        ),
        (
            "station.yaml",
            ("rest",),
            "robot.pose == home and",
            22,
            22,
            "expected a name, a value or `(`, found the end of the text",
        ),
    ],
)
def test_each_field_has_the_checks_of_grounding(
    file: str, path: EntryPath, text: str, start: int, end: int, message: str | None
) -> None:
    found = problems(file, path, text)
    if message is not None:
        assert found == [TextProblem(start, end, message)]
    else:
        agrees("bolt_tightening", file, path, text)


def test_a_problem_of_all_choices_of_a_parameter_is_one_problem() -> None:
    assert len(problems(KIT, (*MOVE, "enabled"), "positoin == home")) == 1


def test_what_is_wrong_for_one_choice_of_a_parameter_is_found() -> None:
    [problem] = problems("operations.yaml", ("new", "goal"), "bolts[pose] == empty", {"pose": "named_pose"})
    assert (problem.start, problem.end) == (0, 11)


def test_a_new_ability_sees_its_flags_and_the_parameters_it_is_given() -> None:
    path = ("abilities", "go", "finish", "when")
    assert problems(KIT, path, "executing and pose == where", {"where": "pose"}) == []
    assert problems(KIT, path, "executing and pose == where") != []
    assert problems("resources/new.yaml", path, "executing and robot.pose == where", {"where": "pose"}) == []


def test_no_names_stand_in_titles_and_messages() -> None:
    lexicon = draft("bolt_tightening").lexicon
    for file, path in (
        ("station.yaml", ("title",)),
        (KIT, ("topics", "/ur10/state", "type")),
        (KIT, ("abilities", "move_to_position", "timeouts", "react")),
        ("README.md", ("a",)),
        ("resources/robot.yaml", ()),
        ("other/robot.yaml", ("abilities", "a", "enabled")),
    ):
        assert lexicon.field(file, path) is None


def test_it_works_where_the_draft_does_not_ground() -> None:
    lexicon = draft("bolt_tightening").lexicon
    broken, _ = with_text(draft("bolt_tightening").station, "station.yaml", ("estimated", "bolts", "type"), "nothing")
    other = type(lexicon).of(broken)
    field = other.field(TOOL, ("abilities", "run_nut", "executing"))
    assert field is not None
    assert check(other, field, "bolts[bolt_pair_1] == placed and tool_is_idle") == ()
    assert check(other, field, "tool_is_idl") != ()


_REGISTRIES: dict[str, MessageRegistry] = {}


def grounded(station: Station) -> list[tuple[object, str]]:
    """What grounding finds in the text in question."""
    registry = _REGISTRIES.setdefault(station.folder.name, messages_of(station.folder))
    try:
        ground(variables_inferred(station, registry)[0])
    except ModelError as error:
        return [(each.place, each.message) for each in error.findings if each.place.file == ELSEWHERE]
    return []


def agrees(station: str, file: str, path: EntryPath, text: str) -> None:
    drafted = draft(station)
    field = drafted.lexicon.field(file, path)
    assert field is not None
    changed, put = with_text(drafted.station, file, path, text)
    found = check(drafted.lexicon, field, text)
    assert {(put.at(Span(each.start, each.end)), each.message) for each in found} == set(grounded(changed)), text


@st.composite
def mutated(draw: st.DrawFn, station: str) -> tuple[Text, str]:
    """A text of a station, and one in which some words are missing, twice, exchanged or others."""
    drafted = draft(station)
    each = draw(st.sampled_from(drafted.texts))
    pool = [*words(draw(st.sampled_from(drafted.texts)).text), "==", "and", "U", "F", ")", "1", "tru", ":=", "if", "#"]
    found = words(each.text)
    for _ in range(draw(st.integers(1, 2))):
        at = draw(st.integers(0, len(found) - 1))
        change = draw(st.integers(0, 4))
        if change == 0 and len(found) > 1:
            del found[at]
        elif change == 1:
            found.insert(at, draw(st.sampled_from(pool)))
        elif change == 2:
            other = draw(st.integers(0, len(found) - 1))
            found[at], found[other] = found[other], found[at]
        elif change == 3 and len(found[at]) > 2:
            letter = draw(st.integers(0, len(found[at]) - 1))
            found[at] = found[at][:letter] + found[at][letter + 1 :]
        else:
            found[at] = draw(st.sampled_from(pool))
    return each, " ".join(found)


@pytest.mark.parametrize("station", STATIONS)
def test_a_text_with_mistakes_is_found_fault_with_as_by_grounding(station: str) -> None:
    @examples(60)
    @given(mutated(station))
    def law(case: tuple[Text, str]) -> None:
        each, text = case
        assume(text[0] not in "|>")  # as the first letter of what is put into a draft, that is the style of a text
        agrees(station, each.file, each.path, text)

    law()
