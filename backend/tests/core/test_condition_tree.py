"""A condition as a tree: each part is what follows from its parts, and the leaves that decide do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.lifting.condition_tree import ConditionTree, TreeKind, condition_tree
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.cli.loading import usable_automaton
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import Expression, Variable, conjunction
from sequence_planner.language.types import BOOLEAN
from support.automata import Does, automaton
from support.places import BOLT_TIGHTENING, MODELS, TRUCK_ENGINE_STATION

from .choices import Choices, made_by
from .random_expressions import predicate
from .random_stations import automaton as random_station
from .random_stations import state_of

Asked = tuple[Automaton, Expression, State]


def asked(choices: Choices) -> Asked:
    station = random_station(choices)
    scope = [Variable(name, type_) for name, type_ in station.types.items()]
    return station, predicate(choices, scope, depth=3), state_of(choices, station, unknown=True)


def nodes(tree: ConditionTree) -> Iterator[ConditionTree]:
    yield tree
    for part in tree.parts:
        yield from nodes(part)


def leaves(tree: ConditionTree) -> list[ConditionTree]:
    return [each for each in nodes(tree) if not each.parts]


def with_leaves(tree: ConditionTree, truths: Mapping[int, bool | None]) -> bool | None:
    """What the whole would be if leaves were these, by their identity."""
    parts = tuple(part._replace(holds=with_leaves(part, truths)) for part in tree.parts)
    return tree._replace(parts=parts).combined() if parts else truths[id(tree)]


def denied(truth: bool | None) -> bool:
    return truth is not True


def hold_to_the_laws(station: Automaton, condition: Expression, state: State) -> None:
    tree = condition_tree(station, condition, state)
    assert tree.holds is evaluate(condition, state)
    for node in nodes(tree):
        assert node.holds is evaluate(node.condition, state)
        assert node.holds is node.combined()
        assert all(node.decides for part in node.parts if part.decides)
    found = leaves(tree)
    decisive = [leaf for leaf in found if leaf.decides]
    assert decisive
    if tree.holds is None:
        assert all(leaf.holds is None for leaf in decisive)
    for others in (True, False, None):
        assert with_leaves(
            tree, {id(leaf): leaf.holds if leaf.decides else others for leaf in found}
        ) is tree.holds or (tree.holds is None)
    otherwise = {id(leaf): denied(leaf.holds) if leaf.decides else leaf.holds for leaf in found}
    assert with_leaves(tree, otherwise) is not tree.holds
    wanted = {id(leaf): leaf.wanted if leaf.decides else leaf.holds for leaf in found}
    assert tree.holds is True or with_leaves(tree, wanted) is not tree.holds


@given(made_by(asked))
def test_the_root_is_the_condition_and_the_leaves_that_decide_decide(question: Asked) -> None:
    hold_to_the_laws(*question)


STATIONS = {path.name: path for path in (BOLT_TIGHTENING, MODELS / "robots_with_buffer", TRUCK_ENGINE_STATION)}


@pytest.fixture(scope="module", params=STATIONS)
def station(request: pytest.FixtureRequest) -> Automaton:
    return usable_automaton(STATIONS[request.param])


@given(data=st.data())
def test_it_is_so_in_the_words_of_a_model(station: Automaton, data: st.DataObject) -> None:
    abilities, operations = list(station.abilities.values()), list(station.operations.values())
    ability, operation = data.draw(st.sampled_from(abilities)), data.draw(st.sampled_from(operations))
    values = {name: data.draw(st.sampled_from((None, *each.type.domain))) for name, each in station.variables.items()}
    state = synchronise(station, values)
    condition = data.draw(
        st.sampled_from(
            (
                conjunction(ability.enabled, ability.start_guard),
                ability.executing if ability.finish_guard is None else ability.finish_guard,
                operation.precondition,
                operation.goal,
            )
        )
    )
    hold_to_the_laws(station, condition, state)


def test_a_flag_opens_to_its_predicate_and_a_negation_turns_what_is_wanted() -> None:
    two = automaton(
        {"one": Does(("go := true",), "not busy and not two.enabled"), "two": Does(("go := true",), "busy or go")},
        measured={"busy": (BOOLEAN, True)},
        output={"go": (BOOLEAN, False)},
    )
    tree = condition_tree(two, two.abilities["one"].enabled, initial_state(two))
    (free, other) = tree.parts
    assert (free.kind, free.text, free.holds, free.decides, free.wanted) == (
        TreeKind.LEAF,
        "not busy",
        False,
        True,
        True,
    )
    assert (other.kind, other.holds, other.wanted) == (TreeKind.NOT, False, True)
    (either,) = other.parts
    assert (either.kind, either.text, either.holds, either.wanted) == (TreeKind.ANY, "busy or go", True, False)
    assert [(leaf.text, leaf.decides, leaf.wanted) for leaf in either.parts] == [
        ("busy", True, False),
        ("go", False, False),
    ]
