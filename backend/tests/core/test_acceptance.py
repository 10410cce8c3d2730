"""What is accepted as a plan is what replays on the reference tick, and nothing is made longer by being tightened."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given

from sequence_planner.planning.planner import Planner
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Plan, PlanRequest, PlanTick
from sequence_planner.planning.validation.acceptance import Acceptance, tightened
from sequence_planner.planning.validation.replay import Replay, missing
from sequence_planner.process.budget import Budget
from support.examples import examples

from .choices import Choices, made_by
from .random_problems import Problem, problem


def planned(given_: Problem) -> tuple[PlanningTask, Plan] | None:
    """A task, and a plan for it that has ticks."""
    request = PlanRequest(given_.state, given_.goals, 20, longest=7, circumstances=given_.circumstances)
    answer = Planner(given_.automaton, given_.supervisor).answer(request)
    if answer.plan is None or not answer.plan.ticks:
        return None
    goals = tuple(goal for goal in given_.goals if goal.name in answer.goals)
    return PlanningTask(given_.state, missing(goals, given_.state), given_.circumstances, longest=7), answer.plan


def changed(choices: Choices, given_: Problem, plan: Plan) -> Plan:
    """The plan with one thing in it that is different."""
    ticks = list(plan.ticks)
    place = choices.number(0, len(ticks) - 1)
    effects, starts = list(ticks[place].effects), list(ticks[place].starts)
    what = choices.number(0, 5)
    if what == 0 and effects:
        effects.remove(choices.pick(effects))
    elif what == 1 and given_.automaton.effects:
        effects.append(choices.pick(list(given_.automaton.effects)).name)
    elif what == 2 and starts:
        starts.remove(choices.pick(starts))
    elif what == 3 and given_.automaton.abilities:
        starts.insert(0, choices.pick(list(given_.automaton.abilities)))
    elif what == 4:
        starts.reverse()
    ticks[place] = PlanTick(tuple(effects), tuple(starts))
    if what == 5:
        del ticks[place]
    return replace(plan, ticks=tuple(ticks))


def wrong_plans(choices: Choices) -> tuple[Problem, PlanningTask, list[Plan]]:
    given_ = problem(choices, unknown=choices.chance(3), demanding=choices.chance(2))
    found = planned(given_)
    if found is None:
        return given_, PlanningTask(given_.state, ()), []
    task, plan = found
    plans = [plan]
    for _ in range(8):
        plans.append(changed(choices, given_, choices.pick([each for each in plans if each.ticks])))
    return given_, task, plans


@examples(60)
@given(made_by(wrong_plans))
def test_what_is_accepted_is_what_replays(found: tuple[Problem, PlanningTask, list[Plan]]) -> None:
    given_, task, plans = found
    acceptance = Acceptance(given_.automaton, given_.supervisor)
    replay = Replay(given_.automaton, given_.supervisor, given_.circumstances)
    for plan in plans:
        if any(len(set(tick.effects)) < len(tick.effects) for tick in plan.ticks):
            continue  # an effect that is named twice happens once, and is no plan of ours
        expected = replay.exactly(task.state, task.state, task.goals, (), plan.ticks)
        assert acceptance.accepts(task, plan) == (expected and len(plan.ticks) <= task.longest)


@examples(60)
@given(made_by(lambda choices: problem(choices, demanding=choices.chance(2))))
def test_a_tightened_plan_is_one_of_the_same_starts_and_no_longer(given_: Problem) -> None:
    found = planned(given_)
    if found is None:
        return
    task, plan = found
    acceptance = Acceptance(given_.automaton, given_.supervisor)
    course = tightened(acceptance, task, plan, Budget.seconds(20))
    if course is None:
        return
    early = course.plan
    again = acceptance.course(task, early)
    assert again is not None
    assert again.ends == course.ends
    assert [(point.tick, point.starts) for point in again.way] == [(point.tick, point.starts) for point in course.way]
    assert len(early.ticks) <= len(plan.ticks)
    assert sorted(name for _, name in early.starts) == sorted(name for _, name in plan.starts)
    assert tightened(acceptance, task, plan, Budget.seconds(0)) is None
