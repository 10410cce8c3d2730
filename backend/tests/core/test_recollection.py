"""What a planner remembers is what it would find anew."""

from __future__ import annotations

from dataclasses import replace
from random import Random

from hypothesis import given

from sequence_planner.planning.pdr.ic3 import Reachability
from sequence_planner.planning.plan_cache import PlanCache
from sequence_planner.planning.planner import InTurn, Planner, PlanningAttempt
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.portfolio.engines import ALONE, Engines
from sequence_planner.planning.problem import ORDINARY, Circumstances, Contract, PlanRequest
from sequence_planner.planning.sat.bmc import BoundedModelChecking
from sequence_planner.planning.validation.acceptance import Acceptance
from sequence_planner.planning.validation.replay import Replay, missing
from sequence_planner.process.budget import Budget
from support.examples import examples

from .breadth_first import Shortest, shortest
from .choices import Choices, made_by
from .random_problems import Problem, problem
from .random_stations import state_of

LONGEST = 12


class Counting:
    """Engines in turn, and how often they were asked."""

    def __init__(self, of: Problem) -> None:
        self.asked = 0
        self._in_turn = InTurn(Engines(of.automaton, of.supervisor, ALONE))

    def solve(self, attempt: PlanningAttempt, budget: Budget) -> None:
        self.asked += 1
        self._in_turn.solve(attempt, budget)


def any_problem(choices: Choices) -> Problem:
    return problem(choices, unknown=choices.chance(4), demanding=choices.chance(2))


def request(of: Problem, contract: Contract = Contract.MINIMAL) -> PlanRequest:
    return PlanRequest(of.state, of.goals, 60, LONGEST, contract, of.circumstances)


@examples(80)
@given(made_by(any_problem))
def test_the_rest_of_a_plan_is_known_to_be_the_shortest(given_: Problem) -> None:
    counting = Counting(given_)
    planner = Planner(given_.automaton, given_.supervisor, counting)
    answer = planner.answer(request(given_))
    if answer.plan is None or not answer.plan.ticks:
        return
    planned = tuple(goal for goal in given_.goals if goal.name in answer.goals)
    task = PlanningTask(given_.state, missing(planned, given_.state), given_.circumstances, longest=LONGEST)
    course = Acceptance(given_.automaton, given_.supervisor).course(task, answer.plan)
    assert course is not None
    asked, replay = counting.asked, Replay(given_.automaton, given_.supervisor, given_.circumstances)
    for number, (state, goals) in enumerate(course.ends[:-1], start=1):
        if missing(goals, state) != goals:
            continue
        for contract in Contract:
            now = planner.answer(replace(request(given_, contract), state=state, goals=goals))
            assert now.plan is not None
            assert (now.engine, counting.asked) == ("recollection", asked)
            assert now.plan.ticks == answer.plan.ticks[number:]
            assert now.searched == len(now.plan.ticks)
            assert replay.exactly(state, state, goals, (), now.plan.ticks)
            found = shortest(given_.automaton, given_.supervisor, state, goals, LONGEST, given_.circumstances)
            assert found == Shortest(len(now.plan.ticks), len(now.plan.starts))
            assert now.plan.minimal_ticks
            assert now.plan.minimal_starts


@examples(80)
@given(made_by(any_problem))
def test_nothing_else_is_taken_for_it(given_: Problem) -> None:
    task = PlanningTask(given_.state, missing(given_.goals, given_.state), given_.circumstances, longest=LONGEST)
    if not task.goals:
        return
    plan = BoundedModelChecking(given_.automaton, given_.supervisor).solve(task, Budget.seconds(60)).plan
    if plan is None:
        return
    recollection = PlanCache(given_.automaton)
    assert recollection.finding(task) is None
    course = Acceptance(given_.automaton, given_.supervisor).course(task, plan)
    assert course is not None
    recollection.keep_plan(task, plan, course.ends)
    assert recollection.plan(task) == plan
    assert recollection.plan(replace(task, longest=len(plan.ticks) - 1)) is None
    assert recollection.plan(replace(task, goals=(*task.goals, task.goals[0]))) is None
    other = Circumstances() if given_.circumstances != ORDINARY else Circumstances(restart=True)
    assert recollection.plan(replace(task, circumstances=other)) is None


def test_a_plan_with_more_proven_of_it_is_kept() -> None:
    given_ = next(each for each in map(seeded, range(1000)) if planned(each))
    task = PlanningTask(given_.state, missing(given_.goals, given_.state), given_.circumstances, longest=LONGEST)
    plan = BoundedModelChecking(given_.automaton, given_.supervisor).solve(task, Budget.seconds(60)).plan
    assert plan is not None
    course = Acceptance(given_.automaton, given_.supervisor).course(task, plan)
    assert course is not None
    unproven, recollection = replace(plan, minimal_ticks=False, minimal_starts=False), PlanCache(given_.automaton)
    for offered, kept in ((unproven, unproven), (plan, plan), (unproven, plan)):
        recollection.keep_plan(task, offered, course.ends)
        assert recollection.plan(task) == kept


def seeded(number: int) -> Problem:
    return problem(Choices(Random(f"recollection.{number}").randrange))


def planned(given_: Problem) -> bool:
    answer = Planner(given_.automaton, given_.supervisor).answer(request(given_))
    return answer.plan is not None and len(answer.plan.starts) > 1 and not answer.left_out


def several_states(choices: Choices) -> tuple[Problem, list[Problem]]:
    first = any_problem(choices)
    states = (state_of(choices, first.automaton, unknown=choices.chance(4)) for _ in range(12))
    return first, [replace(first, state=state) for state in states]


@examples(60)
@given(made_by(several_states))
def test_a_proof_holds_in_the_states_of_its_invariant_only(questions: tuple[Problem, list[Problem]]) -> None:
    first, others = questions
    engine, recollection = Reachability(first.automaton, first.supervisor), PlanCache(first.automaton)
    task = PlanningTask(first.state, missing(first.goals, first.state), first.circumstances)
    if not task.goals:
        return
    proof = engine.solve(task, Budget.seconds(60)).proof
    if proof is None:
        return
    recollection.keep_proof(task, proof)
    for each in others:
        goals = missing(each.goals, each.state)
        finding = recollection.finding(replace(task, state=each.state, goals=goals))
        if finding is not None:
            assert finding.proof == proof
            assert shortest(each.automaton, each.supervisor, each.state, goals, 1000, each.circumstances) is None


@examples(40)
@given(made_by(any_problem))
def test_none_at_all_is_known_without_a_new_proof(given_: Problem) -> None:
    counting = Counting(given_)
    planner = Planner(given_.automaton, given_.supervisor, counting)
    single = replace(request(given_), goals=given_.goals[:1])
    first = planner.answer(single)
    asked = counting.asked
    again = planner.answer(single)
    assert again.verdict == first.verdict
    assert again.goals == first.goals
    if first.plan is not None:
        assert counting.asked == asked
