"""The state space of a draft, folded: held against states that are enumerated one by one with the reference tick."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from core.choices import Choices, made_by
from core.explicit import Explicit, Key
from core.random_devices import device_station
from core.random_stations import automaton as random_automaton
from editor.models import bolts
from planning.advice.rules import station
from sequence_planner.analysis.finding import analyses
from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.tick import apply_effects, finish, initial_state, synchronise
from sequence_planner.editor.schemas.state_space import Extent, StateSpaceQuestion, StateSpaceView
from sequence_planner.editor.state_space.choice import MOST_SUGGESTED
from sequence_planner.editor.state_space.quotient import CauseKind, Node, Quotient
from sequence_planner.editor.state_space.reached import Reached, reached_states
from sequence_planner.editor.state_space.worker import answering
from sequence_planner.language.types import BOOLEAN, Value
from sequence_planner.model.paths import EditError
from sequence_planner.synthesis.supervisor import Supervision, relevant, synthesise
from sequence_planner.synthesis.transition_relation import MOST_BITS, Plant
from support.automata import Does
from support.automata import automaton as made
from support.examples import examples
from support.places import BOLT_TIGHTENING


def any_station(choices: Choices) -> Automaton:
    return device_station(choices) if choices.chance(2) else random_automaton(choices)


def folding(explicit: Explicit, chosen: list[str]) -> Callable[[Key], Node]:
    """What folds an enumerated state."""
    places = [list(explicit.automaton.variables).index(name) for name in chosen]
    return lambda key: tuple(key[place] for place in places)


def space_of(automaton: Automaton, chosen: list[str], extent: Extent, present: Key | None = None) -> Reached:
    """The reached states of an automaton, from its initial state and perhaps from another one on."""
    plant = Plant(automaton, relevant(automaton))
    safe = plant.diagrams.exported(Supervision(plant).safe)
    explicit = Explicit(automaton)
    found = reached_states(automaton, safe, chosen, extent)
    assert found is not None
    if present is None:
        return found
    state = explicit.states[present]
    begun = found.beginning(state) or reached_states(automaton, safe, chosen, extent, state)
    assert begun is not None
    return begun


def is_followed(explicit: Explicit, key: Key, after: Key, extent: Extent) -> bool:
    """Return whether a start is one that the extent asks for."""
    if extent is Extent.ALL:
        return True
    return key in explicit.safe and (extent is Extent.EDGE or after in explicit.safe)


def moves(explicit: Explicit, key: Key, extent: Extent) -> set[Key]:
    """Where one step leads from an enumerated state."""
    found = set(explicit.uncontrollable[key])
    for after in explicit.starts[key].values():
        if is_followed(explicit, key, after, extent):
            found.add(after)
    return found


def reached_from(explicit: Explicit, begin: set[Key], extent: Extent) -> set[Key]:
    """All that is enumerated from some states on."""
    reached, pending = set(begin), list(begin)
    while pending:
        after = moves(explicit, pending.pop(), extent) - reached
        pending.extend(after)
        reached |= after
    return reached


@examples(120)
@given(made_by(any_station), st.sampled_from(Extent), st.data())
def test_nodes_and_pairs_are_those_of_the_enumerated_states(
    automaton: Automaton, extent: Extent, data: st.DataObject
) -> None:
    """The quotient by the values of any variables, from the initial state and any present one: no more and no less."""
    explicit = Explicit(automaton)
    names = data.draw(st.lists(st.sampled_from(list(automaton.variables)), unique=True, min_size=1, max_size=3))
    present = data.draw(st.sampled_from(sorted(explicit.states, key=str)))
    fold = folding(explicit, names)
    reached = reached_from(explicit, {explicit.initial, present}, extent)
    space = space_of(automaton, names, extent, present=present)
    quotient = Quotient(space, names)
    assert space.exact
    assert space.has_all_variables
    assert quotient.states == len(reached)
    cut = [name for name, ability in automaton.abilities.items() if not ability.restart]
    nodes = {each.values: each for each in quotient.folded_nodes(explicit.states[present], cut)}
    assert quotient.number_of_nodes() == len(nodes)
    assert {values: each.states for values, each in nodes.items()} == Counter(map(fold, reached))
    pairs = {(fold(key), fold(after)) for key in reached for after in moves(explicit, key, extent)}
    assert quotient.pairs == {(one, other) for one, other in pairs if one != other}
    marked: dict[str, Counter[Node]] = {
        "forbidden": Counter(map(fold, reached & explicit.forbidden)),
        "unsafe": Counter(map(fold, reached - explicit.safe)),
        "cut": Counter(map(fold, reached & cut_of(explicit))),
        "stuck": Counter(map(fold, (key for key in reached if is_stuck(explicit, key, extent)))),
    }
    for mark, counts in marked.items():
        assert {values: getattr(each, mark) for values, each in nodes.items() if getattr(each, mark)} == counts, mark
    assert {values for values, each in nodes.items() if each.initial} == {fold(explicit.initial)}
    assert {values for values, each in nodes.items() if each.present} == {fold(present)}


def cut_of(explicit: Explicit) -> set[Key]:
    """The safe states from which a start leads out of the safe ones."""
    return {key for key in explicit.safe if any(after not in explicit.safe for after in explicit.starts[key].values())}


def is_stuck(explicit: Explicit, key: Key, extent: Extent) -> bool:
    """Return whether nothing but faults and operations changes anything, and no ability that writes may start."""
    automaton = explicit.automaton
    activities = [place for place, name in enumerate(automaton.variables) if name in automaton.names(Kind.ACTIVITY)]

    def turned(after: Key) -> bool:
        different = [place for place, (one, other) in enumerate(zip(key, after, strict=True)) if one != other]
        return not set(different) <= set(activities)

    if any(turned(after) for after in explicit.helpful[key]):
        return False
    return not any(
        automaton.abilities[name].start_actions
        and (extent is not Extent.SUPERVISED or is_followed(explicit, key, after, extent))
        for name, after in explicit.starts[key].items()
    )


@examples(120)
@given(made_by(any_station), st.sampled_from(Extent), st.data())
def test_what_leads_to_a_node_is_what_does_in_the_enumerated_states(
    automaton: Automaton, extent: Extent, data: st.DataObject
) -> None:
    """Each start with what the supervisor says of it, and each effect that alone changes something."""
    explicit = Explicit(automaton)
    names = data.draw(st.lists(st.sampled_from(list(automaton.variables)), unique=True, min_size=1, max_size=3))
    fold = folding(explicit, names)
    reached = reached_from(explicit, {explicit.initial}, extent)
    found = Quotient(space_of(automaton, names, extent), names).leading
    starts: dict[tuple[Node, Node, str], tuple[bool, bool]] = {}
    for key in reached:
        for name, after in explicit.starts[key].items():
            allowed = key in explicit.safe and after in explicit.safe
            kept = key in explicit.safe and after not in explicit.safe
            if fold(key) != fold(after) and is_followed(explicit, key, after, extent):
                before = starts.get((fold(key), fold(after), name), (False, False))
                starts[fold(key), fold(after), name] = (before[0] or allowed, before[1] or kept)
    told = {
        (each.source, each.sink, each.cause.name): (each.allowed, each.kept)
        for each in found
        if each.cause.kind is CauseKind.START
    }
    assert told == starts
    assert {(each.source, each.sink, each.cause.name) for each in found if each.cause.kind is CauseKind.EFFECT} == set(
        effects_alone(explicit, reached, fold)
    )


def effects_alone(
    explicit: Explicit, reached: set[Key], fold: Callable[[Key], Node]
) -> Iterator[tuple[Node, Node, str]]:
    """Where each effect leads that alone happens and changes something of what it writes."""
    automaton = explicit.automaton
    for key in reached:
        state = explicit.states[key]
        for effect in automaton.effects:
            sensed = apply_effects(state, (effect,))
            if sensed is not None and sensed != state:
                after = explicit.key(synchronise(automaton, finish(automaton, sensed).state))
                if fold(key) != fold(after):
                    yield fold(key), fold(after), effect.name


@examples(60)
@given(made_by(any_station), st.sampled_from(Extent), st.data())
def test_an_overestimate_misses_nothing(automaton: Automaton, extent: Extent, data: st.DataObject) -> None:
    """Where states are too many to be computed, all that is reached and all pairs are among what is told."""
    explicit = Explicit(automaton)
    names = data.draw(st.lists(st.sampled_from(list(automaton.variables)), unique=True, min_size=1, max_size=3))
    fold = folding(explicit, names)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sequence_planner.editor.state_space.reached.MOST_EXACT", -1)
        space = space_of(automaton, names, extent)
    assume(not space.exact)  # where nothing can happen there is nothing to be overestimated
    extent = space.extent
    assert extent is not Extent.EDGE
    reached = reached_from(explicit, {explicit.initial}, extent)
    quotient = Quotient(space, names)
    assert quotient.states >= len(reached)
    nodes = {each.values: each.states for each in quotient.folded_nodes(initial_state(automaton), ())}
    assert all(nodes[values] >= count for values, count in Counter(map(fold, reached)).items())
    pairs = {(fold(key), fold(after)) for key in reached for after in moves(explicit, key, extent)}
    assert quotient.pairs >= {(one, other) for one, other in pairs if one != other}


def test_of_very_many_variables_those_that_bear_on_the_question_are_counted_alone() -> None:
    """Whether anything else can happen is not known then."""
    lamps = {f"lamp_{number}": (BOOLEAN, False) for number in range(MOST_BITS)}
    large = made(
        {"press": Does(start=("pressed := true",), when="not pressed")},
        output={"pressed": (BOOLEAN, False), **lamps},
    )
    found = reached_states(large, synthesise(large).safe, ["pressed"], Extent.EDGE)
    assert found is not None
    assert found.exact
    assert not found.has_all_variables
    quotient = Quotient(found, ["pressed"])
    nodes = quotient.folded_nodes(initial_state(large), ())
    assert [(node.values, node.states, node.stuck) for node in nodes] == [((False,), 1, None), ((True,), 1, None)]


# What a page asks.


class Asking:
    """The process that a page asks, about one of the models."""

    def __init__(self, folder: Path) -> None:
        self._answer: Any = answering(folder)
        self._files: dict[str, str] = {}

    def __call__(
        self,
        present: dict[str, Value | None] | None = None,
        files: dict[str, str] | None = None,
        asked: Mapping[str, object] | None = None,
        **more: object,
    ) -> StateSpaceView:
        files = bolts() if files is None else files
        changed = {path: text for path, text in files.items() if self._files.get(path) != text}
        self._files = files
        question = (
            changed,
            "space",
            (7, BOLT_TIGHTENING, present or {}, StateSpaceQuestion.model_validate({**(asked or {}), **more})),
        )
        return StateSpaceView.model_validate_json(self._answer(question, None))


@pytest.fixture
def space(tmp_path: Path) -> Asking:
    return Asking(tmp_path)


PAIRS = [f"bolts[bolt_pair_{number}]" for number in (1, 2, 3)]


def test_a_choice_is_made_first_and_another_one_can_be_made(space: Asking) -> None:
    begun = space()
    assert (begun.number, begun.obstacle, begun.exact, begun.whole) == (7, None, True, True)
    assert 1 < len(begun.nodes) <= MOST_SUGGESTED
    assert sum(node.states for node in begun.nodes) == begun.states
    assert {node.initial for node in begun.nodes} == {True, False}
    other = space(variables=PAIRS[:2])
    assert [each.name for each in other.chosen] == PAIRS[:2]
    assert len(other.nodes) == 9
    assert [each.nodes_without for each in other.chosen] == [3, 3]
    assert other.states == begun.states
    placed = other.nodes.index(next(node for node in other.nodes if node.values == ["placed", "empty"]))
    causes = {cause.kind for arrow in other.arrows if arrow.sink == placed for cause in arrow.causes}
    assert "person" in causes


def test_the_numbers_are_those_of_the_check(space: Asking) -> None:
    """With the supervisor and as if there were none."""
    *_, analysis = analyses(station("bolt_tightening").automaton)
    supervised = space(extent=Extent.SUPERVISED)
    assert supervised.states == analysis.supervised_states
    assert space(extent=Extent.ALL).states == analysis.reachable_states
    assert not any(node.unsafe for node in supervised.nodes)
    assert supervised.states < space(extent=Extent.EDGE).states


def test_a_plan_is_a_path_from_the_present(space: Asking) -> None:
    present: dict[str, Value | None] = {PAIRS[0]: "placed"}
    view = space(present, variables=PAIRS[:1], plan=True, until=f"{PAIRS[0]} == tightened")
    assert view.verdict == "found"
    assert view.path is not None
    nodes = [step.node for step in view.path]
    values = [view.nodes[node].values for node in nodes if node is not None]
    assert len(values) == len(nodes)
    assert (values[0], values[-1]) == (["placed"], ["tightened"])
    assert [node.values for node in view.nodes if node.present] == [["placed"]]
    arrows = {(arrow.source, arrow.sink) for arrow in view.arrows}
    assert {(one, other) for one, other in pairwise(nodes) if one != other} <= arrows
    never = space(present, variables=PAIRS[:1], plan=True, until="robot.pose == home and robot.pose == above_engine")
    assert never.path is None
    assert never.verdict


def test_a_guard_is_shown_where_it_keeps_a_start_back(space: Asking) -> None:
    """The nodes of its cut, and what it prevents, in variables that tell it apart."""
    (name, *_) = synthesise(station("bolt_tightening").automaton).guards
    view = space(cut=[name])
    assert any(node.cut for node in view.nodes)
    kept = [arrow for arrow in view.arrows for cause in arrow.causes if cause.kept and cause.name == name]
    assert kept
    assert all(view.nodes[arrow.source].cut and view.nodes[arrow.sink].unsafe for arrow in kept)


def test_too_many_nodes_are_not_told_but_what_would_be_fewer(space: Asking) -> None:
    names = [each.name for each in space().variables]
    view = space(variables=names)
    assert view.nodes == []
    assert view.arrows == []
    assert view.count == view.states > view.most
    assert [each.name for each in view.chosen] == names
    assert all(0 < each.nodes_without <= view.count for each in view.chosen)


@pytest.mark.parametrize(
    ("asked", "why"),
    [
        ({"variables": []}, "at least one"),
        ({"variables": ["robot.wings"]}, "there is no variable robot.wings"),
        ({"cut": ["robot.fly"]}, "there is no ability robot.fly"),
        ({"plan": True, "until": "robot.wings"}, "wings"),
    ],
)
def test_what_is_not_in_the_model_is_refused_with_why(space: Asking, asked: dict[str, object], why: str) -> None:
    with pytest.raises(EditError) as refused:
        space(asked=asked)
    assert why in str(refused.value)


def test_a_draft_without_a_supervisor_shows_why_and_one_that_cannot_be_read_does_not(space: Asking) -> None:
    files = bolts()
    head, _, _ = files["station.yaml"].partition("rest: >-")
    files["station.yaml"] = head + "rest: robot.pose == home and robot.pose == above_engine\n"
    view = space(files=files)
    assert view.obstacle is None
    assert view.unsupervised is not None
    assert any(node.initial and node.unsafe for node in view.nodes)
    assert space(files={**files, "operations.yaml": "nothing: [\n"}).obstacle is not None


def test_values_that_are_not_known_are_some_with_which_it_is_reached(space: Asking) -> None:
    view = space({"robot.pose": None}, variables=["robot.pose"])
    assert [node.values for node in view.nodes if node.present] == [["home"]]
    assert view.states == space(variables=["robot.pose"]).states
