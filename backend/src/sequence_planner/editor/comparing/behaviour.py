"""The differences between two models in what they can do: which abilities may start where, and plans of operations.

What may start where is answered over all states that are reached, where these are known as a set; a run that leads
there shows it. What neither proves is told to be undecided.
"""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import StateSet
from sequence_planner.automaton.tick import initial_state
from sequence_planner.editor.comparing.meant import Meant, starts_of
from sequence_planner.editor.schemas.diff import BehaviourDifference, PlanDifference
from sequence_planner.language.syntax import Expression, Not, conjunction
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import ORDINARY, Contract, Plan, goal_of
from sequence_planner.planning.validation.acceptance import Acceptance
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import alike

RUNS = 3.0  # seconds for all runs that show a difference
PLANS = 2.5  # seconds for the plans of all operations

# Where abilities may start.


def behaviour_differences(old: Meant, new: Meant) -> tuple[list[BehaviourDifference], list[str]]:
    """Of each ability that both have what it can do in one of them only; and those of which that is not known."""
    if alike(old.automaton, new.automaton):
        return [], []
    undecided: list[str] = []
    others: list[
        tuple[str, Expression, Expression]
    ] = []  # where each can start in the new one only, and in the old one
    for name, before in old.automaton.abilities.items():
        after = new.automaton.abilities.get(name)
        if after is None:
            continue
        if (old.is_unsaid(name) or new.is_unsaid(name)) and _allowed(old, name) != _allowed(new, name):
            undecided.append(name)
        elif (could := old.may_start(before)) != (can := new.may_start(after)):
            others.append((name, conjunction(can, Not(could)), conjunction(could, Not(can))))
    found: list[BehaviourDifference] = []
    budget, left = Budget.seconds(RUNS), 2 * len(others)
    for name, only_new, only_old in others:
        gained = new.reach(only_new, budget.remaining / left)
        lost = old.reach(only_old, budget.remaining / (left - 1))
        left -= 2
        if gained.found or lost.found:
            found.append(
                BehaviourDifference(
                    ability=name, gains=gained.found, gained=gained.run, loses=lost.found, lost=lost.run
                )
            )
        elif gained.found is None or lost.found is None:
            undecided.append(name)
    return found, undecided


def _allowed(meant: Meant, ability: str) -> StateSet | None:
    return meant.supervisor.guards.get(ability)


# Plans of operations.


def plan_differences(
    old: Meant, new: Meant, behaviour: tuple[Iterable[BehaviourDifference], Iterable[str]]
) -> tuple[list[PlanDifference], list[str]]:
    """The operations that take longer or shorter plans from the initial state, or have one where there was none; and
    those of which that is not known.

    `behaviour` is what `behaviour_differences` has found.
    """
    names = list(dict.fromkeys((*old.automaton.operations, *new.automaton.operations)))
    if _dynamics(old.automaton) == _dynamics(new.automaton):
        # In a station that moves as before, an operation that is to reach the same as before is planned as before.
        names = [name for name in names if _sought(old.automaton, name) != _sought(new.automaton, name)]
    restricts = _only_restricts(old.automaton, new.automaton, *behaviour)
    same = [name for name in names if restricts and _goes_on(old, new, name, old.known_plan(name))]
    budget = Budget.seconds(PLANS)
    found: list[PlanDifference] = []
    undecided: list[str] = []
    for name in names:
        if name in same:
            continue
        before, is_shortest = old.plan_of(name, budget)
        if is_shortest and restricts and _goes_on(old, new, name, before):
            continue
        after, is_shortest_too = new.plan_of(name, budget)
        if not (is_shortest and is_shortest_too):
            undecided.append(name)
        elif _size(before) != _size(after):
            starts = [None if plan is None else starts_of(plan) for plan in (before, after)]
            found.append(PlanDifference(operation=name, before=starts[0], after=starts[1]))
    old.keep_plans()
    new.keep_plans()
    return found, undecided


def _goes_on(old: Meant, new: Meant, operation: str, plan: Plan | None) -> bool:
    """Return whether the shortest plan is one still: where all that can happen could happen before, none is shorter."""
    if plan is None or _sought(old.automaton, operation) != _sought(new.automaton, operation):
        return False
    goals = (goal_of(new.automaton.operations[operation]),)
    task = PlanningTask(dict(initial_state(new.automaton)), goals, ORDINARY, Contract.MINIMAL, len(plan.ticks))
    return Acceptance.of(new.automaton, new.supervisor).accepts(task, plan)


def _only_restricts(
    old: Automaton, new: Automaton, behaviour: Iterable[BehaviourDifference], undecided: Iterable[str]
) -> bool:
    """Return whether it is proven that all that can happen in the new one can happen in the old one."""
    return _frame(old) == _frame(new) and not any(undecided) and all(each.gains is False for each in behaviour)


def _frame(automaton: Automaton) -> object:
    """All that bears on how the station moves, but for where abilities may start."""
    abilities = {
        name: (
            each.start_actions,
            each.executing,
            each.finished,
            each.finish_guard,
            each.finish_actions,
            each.cancel_actions,
            each.restart,
        )
        for name, each in automaton.abilities.items()
    }
    effects = {each.name: (each.kind, each.guard, each.actions, each.fault) for each in automaton.effects}
    return automaton.variables, automaton.flags, automaton.initial, abilities, effects


def _dynamics(automaton: Automaton) -> object:
    """All that bears on how the station moves, and on what the supervisor allows."""
    starts = {name: (each.enabled, each.start_guard) for name, each in automaton.abilities.items()}
    forbidden = {name: each.forbidden for name, each in automaton.specifications.items()}
    return _frame(automaton), starts, forbidden, automaton.rest


def _sought(automaton: Automaton, name: str) -> object:
    operation = automaton.operations.get(name)
    return None if operation is None else (operation.goal, operation.local)


def _size(plan: Plan | None) -> tuple[int, int] | None:
    return None if plan is None else (len(plan.ticks), len(plan.starts))
