"""What is told in the words of a model means what it is told of, and is told in them where it can be."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from sequence_planner.automaton.automaton import Automaton, Kind, VariableDeclaration
from sequence_planner.automaton.lifting.index_folding import GroundStatement, IndexFolding
from sequence_planner.automaton.lifting.normal_form import normal_form
from sequence_planner.automaton.lifting.wording import ModelWording, phrase
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse
from sequence_planner.language.resolver import resolve_predicate
from sequence_planner.language.shorthand.vocabulary import NamedPredicate, ValueRelation, Vocabulary
from sequence_planner.language.syntax import (
    And,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value
from support.examples import examples

PAIR = EnumerationType(("p1", "p2", "p3"))
POSE = EnumerationType(("unknown", "home", "a", "b", "c", "p1", "p2", "p3"))
STATE = EnumerationType(("empty", "placed", "tight"))
VARIABLES: dict[str, Type] = {
    **{f"bolts[{pair}]": STATE for pair in PAIR.values},
    **{f"robot.move({pair}).executing": BOOLEAN for pair in PAIR.values},
    "at": POSE,
    "goal": POSE,
    "robot.ready": BOOLEAN,
    "n": IntegerRange(0, 3),
}
VOCABULARY = Vocabulary(
    {"pair": PAIR, "pose": POSE, "state": STATE, "free": EnumerationType(("home", "a", "b"))},
    (),
    {
        "near": ValueRelation((POSE, POSE), frozenset(product(("home", "a", "b"), ("a", "b", "c", "p1")))),
        "beside": ValueRelation((POSE, POSE), frozenset({("a", "home"), ("c", "home"), ("p1", "home"), ("b", "a")})),
    },
    {},
    {
        each.name: each
        for each in (
            NamedPredicate("all_tight", {}, parse("all q in pair: bolts[q] == tight")),
            NamedPredicate("is_at", {"p": PAIR}, parse("at == p and goal == p")),
            NamedPredicate("robot.is_done", {}, parse("ready or n > 1"), ("robot.",)),
        )
    },
)
AUTOMATON = Automaton(
    name="cell",
    title="Cell",
    description="",
    resources={},
    variables={
        name: VariableDeclaration(name, type_, Kind.ESTIMATED, type_.domain[0], None)
        for name, type_ in VARIABLES.items()
    },
    abilities={},
    flags=(),
    vocabulary=VOCABULARY,
    indices={
        "bolts": {"of": "pair"},
        "robot.move": {"to": "pair"},
        "go": {"from": "pair", "to": "pair"},
        "specification.never": {"pair": "pair"},
    },
)
WORDING = ModelWording(AUTOMATON)
SCOPE = NameScope(VARIABLES, vocabulary=VOCABULARY)


def ground(text: str, scope: NameScope = SCOPE) -> Expression:
    """What a text means, written out."""
    return resolve_predicate(parse(text), scope)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("bolts[p1] == tight and bolts[p2] == tight and bolts[p3] == tight", "all_tight"),
        ("n == 0 and bolts[p1] == tight and bolts[p3] == tight and bolts[p2] == tight", "n == 0 and all_tight"),
        ("bolts[p1] != tight or not bolts[p2] == tight or bolts[p3] != tight or n == 0", "not all_tight or n == 0"),
        ("at == p2 and goal == p2 and n == 1", "is_at(p2) and n == 1"),
        ("not robot.ready and n <= 1 and at == c", "not robot.is_done and at == c"),
        ("(n > 1 or robot.ready) and at == c", "robot.is_done and at == c"),
        ("at in {home, b, a}", "at in free"),
        ("at == home or n == 2 or at == b or at == a", "at in free or n == 2"),
        ("not at in {home, a, b}", "not at in free"),
        ("at in {unknown, c, p1, p2, p3}", "not at in free"),
        ("at != p1 and at != p2 and at != p3", "not at in pair"),
        ("at in {home, a}", "at in {home, a}"),
        ("bolts[p1] == placed and bolts[p2] == placed and bolts[p3] == placed", "all of in pair: bolts[of] == placed"),
        (
            "bolts[p1] == placed or n == 0 or bolts[p2] == placed or bolts[p3] == placed",
            "(any of in pair: bolts[of] == placed) or n == 0",
        ),
        ("bolts[p1] == placed and bolts[p2] == placed", "bolts[p1] == placed and bolts[p2] == placed"),
        (
            "(at != p1 or robot.move(p1).executing) and (at != p2 or robot.move(p2).executing) and "
            "(at != p3 or robot.move(p3).executing)",
            "all to in pair: at != to or robot.move(to).executing",
        ),
        (" or ".join(f"at == {each} and goal == {each}" for each in POSE.values), "at == goal"),
        (" or ".join(f"at == {each} and goal in {{a, b, c, p1}}" for each in ("home", "a", "b")), "near(at, goal)"),
        ("at in {a, c, p1}", "beside(at, home)"),
        ("at in {a, b, c, p1}", "at in {a, b, c, p1}"),
    ],
)  # fmt: skip
def test_is_told_by_its_names(text: str, said: str) -> None:
    assert WORDING.in_words(ground(text)) == said


def test_nothing_is_named_without_names() -> None:
    bare = ModelWording(Automaton("cell", "Cell", "", {}, AUTOMATON.variables, {}, ()))
    text = "bolts[p1] == tight and bolts[p2] == tight and bolts[p3] == tight"
    assert bare.in_words(ground(text)) == text


def _written_atoms() -> list[Expression]:
    chance = Random(1)
    found: list[Expression] = []
    for name, type_ in VARIABLES.items():
        variable = Variable(name, type_)
        for value in map(Constant, type_.domain):
            found += [Comparison("==", variable, value), Comparison("!=", variable, value)]
        for size in range(1, len(type_.domain)):
            found.append(Membership(variable, tuple(map(Constant, chance.sample(type_.domain, size)))))
    texts = [
        "all_tight", "is_at(p1)", "is_at(p3)", "robot.is_done", "at in free", "near(at, goal)", "at == goal",
        "at != goal", "all q in pair: bolts[q] != empty", "any q in pair: bolts[q] == empty and at == q", "n + 1 < 3",
        "none q in pair: robot.move(q).executing and goal == q", "robot.ready == (n == 1)", "true", "false",
    ]  # fmt: skip
    return [*found, *map(ground, texts)]


def _conditions() -> SearchStrategy[Expression]:
    def larger(part: SearchStrategy[Expression]) -> SearchStrategy[Expression]:
        parts = st.lists(part, min_size=2, max_size=4).map(tuple)
        both = st.builds(Implies, part, part)
        return st.one_of(st.builds(And, parts), st.builds(Or, parts), st.builds(Not, part), both)

    return st.recursive(st.sampled_from(_written_atoms()), larger, max_leaves=6)


CONDITIONS = _conditions()
SEEDS = st.integers(0, 2**20)


def states(seed: int) -> list[Mapping[str, Value]]:
    """Some states, of which there are too many to look at all."""
    chance = Random(seed)
    return [{name: chance.choice(type_.domain) for name, type_ in VARIABLES.items()} for _ in range(40)]


@examples(100)
@given(CONDITIONS, SEEDS)
def test_what_is_told_means_the_same(condition: Expression, seed: int) -> None:
    told = ground(WORDING.in_words(condition))
    for state in states(seed):
        assert evaluate(told, state) == evaluate(condition, state)


@examples(100)
@given(CONDITIONS, CONDITIONS, SEEDS)
def test_conditions_of_one_normal_form_are_equal(one: Expression, other: Expression, seed: int) -> None:
    forms = [(normal_form(each), each) for each in (one, other, Not(Not(one)), And((one, other)), And((other, one)))]
    negations = [(normal_form(each, positive=False), Not(each)) for each in (one, other)]
    by_form: dict[object, list[Expression]] = {}
    for form, each in (*forms, *negations):
        by_form.setdefault(form, []).append(each)
    assert len(by_form) <= 5
    for alike in by_form.values():
        for state in states(seed):
            assert len({evaluate(each, state) for each in alike}) == 1


def test_what_lacks_is_told_by_a_predicate_or_by_the_values_it_is_not_so_for() -> None:
    state = {**{name: type_.domain[0] for name, type_ in VARIABLES.items()}, "bolts[p2]": "tight"}
    named = ground("all_tight and n == 0 and robot.ready")
    assert [phrase(part) for part in WORDING.lacking(named, state)] == ["all_tight", "robot.ready"]
    unnamed, body = ground("all q in pair: bolts[q] == placed or at == q"), "bolts[of] == placed or at == of"
    assert [phrase(part) for part in WORDING.lacking(unnamed, state)] == [f"all of in pair: {body}"]
    state |= {"bolts[p1]": "placed"}
    assert [phrase(part) for part in WORDING.lacking(unnamed, state)] == [f"all of in {{p2, p3}}: {body}"]
    state |= {"bolts[p2]": "placed"}
    assert [phrase(part) for part in WORDING.lacking(unnamed, state)] == ["bolts[p3] == placed or at == p3"]


@examples(100)
@given(CONDITIONS, SEEDS)
def test_what_lacks_is_what_keeps_it_from_being_so(condition: Expression, seed: int) -> None:
    for state in states(seed):
        lacking = list(WORDING.lacking(condition, state))
        assert bool(lacking) is (evaluate(condition, state) is not True)
        assert all(evaluate(ground(phrase(part)), state) is False for part in lacking)
        assert all(evaluate(part.condition, state) is False for part in lacking)


# Indices


def moves(text: str) -> dict[str, GroundStatement]:
    """What is said of each `robot.move`."""
    return {
        f"robot.move({pair})": GroundStatement((ground(text.replace("P", pair)),), (f"never({pair})", "always"))
        for pair in PAIR.values
    }


def test_what_is_said_of_each_value_is_said_once() -> None:
    (found,) = IndexFolding(WORDING).folded(moves("at != P and bolts[P] == tight or robot.move(P).executing"))
    assert found.title == "robot.move(to), for all to in pair"
    assert found.conditions == ("at != to and bolts[to] == tight or robot.move(to).executing",)
    assert found.names == ("never(to)", "always")
    assert found.members == tuple(f"robot.move({pair})" for pair in PAIR.values)


def test_one_that_differs_is_told_by_itself() -> None:
    statements = moves("at != P")
    statements["robot.move(p2)"] = GroundStatement((ground("at != p3"),), ("never(p2)", "always"))
    found = list(IndexFolding(WORDING).folded(statements))
    assert [(each.title, each.conditions) for each in found] == [
        ("robot.move(to), for all to in {p1, p3}", ("at != to",)),
        ("robot.move(p2)", ("at != p3",)),
    ]


@pytest.mark.parametrize(
    "other",
    [
        GroundStatement((ground("at != p2"),), ("never(p1)", "always")),
        GroundStatement((ground("at != p2"),), ("never(p2)", "always"), way="no"),
        GroundStatement((), ("never(p2)", "always")),
    ],
)
def test_only_what_is_the_same_in_all_is_told_together(other: GroundStatement) -> None:
    statements = moves("at != P") | {"robot.move(p2)": other}
    found = list(IndexFolding(WORDING).folded(statements))
    assert [each.name for each in found] == ["robot.move(to)", "robot.move(p2)"]


def test_a_value_that_is_in_all_stays() -> None:
    (found,) = IndexFolding(WORDING).folded(moves("at != p1 and goal in {p1, p2, p3}"))
    assert found.conditions == ("at != p1 and goal in pair",)


def test_two_indices() -> None:
    every = {
        f"go({one}, {other})": GroundStatement((ground(f"bolts[{one}] == tight and at != {other}"),))
        for one, other in product(PAIR.values, repeat=2)
    }
    (found,) = IndexFolding(WORDING).folded(every)
    assert found.title == "go(from, to), for all from in pair, to in pair"
    assert found.conditions == ("bolts[from] == tight and at != to",)
    different = {
        name: each for name, each in every.items() if name not in [f"go({pair}, {pair})" for pair in PAIR.values]
    }
    (found,) = IndexFolding(WORDING).folded(different)
    assert found.title == "go(from, to), for all from in pair, to in pair where from != to"


def test_texts_are_told_together_where_they_differ_in_the_value_only() -> None:
    texts = {f"robot.move({pair}).leaves": (f"at := {pair} if bolts[{pair}] == tight", "p10") for pair in PAIR.values}
    (found,) = IndexFolding(WORDING).folded_texts(texts, dict.fromkeys(texts))
    assert found.title == "robot.move(to).leaves, for all to in pair"
    assert found.conditions == ("at := to if bolts[to] == tight", "p10")
    texts["robot.move(p2).leaves"] = ("at := p3 if bolts[p2] == tight", "p10")
    found, alone = IndexFolding(WORDING).folded_texts(texts, dict.fromkeys(texts))
    assert (found.over, alone.name, alone.conditions) == ("all to in {p1, p3}", *list(texts.items())[1])
    ways = dict.fromkeys(texts) | {"robot.move(p3).leaves": "otherwise"}
    assert all(each.over is None for each in IndexFolding(WORDING).folded_texts(texts, ways))


def test_a_word_that_stands_in_a_text_already_is_not_taken() -> None:
    texts = {f"robot.move({pair})": (f"go to {pair}",) for pair in PAIR.values}
    assert [each.over for each in IndexFolding(WORDING).folded_texts(texts, dict.fromkeys(texts))] == [None] * 3


def test_names_of_all_instances_are_one() -> None:
    names = ["never(p1)", "never(p2)", "never(p3)", "other(p1)"]
    found = IndexFolding(WORDING, "specification.").folded_names(names)
    assert found == [
        "never(pair) for all pair in pair",
        "other(p1)",
    ]


@examples(100)
@given(st.lists(CONDITIONS, min_size=3, max_size=3), SEEDS)
def test_each_is_told_once_and_means_the_same(conditions: list[Expression], seed: int) -> None:
    names = [f"robot.move({pair})" for pair in PAIR.values]
    statements = {name: GroundStatement((condition,)) for name, condition in zip(names, conditions, strict=True)}
    found = list(IndexFolding(WORDING).folded(statements))
    assert sorted(member for each in found for member in each.members) == names
    for each in found:
        for member in each.members:
            value = member.removeprefix("robot.move(").removesuffix(")")
            scope = SCOPE if each.over is None else SCOPE.binding({"to": (value, PAIR)})
            told = ground(each.conditions[0], scope)
            for state in states(seed):
                assert evaluate(told, state) == evaluate(statements[member].conditions[0], state)
