"""Plain automata: what their documents mean, and what synthesis and planner make of them."""

from __future__ import annotations

import json
from collections.abc import Iterable
from math import inf
from typing import Any

import pytest
from hypothesis import given

from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.printing import print_value
from sequence_planner.model.plain_documents import read_plain
from sequence_planner.model.source import ModelError
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plain import PlainPlanner, plan_transitions
from sequence_planner.planning.plan import Contract, Goal, Verdict, goals_of
from sequence_planner.planning.replaying.replay import missing
from sequence_planner.planning.sat.single_starts import SingleStarts
from sequence_planner.planning.single.derived import without_flags
from sequence_planner.planning.single.neighbourhood import shortened
from sequence_planner.planning.single.stepping import Stepping
from sequence_planner.planning.single.sums import Sums
from sequence_planner.synthesis.diagrams import Function
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.supervision import Supervision, SynthesisError, relevant, synthesise

from .budget import examples
from .choices import Choices, made_by
from .explicit_plain import ExplicitPlain, Key, type_of
from .random_plain import document

LONGEST = 8


def document_with_goals(choices: Choices) -> dict[str, Any]:
    """A document that now and then has further goals."""
    first = document(choices)
    more = (
        [f"F ({name} == {value})" for name, value in values(choices, first["variables"])] if choices.chance(2) else []
    )
    return {**first, "goal": [*first["goal"], *more]}


def values(choices: Choices, variables: dict[str, object]) -> list[tuple[str, str]]:
    """Some variables, each with a value of its domain as it is written."""
    chosen = choices.different(list(variables), 1, 2)
    return [(name, print_value(choices.pick(type_of(variables[name]).domain))) for name in chosen]


def read(written: dict[str, Any]) -> Automaton:
    return plain_automaton(read_plain(json.dumps(written, indent=1), "example.efa.json"))


def meant(written: dict[str, Any]) -> tuple[ExplicitPlain, Automaton | None]:
    """The document state by state, and as an automaton if it has an initial state at all."""
    explicit = ExplicitPlain(written)
    if explicit.initial:
        return explicit, read(written)
    with pytest.raises(ModelError, match="there is nowhere to begin"):
        read(written)
    return explicit, None


@examples(200)
@given(made_by(document))
def test_each_transition_does_what_its_document_says(written: dict[str, Any]) -> None:
    explicit, automaton = meant(written)
    if automaton is None:
        return
    transitions = plain_transitions(automaton)
    by_event = {
        t["event"]: [name for name in transitions if event_of(name) == t["event"]] for t in written["transitions"]
    }
    for transition in written["transitions"]:
        taken, name = explicit.taken(transition), by_event[transition["event"]].pop(0)
        assert transitions[name].controllable == transition["controllable"]
        for key in explicit.states:
            after = step(explicit.valuation(key), transitions[name])
            assert (None if after is None else tuple(after.values())) == taken.get(key)


@examples(200)
@given(made_by(document))
def test_the_initial_states_are_those_that_are_described_and_exist(written: dict[str, Any]) -> None:
    explicit, automaton = meant(written)
    if automaton is None:
        return
    declared = tuple(variable.initial for variable in automaton.variables.values())
    assert declared in explicit.initial
    assert (automaton.initial is None) == (len(explicit.initial) == 1)
    if automaton.initial is not None:
        assert explicit.initial == {k for k in explicit.states if holds(automaton.initial, explicit.valuation(k))}


@examples(200)
@given(made_by(document))
def test_safe_and_reachable_states_are_those_of_the_definition(written: dict[str, Any]) -> None:
    """Over the variables that matter; and there is a supervisor when all initial states are safe."""
    explicit, automaton = meant(written)
    if automaton is None:
        return
    supervision = Supervision(Plant(automaton, relevant(automaton)))
    diagrams = supervision.plant.diagrams

    def projected(key: Key) -> Key:
        return tuple(explicit.valuation(key)[name] for name in diagrams.names)

    def members(states: Function) -> set[Key]:
        return {tuple(member.values()) for member in diagrams.exported(states, diagrams.names).members()}

    safe = members(supervision.safe)
    for key in explicit.states:
        assert (projected(key) in safe) == (key in explicit.safe)
    for supervised in (False, True):
        reached = members(supervision.reachable(supervised))
        assert reached == set(map(projected, explicit.distances(explicit.initial, supervised)))
    if explicit.initial <= explicit.safe:
        assert synthesise(automaton).safe.includes(automaton.initial_valuation)
    else:
        with pytest.raises(SynthesisError):
            synthesise(automaton)


def distance(explicit: ExplicitPlain, begin: Key, goals: Goals) -> int | None:
    """The fewest transitions of a supervised run from `begin` in which each goal holds somewhere, if there is one.

    The search is over states together with the goals that are missing still.
    """

    def missing_in(key: Key, left: Goals) -> Goals:
        return tuple(goal for goal in left if not holds(goal.predicate, explicit.valuation(key)))

    layer = {(begin, missing_in(begin, goals))}
    seen, steps = set(layer), 0
    while layer:
        if any(not left for _, left in layer):
            return steps
        following = {
            (after, missing_in(after, left))
            for key, left in layer
            for after in explicit.steps[False][key] | (explicit.steps[True][key] & explicit.safe)
        }
        layer, steps = following - seen, steps + 1
        seen |= layer
    return None


@examples(150)
@given(made_by(document_with_goals))
def test_plans_have_the_fewest_transitions_and_there_is_none_exactly_where_exhaustive_search_finds_none(
    written: dict[str, Any],
) -> None:
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    for key in sorted(explicit.initial, key=str)[:2]:
        begin, least = explicit.valuation(key), distance(explicit, key, goals)
        answer = plan_transitions(automaton, supervisor, goals, begin, budget=Budget.seconds(60))
        fast = plan_transitions(automaton, supervisor, goals, begin, Contract.FAST, budget=Budget.seconds(60))
        if least is None:
            assert answer.verdict is fast.verdict is Verdict.NONE_AT_ALL
            continue
        assert answer.verdict is fast.verdict is Verdict.FOUND
        assert answer.minimal
        assert len(answer.transitions) == answer.searched == least
        assert fast.searched <= least <= len(fast.transitions)
        for each in (answer, fast):
            assert reaches(automaton, supervisor, begin, each.transitions, goals)


@examples(100)
@given(made_by(document_with_goals))
def test_of_several_initial_states_a_plan_begins_in_the_best(written: dict[str, Any]) -> None:
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    distances = [distance(explicit, key, goals) for key in explicit.initial]
    found = [least for least in distances if least is not None]
    answer = plan_transitions(automaton, supervisor, goals, budget=Budget.seconds(60))
    fast = plan_transitions(automaton, supervisor, goals, contract=Contract.FAST, budget=Budget.seconds(60))
    if not found:
        assert answer.verdict is fast.verdict is Verdict.NONE_AT_ALL
        return
    assert answer.verdict is fast.verdict is Verdict.FOUND
    assert answer.minimal
    assert len(answer.transitions) == answer.searched == min(found)
    assert fast.searched <= min(found) <= len(fast.transitions)
    for each in (answer, fast):
        begin = each.begin or automaton.initial_valuation
        assert tuple(begin[name] for name in explicit.types) in explicit.initial
        assert reaches(automaton, supervisor, begin, each.transitions, goals)


@examples(60)
@given(made_by(document_with_goals))
def test_the_unrolled_run_finds_as_few_transitions_as_exhaustive_search(written: dict[str, Any]) -> None:
    """As it does where there are too many states for the other engines."""
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    key = min(explicit.initial, key=str)
    begin, least = explicit.valuation(key), distance(explicit, key, goals)
    left = missing(goals, begin)
    if not left:
        return
    task = Task(begin, left, longest=LONGEST + 1)
    finding = SingleStarts(without_flags(automaton), supervisor).solve(task, Budget.seconds(60))
    if least is None or least > LONGEST:
        assert (finding.plan, finding.searched) == (None, LONGEST + 1)
    else:
        assert finding.plan is not None
        assert len(finding.plan.starts) == finding.searched - 1 == least
        assert reaches(automaton, supervisor, begin, [name for _, name in finding.plan.starts], goals)


@examples(60)
@given(made_by(document_with_goals), made_by(lambda choices: [choices.number(0, 9) for _ in range(5)]))
def test_a_planner_that_was_asked_before_answers_as_one_that_was_not(written: dict[str, Any], drawn: list[int]) -> None:
    """From states on the ways of its plans, beside them, and anywhere else, by both contracts."""
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    planner = PlainPlanner(automaton, supervisor)
    known = sorted((key for key in explicit.distances(explicit.initial, True)), key=str)
    for number in drawn:
        key = known[number % len(known)]
        begin, asked = explicit.valuation(key), goals[: 1 + number % len(goals)]
        least = distance(explicit, key, asked)
        contract = Contract.FAST if number % 3 == 0 else Contract.MINIMAL
        answer = planner.answer(asked, begin, contract, budget=Budget.seconds(60))
        if least is None:
            assert answer.verdict is Verdict.NONE_AT_ALL
            continue
        assert answer.verdict is Verdict.FOUND
        assert answer.searched <= least <= len(answer.transitions)
        assert not answer.minimal or len(answer.transitions) == least
        assert answer.minimal or contract is Contract.FAST
        assert reaches(automaton, supervisor, begin, answer.transitions, asked)


def reaches(
    automaton: Automaton, supervisor: Supervisor, state: State, plan: Iterable[str], goals: Iterable[Goal]
) -> bool:
    """Whether each transition of `plan` can be taken under the supervisor, and each goal holds somewhere on the way."""
    transitions, left = plain_transitions(automaton), missing(goals, state)
    for name in plan:
        after = step(state, transitions[name])
        if after is None or (transitions[name].controllable and not supervisor.allows(state, after)):
            return False
        state, left = after, missing(left, after)
    return not left


class Looks(Budget):
    """Spent when it has been looked at so many times."""

    def __init__(self, looks: int) -> None:
        super().__init__(inf)
        self.left = looks

    @property
    def remaining(self) -> float:
        self.left -= 1
        return 60.0 if self.left >= 0 else 0.0


def test_what_is_found_when_the_time_ends_is_told_with_what_is_proven_of_it() -> None:
    """By the bounded solver, asked for no more than it has looked at before: it goes from long plans to short ones."""
    counting = {
        "name": "counting",
        "variables": {"n": {"min": 0, "max": 9}, "m": {"min": 0, "max": 9}},
        "initial": "n == 0 and m == 0",
        "transitions": [
            {"event": "up", "controllable": True, "set": {"n": "n + 1"}},
            {"event": "over", "controllable": True, "guard": "n >= 3", "set": {"n": 0, "m": "m + 1"}},
            {"event": "back", "controllable": True, "guard": "m > 0", "set": {"m": "m - 1"}},
        ],
        "goal": ["F (m == 2)", "F (m == 9 and n == 9)"],
    }
    automaton = read(counting)
    supervisor = synthesise(automaton)
    near, far = goals_of(automaton, automaton.operations)
    lengths: set[int] = set()
    for looks in range(60):
        engine = SingleStarts(without_flags(automaton), supervisor)
        begin = automaton.initial_valuation
        assert engine.solve(Task(begin, (far,), longest=20, depth=20), Budget.seconds(60)).plan is None
        task = Task(begin, (near,), longest=20, depth=20)
        found = engine.solve(task, Looks(looks))
        assert found.searched <= 9  # the tick in which the goal is seen to hold is the ninth
        if found.plan is not None:
            order = [name for _, name in found.plan.starts]
            assert reaches(automaton, supervisor, begin, order, (near,))
            assert found.plan.minimal_ticks == (len(order) == found.searched - 1 == 8)
            lengths.add(len(order))
        again = engine.solve(task, Budget.seconds(60))
        assert again.plan is not None
        assert again.plan.minimal_ticks
        assert len(again.plan.starts) == 8
    assert len(lengths) > 1


@examples(60)
@given(made_by(document_with_goals), made_by(lambda choices: [choices.number(0, 30) for _ in range(30)]))
def test_what_is_shortened_still_leads_to_the_goals(written: dict[str, Any], drawn: list[int]) -> None:
    """Of a plan that strays, as near to it as it can be; given time, the fewest transitions where all is near."""
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    key = min(explicit.initial, key=str)
    begin, least = explicit.valuation(key), distance(explicit, key, goals)
    left = missing(goals, begin)
    strayed: list[str] = []
    stepping = Stepping(without_flags(automaton), supervisor)
    run = stepping.begin(begin)
    for number in drawn:
        if not (following := list(stepping.following(run))):
            break
        name, run = following[number % len(following)]
        strayed.append(name)
    if not left or not reaches(automaton, supervisor, begin, strayed, goals):
        return
    shorter = shortened(strayed, begin, left, stepping, Budget.seconds(60)) or strayed
    assert reaches(automaton, supervisor, begin, shorter, goals)
    assert len(shorter) == least


@examples(150)
@given(made_by(document_with_goals))
def test_what_sums_exclude_is_never_reached(written: dict[str, Any]) -> None:
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    for key in sorted(explicit.initial, key=str)[:2]:
        begin = explicit.valuation(key)
        for each in goals:
            left = missing((each,), begin)
            task = Task(begin, left, longest=LONGEST)
            if left and Sums(without_flags(automaton), supervisor).solve(task, Budget.seconds(60)).exhausted:
                assert distance(explicit, key, left) is None


@pytest.mark.parametrize(
    ("transitions", "never", "sometimes"),
    [
        ({"a": "a + 1", "b": "b - 1"}, "a == 3 and b == 2 and c == 2", "a == 3 and b == 1 and c == 2"),
        ({"a": "a + 1", "b": "b + 1"}, "a == 3 and b == 2 and c == 2", "a == 3 and b == 3 and c == 2"),
        ({"a": "a + 1", "b": "b - 1"}, "a >= 3 and b >= 2", "a >= 3 and b <= 1"),
    ],
)
def test_sums_and_parities_that_nothing_changes(transitions: dict[str, str], never: str, sometimes: str) -> None:
    back = {name: text.translate(str.maketrans("+-", "-+")) for name, text in transitions.items()}
    automaton = read(
        {
            "name": "sums",
            "variables": {name: {"min": 0, "max": 4} for name in "abc"},
            "initial": "a == 2 and b == 2 and c == 2",
            "transitions": [
                {"event": "go", "controllable": True, "set": transitions},
                {"event": "back", "controllable": True, "set": back},
                {"event": "up", "controllable": True, "guard": "c < 3", "set": {"c": "c + 1"}},
                {"event": "down", "controllable": True, "guard": "a != 4", "set": {"c": 0}},
            ],
            "goal": [f"F ({never})", f"F ({sometimes})"],
        }
    )
    engine = Sums(without_flags(automaton), synthesise(automaton))
    found = [
        engine.solve(Task(automaton.initial_valuation, (goal,)), Budget.seconds(60)).exhausted
        for goal in goals_of(automaton, automaton.operations)
    ]
    assert found == [True, False]
