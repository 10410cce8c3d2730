"""Engines in turn, and lanes only for what these do not answer soon: no answer is lost, and nothing stands still."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from multiprocessing.connection import Connection, Pipe

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.forking.starting import start
from sequence_planner.planning.planner import Planner, PlanningAttempt
from sequence_planner.planning.portfolio import escalation
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.portfolio.engines import ALONE, FACTORIES, Engines
from sequence_planner.planning.portfolio.escalation import Escalation
from sequence_planner.planning.portfolio.race import Portfolio
from sequence_planner.planning.problem import Contract, PlanAnswer, PlanRequest, Verdict, goals_of
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import synthesise
from support.examples import examples
from support.waiting import PATIENCE, patience, until

from .choices import made_by
from .random_problems import Problem, problem
from .test_race import GOAL, OWN, Engine, lanes, processes, shape


class Spinning(Engine):
    """Keeps all other threads out, like a solver in C that holds the interpreter."""

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        re.match("(a+)+$", "a" * 64 + "b")
        return Finding()


class Unproven(Engine):
    """Has a plan in its first turn, however long that takes, and says nothing of a better one."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        super().__init__(automaton, supervisor)
        self._projection = FACTORIES["projection"](automaton, supervisor)

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        return self._projection.solve(task, Budget.seconds(PATIENCE))


HERE = {**FACTORIES, **OWN, "Spinning": Spinning, "Unproven": Unproven}


@contextmanager
def planner(automaton: Automaton, here: tuple[str, ...] | None, *raced: str) -> Iterator[Planner]:
    """One whose engines `here` take turns, and which has lanes of one engine each."""
    supervisor = synthesise(automaton)
    (lane,) = lanes("alone")
    engines = None
    if here is not None:
        engines = Engines(automaton, supervisor, type(lane)("alone", dict.fromkeys(Contract, here)), HERE)
    solvers = Escalation(engines, partial(Portfolio, automaton, supervisor, lanes(*raced), {**FACTORIES, **OWN}))
    try:
        yield Planner(automaton, supervisor, solvers)
    finally:
        solvers.close()
        assert not processes()


def asked(planner: Planner, automaton: Automaton, deadline: float, contract: Contract = Contract.FAST) -> PlanAnswer:
    request = PlanRequest(initial_state(automaton), goals_of(automaton, GOAL), deadline, contract=contract)
    return planner.answer(request)


@examples(10)
@given(made_by(lambda choices: problem(choices, unknown=choices.chance(4), demanding=choices.chance(2))))
def test_it_answers_as_the_engines_in_turn_do(given_: Problem) -> None:
    request = PlanRequest(given_.state, given_.goals, 60, longest=7, circumstances=given_.circumstances)
    model = given_.automaton, given_.supervisor
    alone = Planner(*model)
    solvers = Escalation(Engines(*model, ALONE), partial(Portfolio, *model))
    here = Planner(*model, solvers)
    one, other = alone.answer(request), here.answer(request)
    solvers.close()
    assert (one.goals, one.left_out, shape(one)) == (other.goals, other.left_out, shape(other))


def test_what_is_answered_soon_needs_no_process(worked_example: Automaton) -> None:
    with planner(worked_example, ALONE.engines[Contract.FAST], "Proving") as here:
        answer = asked(here, worked_example, 20)
        assert answer.verdict is Verdict.FOUND
        assert not processes()


def test_lanes_go_on_with_what_takes_long_and_end_when_they_are_not_needed_any_more(
    worked_example: Automaton, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(escalation, "ALONE_FOR", 0.1)
    monkeypatch.setattr(escalation, "RESTS_AFTER", 0.3)
    with planner(worked_example, ("Patient",), "bmc") as here:
        for _ in range(2):
            answer = asked(here, worked_example, 30, Contract.MINIMAL)
            assert answer.engine == "bmc"
            assert len(processes()) == 1
            here = Planner(worked_example, synthesise(worked_example), here._solvers)  # which knows nothing yet
        until(lambda: not processes())
        assert asked(here, worked_example, 30, Contract.MINIMAL).engine == "bmc"


def test_there_are_no_lanes_for_a_plan_that_could_be_better(
    worked_example: Automaton, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(escalation, "ALONE_FOR", 0.1)
    with planner(worked_example, ("Unproven", "Patient"), "bmc") as here:
        began = time.monotonic()
        answer = asked(here, worked_example, 0.5, Contract.MINIMAL)
        assert 0.4 < time.monotonic() - began < patience(0.9), "it was looked for a better one"
        assert answer.plan is not None
        assert not processes()


def test_there_are_no_lanes_where_all_engines_have_said_what_they_know(worked_example: Automaton) -> None:
    with planner(worked_example, ("Failing", "bmc"), "Proving") as here:
        assert asked(here, worked_example, 20).engine == "bmc"
    with planner(worked_example, ("Proving",), "bmc") as here:
        assert asked(here, worked_example, 20).verdict is Verdict.NONE_AT_ALL
        assert not processes()


def test_where_an_engine_may_end_the_process_lanes_are_asked_at_once(worked_example: Automaton) -> None:
    with planner(worked_example, None, "Dying", "bmc") as here:
        assert asked(here, worked_example, 20).engine == "bmc"


@pytest.mark.parametrize("engine", ["Sleeping", "Spinning"])
def test_an_engine_that_does_not_come_back_ends_the_process(engine: str, worked_example: Automaton) -> None:
    ours, theirs = Pipe()
    process = start(hang, engine, worked_example, name="hanging", connection=theirs)
    assert ours.recv() == "begun"
    began = time.monotonic()
    assert process.wait(20) == 1
    assert time.monotonic() - began < patience(10)


def hang(connection: Connection, engine: str, automaton: Automaton) -> None:
    """The life of a process that asks an engine which does not come back."""
    escalation.ALONE_FOR, escalation.PATIENCE = 0.2, 0.3
    with planner(automaton, (engine,)) as here:
        connection.send("begun")
        asked(here, automaton, 30)


def test_its_attempt_has_no_more_than_its_share_of_the_time(worked_example: Automaton) -> None:
    supervisor = synthesise(worked_example)
    (lane,) = lanes("Patient")
    solvers = Escalation(
        Engines(worked_example, supervisor, lane, HERE),
        partial(Portfolio, worked_example, supervisor, lanes("Patient"), OWN),
    )
    goals = goals_of(worked_example, GOAL)
    whole = Budget.seconds(20)
    attempt = PlanningAttempt(
        PlanningTask(initial_state(worked_example), goals), lambda plan: True, Budget.seconds(0.4)
    )
    began = time.monotonic()
    solvers.solve(attempt, whole)
    assert 0.35 < time.monotonic() - began < patience(2)
    solvers.close()
