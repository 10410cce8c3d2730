"""Conditions as sentences: what people read says what is meant, in words alone."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.automaton.automaton import Ability, Automaton, Flag, Kind, Operation, State, VariableDeclaration
from sequence_planner.automaton.lifting.sentences import Sentences, sentences_of
from sequence_planner.core.immutable import replace
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_formula
from sequence_planner.language.resolver import resolve_formula, resolve_predicate
from sequence_planner.language.shorthand.titles import Titles, VariableTitles
from sequence_planner.language.shorthand.vocabulary import NamedPredicate, Vocabulary
from sequence_planner.language.syntax import FALSE, TRUE, And, Expression, Variable, conjuncts
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type
from sequence_planner.texts.message import Message, Sentence, message, waits_in_one
from sequence_planner.texts.names import in_words
from support.examples import examples

from .choices import Choices, made_by
from .random_expressions import predicate
from .random_stations import automaton as random_automaton

PAIR = EnumerationType(tuple(f"AtPair{n}TCPPose" for n in range(1, 7)))
POSE = EnumerationType(("UNKNOWN", "home", "left", "right", *PAIR.values))
TOOL = EnumerationType(("none", "hook", "magnet", "vacuum"))
STATE = EnumerationType(("empty", "placed", "tightened"))
VARIABLES: dict[str, Type] = {
    **{f"bolts[{pair}]": STATE for pair in PAIR.values},
    **{f"seen[{pair}]": BOOLEAN for pair in PAIR.values},
    "robot.pose": POSE,
    "robot.target": POSE,
    "robot.ready": BOOLEAN,
    "robot.tool_is_idle": BOOLEAN,
    "arm.pose": POSE,
    "arm.tool": TOOL,
    "engine_in_place": BOOLEAN,
    "parts": IntegerRange(0, 5),
}
TITLES = Titles(
    variables={
        "bolts": VariableTitles({"": "{pair}"}, {"en": "{pair} is {value}", "sv": "skruvarna i {pair} är {value}"}),
        "robot.pose": VariableTitles(
            {"en": "Pose of the robot", "sv": "Robotens läge"}, {"en": "the robot is at {value}"}
        ),
        "robot.ready": VariableTitles({"en": "The robot", "sv": "Roboten"}, {}, {True: {"en": "ready", "sv": "redo"}}),
        "arm.tool": VariableTitles(
            {"en": "The tool of the arm"}, {"en": "{value} is at the arm", "sv": "{value} är på armen"}
        ),
        "engine_in_place": VariableTitles({"en": "The engine is in place", "sv": "Motorn är på plats"}),
        "parts": VariableTitles({"en": "Number of parts", "sv": "Antalet delar"}),
    },
    values={
        TOOL: {
            "none": {"en": "no tool", "sv": "inget verktyg"},
            "hook": {"en": "the hook", "sv": "kroken"},
        },
        PAIR: {f"AtPair{n}TCPPose": {"en": f"pair {n}", "sv": f"par {n}"} for n in range(1, 7)},
        STATE: {"placed": {"en": "placed", "sv": "på plats"}, "tightened": {"en": "tight", "sv": "åtdragna"}},
    },
    sets={
        frozenset(("left", "right")): {"en": "a dock", "sv": "en docka"},
        frozenset(("hook", "magnet", "vacuum")): {"en": "a tool", "sv": "ett verktyg"},
    },
    predicates={
        "all_tight": {"en": "All bolts are tight", "sv": "Alla skruvar är åtdragna"},
        "is_about": {"en": "The robot is about {there}", "sv": "Roboten är vid {there}"},
    },
)
RUN = Ability("robot.run", "robot", "Run it", TRUE, TRUE, (), TRUE, FALSE, None, ())
CELL = Automaton(
    name="cell",
    title="Cell",
    description="",
    resources={"robot": "Robot UR10", "arm": "Arm"},
    variables={
        name: VariableDeclaration(
            name, type_, Kind.ESTIMATED, type_.domain[0], name.partition(".")[0] if "." in name else None
        )
        for name, type_ in VARIABLES.items()
    },
    abilities={RUN.name: RUN},
    flags=tuple(Flag(f"robot.run.{which}", TRUE) for which in ("enabled", "executing", "finished")),
    vocabulary=Vocabulary(
        {"pair": PAIR, "pose": POSE, "state": STATE},
        predicates={
            each.name: each
            for each in (
                NamedPredicate("all_tight", {}, parse("all q in pair: bolts[q] == tightened")),
                NamedPredicate("is_about", {"there": PAIR}, parse("robot.pose == there or robot.target == there")),
            )
        },
    ),
    indices={"bolts": {"pair": "pair"}, "seen": {"pair": "pair"}},
    titles=TITLES,
)
SCOPE = NameScope(CELL.types, vocabulary=CELL.vocabulary)
SENTENCES = sentences_of(CELL)
SYMBOLS = re.compile(r"[=<>:{}\[\]_]|!")


def ground(text: str) -> Expression:
    """What a text means, written out."""
    return resolve_predicate(parse(text), SCOPE)


@pytest.mark.parametrize(
    ("text", "english", "swedish"),
    [
        ("bolts[AtPair4TCPPose] == placed", "pair 4 is placed", "skruvarna i par 4 är på plats"),
        ("bolts[AtPair4TCPPose] != placed", "pair 4 is not placed", "skruvarna i par 4 är inte på plats"),
        ("bolts[AtPair4TCPPose] in {placed, tightened}", "pair 4 is not empty", "skruvarna i par 4 är inte empty"),
        (
            "all p in {AtPair1TCPPose, AtPair2TCPPose, AtPair3TCPPose}: bolts[p] == tightened",
            "pairs 1 to 3 are tight",
            "skruvarna i par 1 till 3 är åtdragna",
        ),
        (
            "bolts[AtPair1TCPPose] == tightened and bolts[AtPair3TCPPose] == tightened",
            "pairs 1 and 3 are tight",
            "skruvarna i par 1 och 3 är åtdragna",
        ),
        (
            "any p in pair: bolts[p] == placed",
            "one of pairs 1 to 6 is placed",
            "minst en av skruvarna i par 1 till 6 är på plats",
        ),
        ("all p in pair: bolts[p] == tightened", "all bolts are tight", "alla skruvar är åtdragna"),
        # `All bolts are not tight` would be something else.
        ("not all_tight", "one of pairs 1 to 6 is not tight", "minst en av skruvarna i par 1 till 6 är inte åtdragna"),
        ("is_about(AtPair2TCPPose)", "the robot is about pair 2", "roboten är vid par 2"),
        ("not is_about(AtPair2TCPPose)", "the robot is not about pair 2", "roboten är inte vid par 2"),
        ("engine_in_place", "the engine is in place", "motorn är på plats"),
        ("not engine_in_place", "the engine is not in place", "motorn är inte på plats"),
        ("robot.ready", "the robot is ready", "roboten är redo"),
        ("not robot.ready", "the robot is not ready", "roboten är inte redo"),
        ("robot.tool_is_idle", "tool is idle", "”tool is idle” är sant"),
        ("not robot.tool_is_idle", "tool is not idle", "”tool is idle” är falskt"),
        ("robot.pose in {left, right}", "the robot is at a dock", "the robot is at en docka"),
        # What all values but one have in common is said rather than that it is not that one.
        ("arm.tool != none", "a tool is at the arm", "ett verktyg är på armen"),
        ("arm.tool == none", "no tool is at the arm", "inget verktyg är på armen"),
        ("arm.tool != hook", "the hook is not at the arm", "kroken är inte på armen"),
        ("arm.pose == home", "pose of arm is home", "pose hos arm är home"),
        ("parts >= 2", "number of parts is at least 2", "antalet delar är minst 2"),
        ("parts < 1", "number of parts is 0", "antalet delar är 0"),
        ("parts in {2, 3, 4}", "number of parts is from 2 to 4", "antalet delar är från 2 till 4"),
        (
            "robot.target == home implies robot.ready",
            "the robot is ready if target is home",
            "roboten är redo om target är home",
        ),
        ("robot.pose == robot.target", "pose of the robot is the same as target", "robotens läge är samma som target"),
        ("robot.run.executing", "“Run it” is under way", "”Run it” är i gång"),
        ("not robot.run.finished", "“Run it” is not finished", "”Run it” är inte klar"),
        (
            "engine_in_place and (robot.ready or parts == 1)",
            "the engine is in place, and either the robot is ready or number of parts is 1",
            "motorn är på plats, och antingen roboten är redo eller antalet delar är 1",
        ),
        ("true", "nothing is needed", "inget behövs"),
    ],
)  # fmt: skip
def test_a_condition_is_told_as_a_sentence(text: str, english: str, swedish: str) -> None:
    assert SENTENCES.tell_conditions(ground(text)).words == {"en": english, "sv": swedish}


def test_a_long_sentence_counts_what_it_leaves_out() -> None:
    text = "parts == 1 and engine_in_place and robot.ready and arm.pose == home and robot.target == left"
    said = SENTENCES.tell_conditions(ground(text)).words
    assert said["en"] == "number of parts is 1, the engine is in place, the robot is ready and 2 more"
    assert said["sv"].endswith(" och 2 till")


def test_a_formula_has_a_sentence() -> None:
    formula = resolve_formula(parse_formula("G (engine_in_place U parts == 1)"), SCOPE)
    assert SENTENCES.tell_conditions(formula).words["en"] == "always the engine is in place until number of parts is 1"


@given(st.data())
@examples(200)
def test_every_condition_has_a_sentence_of_words_alone(data: st.DataObject) -> None:
    """Also what has no title: names become words."""
    scope = [Variable(name, type_) for name, type_ in CELL.types.items()]
    condition = data.draw(made_by(lambda choices: predicate(choices, scope, 4)))
    for said in SENTENCES.tell_conditions(condition).words.values():
        assert said
        assert not SYMBOLS.search(said)
        assert "  " not in said


@given(made_by(lambda choices: _with_titles(choices, random_automaton(choices))))
@examples(100)
def test_values_of_a_variable_are_told_apart(automaton: Automaton) -> None:
    """Whatever titles somebody has thought of, also the same for several values."""
    sentences = Sentences(automaton)
    for name, type_ in automaton.types.items():
        for language in ("en", "sv"):
            told = {sentences.tell_value(name, value).words[language] for value in type_.domain}
            assert len(told) == len(type_.domain)


def _with_titles(choices: Choices, automaton: Automaton) -> Automaton:
    texts = ("one", "the other", "is it", "{value}", "All are", "Pair 1", "pair 2")

    def words() -> dict[str, str]:
        return {language: choices.pick(texts) for language in choices.different(("", "en", "sv"), 0, 3)}

    def phrase() -> dict[str, str]:
        return {"en": choices.pick(("it is {value}", "{value}", "{value} is it"))} if choices.chance(3) else {}

    titles = {
        name: VariableTitles(words(), phrase(), {value: words() for value in type_.domain if choices.chance(2)})
        for name, type_ in automaton.types.items()
    }
    return replace(automaton, titles=Titles(titles))


@given(st.data())
@examples(100)
def test_only_what_does_not_hold_is_told(data: st.DataObject) -> None:
    scope = [Variable(name, type_) for name, type_ in VARIABLES.items()]
    condition = And(tuple(data.draw(made_by(lambda c: predicate(c, scope, 1))) for _ in range(3)))
    state: State = {name: data.draw(st.sampled_from((*type_.domain, None))) for name, type_ in VARIABLES.items()}
    lacking = [part for part in conjuncts(condition) if evaluate(part, state) is not True]
    said = SENTENCES.tell_missing(condition, state, "as it is written")
    ends = bool(lacking) and all(evaluate(part, state) is False for part in lacking)
    assert said.words == SENTENCES.tell_conditions(*(lacking or [condition]), ends=ends).words
    assert str(said) == "as it is written"


def test_an_operation_says_what_is_still_missing() -> None:
    tighten = Operation(
        "tighten",
        "Tighten",
        precondition=ground("bolts[AtPair1TCPPose] == placed and engine_in_place"),
        goal=ground("bolts[AtPair1TCPPose] == tightened"),
    )

    def said(bolts: str, *, active: bool) -> str | None:
        state: State = {**CELL.initial_valuation, "bolts[AtPair1TCPPose]": bolts, "engine_in_place": True}
        told = SENTENCES.tell_operation(tighten, state, "the goal", "the precondition", active=active)
        return None if told is None else english(told)

    assert said("empty", active=False) == "waits until pair 1 is placed"
    assert said("placed", active=False) is None
    assert said("placed", active=True) == "until pair 1 is tight"
    assert said("tightened", active=False) is None


def english(told: Message) -> str:
    """A message as the page tells it in English."""
    return str(Message.__new__(Message, told.id, {name: _spoken(each) for name, each in told.arguments.items()}))


def _spoken(argument: object) -> list[str] | str:
    if isinstance(argument, Sentence):
        return argument.words["en"]
    assert isinstance(argument, list)
    return [each.words["en"] for each in argument]


def test_what_is_waited_for_is_one_sentence() -> None:
    words = {"en": "pair 4 is placed", "sv": "par 4 är på plats"}
    placed = message("waits.condition", condition=Sentence(words, "b == placed"))
    heard = message("waits.heard", resource="Robot")
    assert waits_in_one([]) is None
    assert waits_in_one([placed]) == "waits until b == placed"
    assert waits_in_one([heard]) == "waits for Robot to be heard again"
    assert waits_in_one([heard, placed]) == "waits for Robot to be heard again, and until b == placed"
    found = waits_in_one([placed])
    assert isinstance(found, Message)
    assert found.sent()["arguments"] == {"conditions": [{"words": words, "written": "b == placed"}]}


def test_numbers_that_are_names_stay_apart() -> None:
    type_ = EnumerationType(("p01", "p1", "p2"))
    cell = replace(CELL, variables={"at": VariableDeclaration("at", type_, Kind.ESTIMATED, "p1", None)}, flags=())
    told = [Sentences(cell).tell_value("at", value).words["en"] for value in type_.values]
    assert told == ["at is p 01", "at is p 1", "at is p 2"]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("AtBoltPair4TCPPose", "at bolt pair 4 TCP pose"),
        ("engine_in_place", "engine in place"),
        ("UNKNOWN", "unknown"),
        ("UR10", "UR10"),
        ("bolt_pair_1", "bolt pair 1"),
        ("_", "_"),
    ],
)
def test_a_name_becomes_words(name: str, words: str) -> None:
    assert in_words(name) == words
