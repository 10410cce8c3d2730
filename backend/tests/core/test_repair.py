"""Plans that are repaired where a run has left their way."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from random import Random

from hypothesis import given

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.tick import apply_effects, finish, synchronise
from sequence_planner.language.types import EnumerationType
from sequence_planner.planning.plan_cache import PlanCache
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import ORDINARY, Contract, Plan, PlanRequest
from sequence_planner.planning.repair import NAME, Repair
from sequence_planner.planning.sat.bmc import BoundedModelChecking
from sequence_planner.planning.validation.acceptance import Acceptance
from sequence_planner.planning.validation.replay import Replay, missing
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton
from support.examples import examples

from .breadth_first import Shortest, shortest
from .choices import Choices, made_by
from .random_problems import Problem, problem
from .random_stations import state_of

LONGEST = 12


class Followed:
    """A minimal plan, all that it leads through, and a repair that knows nothing else."""

    def __init__(self, of: Problem, task: PlanningTask, plan: Plan) -> None:
        acceptance = Acceptance(of.automaton, of.supervisor)
        course = acceptance.course(task, plan)
        assert course is not None
        recollection = PlanCache(of.automaton)
        recollection.keep_plan(task, plan, course.ends)
        self.plan = plan
        self.way = course.way
        self.repair = Repair(of.automaton, acceptance, recollection)
        self.repair.keep(task, course)


def any_problem(choices: Choices) -> Problem:
    return problem(choices, unknown=choices.chance(4), demanding=choices.chance(2))


def task_of(given_: Problem, state: State) -> PlanningTask:
    return PlanningTask(state, missing(given_.goals, state), given_.circumstances, longest=LONGEST)


def followed(given_: Problem) -> Followed | None:
    task = task_of(given_, given_.state)
    if not task.goals:
        return None
    plan = BoundedModelChecking(given_.automaton, given_.supervisor).solve(task, Budget.seconds(60)).plan
    return None if plan is None else Followed(given_, task, plan)


def judge(given_: Problem, repair: Repair, task: PlanningTask) -> Plan | None:
    """Ask for a repaired plan by both contracts; the one found fast, having held it against exhaustive search."""
    replay = Replay(given_.automaton, given_.supervisor, task.circumstances)
    fast, minimal = (repair.finding(replace(task, contract=each)) for each in (Contract.FAST, Contract.MINIMAL))
    for finding in filter(None, (fast, minimal)):
        plan = finding.plan
        assert plan is not None
        assert finding.proof is None
        assert len(plan.ticks) <= task.longest
        assert replay.exactly(task.state, task.state, task.goals, (), plan.ticks)
        best = shortest(given_.automaton, given_.supervisor, task.state, task.goals, LONGEST, task.circumstances)
        assert best is not None
        assert finding.searched <= best.ticks
        if plan.minimal_ticks:
            assert len(plan.ticks) == best.ticks
        if plan.minimal_starts:
            assert best == Shortest(len(plan.ticks), len(plan.starts))
    assert minimal is None or (minimal.plan is not None and minimal.plan.minimal_starts)
    if fast is None or fast.plan is None:
        return None
    for number, tick in enumerate(fast.plan.ticks):
        assert not any(reached_without(given_, task, fast.plan, number, name) for name in tick.starts)
    return fast.plan


def reached_without(of: Problem, task: PlanningTask, plan: Plan, number: int, start: str) -> bool:
    """Whether `plan` leads to the goals without a start of a tick, less the effects that then cannot happen.

    Nobody counts on a device not to do what it is about to do.
    """
    run = Acceptance(of.automaton, of.supervisor).begin(task)
    for place, tick in enumerate(plan.ticks):
        starts = [name for name in tick.starts if (place, name) != (number, start)]
        if not run.take(run.happening(tick.effects), starts):
            return False
        if not run.goals:
            return True
    return False


@examples(100)
@given(made_by(any_problem))
def test_starts_that_were_held_back_are_made_up_for(given_: Problem) -> None:
    found = followed(given_)
    if found is None:
        return
    for point in found.way:
        if missing(point.run.goals, point.run.values) == point.run.goals != ():
            task = PlanningTask(dict(point.run.values), point.run.goals, given_.circumstances, longest=LONGEST)
            plan = judge(given_, found.repair, task)
            assert plan is None or len(plan.ticks) <= len(found.plan.ticks) - point.tick


def errand(choices: Choices) -> Problem:
    """A carrier that has to come by some places, in any order or in one, on its way to the last."""
    places = ("home", *(f"p{number}" for number in range(choices.number(1, 3))), "out")
    asked = [f"F at == {place}" for place in places[1:-1] if choices.chance(2)] or ["true"]
    station = automaton(
        {
            f"to_{place}": Does(start=(f"target := {place}",), enabled=f"at == target and at != {place}")
            for place in places
        },
        measured={"at": (EnumerationType(places), "home")},
        output={"target": (EnumerationType(places), "home")},
        effects={f"at_{place}": (f"target == {place} and at != {place}", (f"at := {place}",)) for place in places},
        goals={"deliver": "at == out"},
        local={"deliver": f" {choices.pick(('and', 'or'))} ".join(asked)},
    )
    return Problem(station, synthesise(station), synchronise(station, station.initial_valuation), ORDINARY)


@examples(60)
@given(made_by(lambda choices: errand(choices) if choices.chance(2) else problem(choices, demanding=True)))
def test_what_formulas_have_seen_already_is_not_done_again(given_: Problem) -> None:
    """Their automata have come further than they had when the plan was there, or not as far."""
    found = followed(given_)
    way = () if found is None else [point for point in found.way if point.run.goals]
    for here, elsewhere in product(way, way):
        assert found is not None
        goals = missing(elsewhere.run.goals, here.run.values)
        if goals:
            judge(
                given_, found.repair, PlanningTask(dict(here.run.values), goals, given_.circumstances, longest=LONGEST)
            )


def disturbed(given_: Problem, plan: Plan, choices: Choices) -> Iterator[State]:
    """The states of runs along the plan in which some effects come late or not at all, and some starts too.

    And with another value of some variable.
    """
    effects = {effect.name: effect for effect in given_.automaton.effects}
    acceptance = Acceptance(given_.automaton, given_.supervisor)
    for number, tick in enumerate(plan.ticks[:-1]):
        run = acceptance.begin(task_of(given_, given_.state))
        assert all(run.take(each.effects, each.starts) for each in plan.ticks[:number])
        happening = [effects[name] for name in tick.effects if not choices.chance(3)]
        sensed = apply_effects(run.values, happening)
        if sensed is not None:
            yield synchronise(given_.automaton, finish(given_.automaton, sensed).state)
        if run.take([each.name for each in happening], [name for name in tick.starts if not choices.chance(3)]):
            yield dict(run.values)
            name, variable = choices.pick(sorted(given_.automaton.variables.items()))
            yield {**run.values, name: choices.pick(list(variable.type.domain))}  # its flags still to follow


def disturbances(choices: Choices) -> tuple[Problem, list[State]]:
    given_ = any_problem(choices)
    found = followed(given_)
    states = [] if found is None else list(disturbed(given_, found.plan, choices))
    return given_, [*states, *(state_of(choices, given_.automaton, unknown=choices.chance(4)) for _ in range(3))]


@examples(100)
@given(made_by(disturbances))
def test_whatever_has_happened_a_repaired_plan_is_one(disturbances_: tuple[Problem, list[State]]) -> None:
    given_, states = disturbances_
    found = followed(given_)
    if found is None:
        return
    for state in states:
        task = task_of(given_, state)
        if task.goals:
            judge(given_, found.repair, task)
            judge(given_, found.repair, replace(task, longest=1))
            assert found.repair.finding(replace(task, goals=(*task.goals, replace(task.goals[0], name="new")))) is None


def test_planners_repair() -> None:
    """Over so many problems repairs are met, proven and not."""
    met = Counter[str]()
    for number in range(60):
        choices = Choices(Random(f"repair.{number}").randrange)
        given_ = problem(choices)
        planner = Planner(given_.automaton, given_.supervisor)
        request = PlanRequest(given_.state, given_.goals, 60, LONGEST, Contract.MINIMAL, given_.circumstances)
        first = planner.answer(request).plan
        if first is None:
            continue
        for state in disturbed(given_, first, choices):
            answer = planner.answer(replace(request, state=state, contract=Contract.FAST))
            met[answer.engine] += 1
            if answer.engine == NAME:
                assert answer.plan is not None
                met["proven"] += answer.plan.minimal_starts
                again = planner.answer(replace(request, state=state, contract=Contract.FAST))
                assert again.engine == "recollection"
                assert again.plan == answer.plan
    assert met[NAME] > 10, met
    assert met["proven"] > 2, met
