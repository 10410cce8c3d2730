"""Engines that race in processes: the same answers as in one process, whatever becomes of a lane."""

from __future__ import annotations

import os
import signal
import threading
import time
from contextlib import closing
from dataclasses import replace

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import children
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.portfolio import race as racing
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.portfolio.engines import FACTORIES, Lane
from sequence_planner.planning.portfolio.race import Portfolio
from sequence_planner.planning.problem import (
    Contract,
    Plan,
    PlanAnswer,
    PlanRequest,
    PlanTick,
    Proof,
    Verdict,
    goals_of,
)
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import synthesise
from support.examples import ONLY_TIMED, examples
from support.waiting import patience, until

from .choices import made_by
from .random_problems import Problem, problem

GOAL = ("tighten_bolt_pair",)


class Engine:
    """One that behaves as its name says."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self.automaton = automaton

    @property
    def name(self) -> str:
        return type(self).__name__


class Sleeping(Engine):
    """Cannot be interrupted, like a solver in C."""

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        time.sleep(60)
        return Finding()


class Failing(Engine):
    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        raise ZeroDivisionError("of its own making")


class Dying(Engine):
    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        os.kill(os.getpid(), signal.SIGKILL)
        return Finding()


class Lying(Engine):
    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        return Finding(Plan((PlanTick((), ()),), minimal_ticks=True, minimal_starts=True), searched=1)


class Greedy(Engine):
    """Uses more memory than it may."""

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        return Finding(searched=len(bytearray(2**30)))


class Proving(Engine):
    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        return Finding(proof=Proof(self.name, ()))


class Patient(Engine):
    """Works until it is told that nobody waits."""

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        while not budget.spent:
            time.sleep(0.001)
        return Finding(searched=3)


class Slow(Patient):
    """Takes long to be made."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        super().__init__(automaton, supervisor)
        time.sleep(1)


OWN = {each.__name__: each for each in (Sleeping, Failing, Dying, Lying, Greedy, Proving, Patient, Slow)}


def lanes(*names: str) -> list[Lane]:
    return [Lane(name, dict.fromkeys(Contract, (name,))) for name in names]


class Asking:
    """Planners over a race of some engines, for the worked example; each knows nothing of what others were asked."""

    def __init__(self, automaton: Automaton, *names: str, memory: int = racing.MEMORY) -> None:
        supervisor = synthesise(automaton)
        self.model = automaton, supervisor
        self.race = Portfolio(automaton, supervisor, lanes(*names), {**FACTORIES, **OWN}, memory)
        self.request = PlanRequest(initial_state(automaton), goals_of(automaton, GOAL), deadline=20)

    @property
    def planner(self) -> Planner:
        return Planner(*self.model, self.race)

    def answer(self, deadline: float = 20, contract: Contract = Contract.MINIMAL) -> PlanAnswer:
        return self.planner.answer(replace(self.request, deadline=deadline, contract=contract))

    def close(self) -> None:
        self.race.close()
        assert not processes()


def processes() -> list[Child]:
    return [child for child in children() if child.name.startswith("planner")]


def the(lane: str) -> Child:
    until(lambda: any(child.name == f"planner {lane}" for child in processes()))
    (process,) = (child for child in processes() if child.name == f"planner {lane}")
    return process


@examples(15)
@given(made_by(lambda choices: problem(choices, unknown=choices.chance(4), demanding=choices.chance(2))))
def test_a_race_answers_as_the_engines_in_turn_do(given_: Problem) -> None:
    request = PlanRequest(given_.state, given_.goals, 60, longest=7, circumstances=given_.circumstances)
    alone = Planner(given_.automaton, given_.supervisor)
    with Portfolio(given_.automaton, given_.supervisor) as race, pytest.MonkeyPatch.context() as patched:
        # A busy machine has the lane for proofs, which is the nicest, wait for longer.
        patched.setattr("sequence_planner.planning.planner._PROOF_GRACE", 20.0)
        planner = Planner(given_.automaton, given_.supervisor, race)
        for contract in Contract:
            asked = replace(request, contract=contract)
            one, other = alone.answer(asked), planner.answer(asked)
            assert one.goals == other.goals
            assert one.left_out == other.left_out
            assert (one.plan is None) == (other.plan is None)
            if contract is Contract.MINIMAL:
                assert shape(one) == shape(other)


def shape(answer: PlanAnswer) -> tuple[Verdict, int, int, bool, bool] | Verdict:
    plan = answer.plan
    if plan is None:
        return answer.verdict
    return answer.verdict, len(plan.ticks), len(plan.starts), plan.minimal_ticks, plan.minimal_starts


@pytest.mark.parametrize("bad", ["Sleeping", "Failing", "Dying", "Lying"])
def test_no_lane_takes_the_answer_with_it(worked_example: Automaton, bad: str) -> None:
    with closing(Asking(worked_example, bad, "bmc")) as asking:
        for _ in range(2):
            answer = asking.answer()
            assert answer.verdict is Verdict.FOUND
            assert answer.engine == "bmc"
            assert answer.plan is not None
            assert answer.plan.minimal_starts


@pytest.mark.parametrize(
    ("bad", "why"), [("Failing", "of its own making"), ("Lying", "replay"), ("Dying", "has ended")]
)
def test_without_another_engine_it_says_why_there_is_no_answer(worked_example: Automaton, bad: str, why: str) -> None:
    with closing(Asking(worked_example, bad)) as asking, pytest.raises(PlannerError, match=why):
        asking.answer()


@pytest.mark.parametrize("contract", Contract)
def test_a_deadline_is_kept_by_lanes_that_cannot_be_interrupted(worked_example: Automaton, contract: Contract) -> None:
    with closing(Asking(worked_example, "Sleeping", "Patient")) as asking:
        for _ in range(2):
            began = time.monotonic()
            answer = asking.answer(0.3, contract)
            assert 0.25 < time.monotonic() - began < patience(0.7)
            assert answer.verdict is Verdict.LATE


def test_a_lane_that_does_not_come_back_is_replaced_and_answers_again(
    worked_example: Automaton, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(racing, "PATIENCE", 0.2)
    with closing(Asking(worked_example, "bmc")) as asking:
        assert asking.answer().plan is not None
        lane = asking.race._lanes["bmc"]
        until(lambda: lane._back == lane._number)  # else it is the question before from which it does not come back
        still = the("bmc")
        assert still.pid is not None
        os.kill(still.pid, signal.SIGSTOP)
        began = time.monotonic()
        assert asking.answer(0.2).verdict is Verdict.LATE
        assert time.monotonic() - began < patience(0.7)
        until(lambda: still.poll() is not None)
        until(lambda: bool(processes()))
        assert asking.answer().plan is not None


def test_a_lane_is_given_time_to_start(worked_example: Automaton, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(racing, "PATIENCE", 0.2)
    with closing(Asking(worked_example, "Slow")) as asking:
        first = the("Slow").pid
        assert asking.answer(0.1).verdict is Verdict.LATE
        until(lambda: asking.answer(0.3).searched == 3)
        assert the("Slow").pid == first


def test_a_lane_is_given_no_time_for_ever_to_start(worked_example: Automaton, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(racing, "STARTING", 0.1)
    with closing(Asking(worked_example, "Slow")) as asking:
        seen: set[int | None] = set()

        def another() -> bool:
            seen.update(each.pid for each in processes())
            return len(seen) > 1

        assert asking.answer(0.1).verdict is Verdict.LATE
        until(another)


def test_a_lane_that_is_killed_in_mid_search_ends_the_race_at_once_and_is_there_for_the_next(
    worked_example: Automaton,
) -> None:
    with closing(Asking(worked_example, "Patient")) as asking:
        assert asking.answer(0.1).verdict is Verdict.LATE  # it has started now, or soon
        first = the("Patient")
        threading.Timer(0.3, first.kill).start()
        with pytest.raises(PlannerError, match="has ended"):
            asking.answer(30)
        until(lambda: [each.pid for each in processes()] not in ([], [first.pid]))
        until(lambda: asking.answer(0.2).searched == 3)


def test_a_request_is_called_off_from_another_thread(worked_example: Automaton) -> None:
    with closing(Asking(worked_example, "Patient")) as asking:
        budget = Budget.seconds(60)
        threading.Timer(0.2, budget.call_off).start()
        began = time.monotonic()
        answer = asking.planner.answer(asking.request, budget)
        assert time.monotonic() - began < patience(1)
        assert answer.plan is None


def test_an_engine_may_not_eat_the_machine_s_memory(worked_example: Automaton) -> None:
    asked = closing(Asking(worked_example, "Greedy", memory=2**29))
    with asked as asking, pytest.raises(PlannerError, match="MemoryError"):
        asking.answer()


def test_a_proof_by_one_lane_answers_for_all(worked_example: Automaton) -> None:
    with closing(Asking(worked_example, "Sleeping", "Proving")) as asking:
        answer = asking.answer()
        assert answer.verdict is Verdict.NONE_AT_ALL
        assert answer.proof == Proof("Proving", ())
        assert answer.engine == "Proving"
        assert answer.left_out == GOAL


@ONLY_TIMED
def test_a_warm_race_costs_little_more_than_its_engine(worked_example: Automaton) -> None:
    with closing(Asking(worked_example, "bmc")) as asking:
        asking.answer()
        took = []
        for _ in range(20):
            began = time.monotonic()
            asking.answer()
            took.append(time.monotonic() - began)
        assert sorted(took)[5] < 0.1
