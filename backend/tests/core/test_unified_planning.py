"""A planner of the unified-planning library as an engine: its plans replay, and it ends in time."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.export.unified import UnifiedPlanning, installed
from sequence_planner.language.syntax import FALSE
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Contract, Goal, goals_of
from sequence_planner.planning.validation.replay import Replay
from sequence_planner.process.budget import Budget
from support.waiting import patience

needs_planner = pytest.mark.skipif(not installed(), reason="unified-planning and up-fast-downward are not installed")


@pytest.fixture
def task(worked_example: Automaton) -> PlanningTask:
    placed = synchronise(worked_example, {**initial_state(worked_example), "bolts": "placed"})
    return PlanningTask(placed, goals_of(worked_example, ("tighten_bolt_pair",)), contract=Contract.FAST)


@needs_planner
def test_fast_downward_plans_the_worked_example(
    worked_example: Automaton, supervisor: Supervisor, task: PlanningTask
) -> None:
    engine = UnifiedPlanning(worked_example, supervisor)
    plan = engine.solve(task, Budget.seconds(60)).plan
    assert engine.name == "fast-downward"
    assert plan is not None
    assert Replay(worked_example, supervisor).exactly(task.state, task.state, task.goals, (), plan.ticks)
    assert len(plan.ticks) >= 6


@needs_planner
def test_without_a_plan_it_says_nothing(worked_example: Automaton, supervisor: Supervisor, task: PlanningTask) -> None:
    never = replace(task, goals=(Goal("never", FALSE),))
    assert UnifiedPlanning(worked_example, supervisor).solve(never, Budget.seconds(60)) == Finding()


def test_it_ends_in_time(worked_example: Automaton, supervisor: Supervisor, task: PlanningTask) -> None:
    began = time.monotonic()
    assert UnifiedPlanning(worked_example, supervisor).solve(task, Budget.seconds(0.05)) == Finding()
    assert time.monotonic() - began < patience(5)


def test_questions_that_are_not_for_it(worked_example: Automaton, supervisor: Supervisor, task: PlanningTask) -> None:
    engine = UnifiedPlanning(worked_example, supervisor)
    assert engine.solve(replace(task, contract=Contract.MINIMAL), Budget.seconds(60)) == Finding()
    unknown = replace(task, state={**task.state, "operator.acknowledged": None})
    assert engine.solve(unknown, Budget.seconds(60)) == Finding()
    unsafe = UnifiedPlanning(worked_example, Supervisor(StateSet((), (), root=0), {}))
    assert unsafe.solve(task, Budget.seconds(60)) == Finding()
