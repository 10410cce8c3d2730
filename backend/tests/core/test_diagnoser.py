"""Diagnoses in their own process: synthesis that takes too long holds nobody up."""

from __future__ import annotations

import threading
import time

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.forking.starting import children
from sequence_planner.planning.diagnoser import Diagnoser, DiagnosisModel
from sequence_planner.planning.diagnosis import Diagnosis, member_text
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Circumstances, goals_of
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import FewerSpecifications, synthesise
from support.waiting import patience


def endless(names: frozenset[str]) -> Supervisor:
    """Stands for the synthesis of a station that is far too large for it."""
    time.sleep(600)
    raise AssertionError(names)


def hopeless(automaton: Automaton) -> PlanningTask:
    everything = Circumstances(offline=frozenset(automaton.resources))
    return PlanningTask(initial_state(automaton), goals_of(automaton, automaton.operations), everything)


def processes() -> list[str]:
    return [child.name for child in children() if child.name == "diagnosis"]


def test_one_that_is_called_off_ends_at_once(worked_example: Automaton) -> None:
    supervisor = synthesise(worked_example)
    diagnoser = Diagnoser(DiagnosisModel(worked_example, supervisor, endless))
    budget = Budget.seconds(60)
    caller = threading.Timer(1.5, budget.call_off)
    caller.start()
    began = time.monotonic()
    assert diagnoser.diagnose(hopeless(worked_example), budget) == Diagnosis(None, ())
    assert time.monotonic() - began < patience(5)
    assert not processes()
    caller.join()


def test_the_process_lives_on_from_answer_to_answer(worked_example: Automaton) -> None:
    supervisor = synthesise(worked_example)
    diagnoser = Diagnoser(DiagnosisModel(worked_example, supervisor, FewerSpecifications(worked_example, supervisor)))
    try:
        for _ in range(2):
            diagnosis = diagnoser.diagnose(hopeless(worked_example), Budget.seconds(60))
            assert diagnosis.reason is not None
            assert any(member_text(member).endswith("is offline") for member in diagnosis.reason.members)
            assert len(processes()) == 1
    finally:
        diagnoser.close()
    assert not processes()
