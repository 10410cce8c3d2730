"""The advisor's process: requests in, answers out. It can be killed at any time, and loses nothing."""

from __future__ import annotations

from collections.abc import Callable

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.planning.diagnoser import Diagnoser, DiagnosisModel
from sequence_planner.planning.diagnosis import DiagnosisRequest
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.problem import PlanRequest
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.consultation import Answer, Request
from sequence_planner.planning.recovery.request import AdviceRequest, GoalPlanRequest
from sequence_planner.process.budget import Budget
from sequence_planner.process.worker import Worker
from sequence_planner.synthesis.supervisor import FewerSpecifications


def advisor_process(automaton: Automaton, supervisor: Supervisor) -> Worker[Request, Answer]:
    """Return the process, which may raise `PlannerError`."""
    model = DiagnosisModel(automaton, supervisor, FewerSpecifications(automaton, supervisor))
    return Worker(advising, model, "adviser", errors=(PlannerError,))


def advising(model: DiagnosisModel) -> Callable[[Request, Budget], Answer]:
    """Return what answers each request, which raises `PlannerError`; a process's life."""
    diagnoser = Diagnoser(model)
    advisor = Advisor(model.automaton, model.supervisor, diagnoser.diagnose)
    advisor.prepare()
    planner = Planner(model.automaton, model.supervisor)

    def answer(request: Request, budget: Budget) -> Answer:
        match request:
            case AdviceRequest():
                return advisor.advise(request, budget)
            case GoalPlanRequest():
                return advisor.goal_plan(request, budget)
            case PlanRequest():
                return planner.answer(request, budget)
            case DiagnosisRequest(task=task):
                return diagnoser.diagnose(task, budget)

    return answer
