"""Engines of plain automata, each for itself."""

from __future__ import annotations

from math import inf
from typing import Any

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import CertificateError, ConservedSum, goals_of
from sequence_planner.planning.sat.single_bmc import SingleStarts
from sequence_planner.planning.single.derived import without_flags
from sequence_planner.planning.single.neighbourhood import Stepping, shortened
from sequence_planner.planning.single.sums import Sums
from sequence_planner.planning.validation.conservation import check_conserved
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import synthesise
from support.examples import examples

from .choices import made_by
from .plain_questions import distance, document_with_goals, meant, reaches, read

LONGEST = 8


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
    task = PlanningTask(begin, left, longest=LONGEST + 1)
    finding = SingleStarts(without_flags(automaton), supervisor).solve(task, Budget.seconds(60))
    if least is None or least > LONGEST:
        assert (finding.plan, finding.searched) == (None, LONGEST + 1)
    else:
        assert finding.plan is not None
        assert len(finding.plan.starts) == finding.searched - 1 == least
        assert reaches(automaton, supervisor, begin, [name for _, name in finding.plan.starts], goals)


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
        assert engine.solve(PlanningTask(begin, (far,), longest=20, depth=20), Budget.seconds(60)).plan is None
        task = PlanningTask(begin, (near,), longest=20, depth=20)
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
            task = PlanningTask(begin, left, longest=LONGEST)
            if left and Sums(without_flags(automaton), supervisor).solve(task, Budget.seconds(60)).proof is not None:
                assert distance(explicit, key, left) is None


def is_conserved(automaton: Automaton, task: PlanningTask, conserved: ConservedSum) -> bool:
    """Whether the sum is accepted as a proof."""
    try:
        check_conserved(without_flags(automaton), task, conserved, lambda: None)
    except CertificateError:
        return False
    return True


@examples(300)
@given(made_by(document_with_goals), made_by(lambda choices: [choices.number(-1, 2) for _ in range(60)]))
def test_no_sum_is_accepted_where_a_goal_is_reached(written: dict[str, Any], drawn: list[int]) -> None:
    """Whatever is said not to change."""
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    begin = explicit.valuation(key := min(explicit.initial, key=str))
    kind, number, *rest = drawn
    names, modulus = [*automaton.variables][: max(number, 1)], (0, 2, 3, 5)[kind + 1]
    left = iter(rest)
    weights = {name: {value: next(left, 0) for value in automaton.variables[name].type.domain} for name in names}
    total = sum(weights[name][value] for name in names if (value := begin[name]) is not None)
    for goal in goals_of(automaton, automaton.operations):
        task = PlanningTask(begin, (goal,), longest=LONGEST)
        if is_conserved(automaton, task, ConservedSum(weights, total, modulus)):
            assert distance(explicit, key, (goal,)) is None
        assert not is_conserved(automaton, task, ConservedSum(weights, total + 1, modulus))


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
    tasks = [PlanningTask(automaton.initial_valuation, (goal,)) for goal in goals_of(automaton, automaton.operations)]
    proof, none = (engine.solve(task, Budget.seconds(60)).proof for task in tasks)
    assert none is None
    assert proof is not None
    assert proof.conserved is not None
    assert is_conserved(automaton, tasks[0], proof.conserved)
    assert not is_conserved(automaton, tasks[1], proof.conserved)
    weights = proof.conserved.weights
    for name, value in ((name, value) for name, each in weights.items() for value in each):
        tampered = {**weights, name: {**weights[name], value: weights[name][value] + 1}}
        there = proof.conserved.total + (tasks[0].state[name] == value)
        other = ConservedSum(tampered, there, proof.conserved.modulus)
        assert not is_conserved(automaton, tasks[0], other)
