"""An execution of the past, as it is shown."""

from __future__ import annotations

from sequence_planner.control.execution import Execution
from sequence_planner.control.start_order import Step
from sequence_planner.control.view import StepStatus
from sequence_planner.control.viewing_conduct import errand_view, force_views, packml, service_views
from sequence_planner.control.viewing_jobs import job_views
from sequence_planner.history.replay import Replayed
from sequence_planner.history.view import MomentView, PastPlanView, PastStepView, PastView, record_view


def moment_view(replayed: Replayed) -> MomentView:
    """A moment as it is shown."""
    return MomentView(record=record_view(replayed.record), past=past_view(replayed.execution))


def past_view(execution: Execution) -> PastView:
    """An execution as it is shown."""
    conduct, state = execution.conduct, execution.state
    return PastView(
        tick=execution.ticks,
        revision=execution.revision,
        mode=execution.mode,
        packml=packml(execution),
        production=execution.production,
        stepping=conduct.stepping,
        values={name: state[name] for name in execution.automaton.variables},
        running=sorted(execution.running()),
        active=sorted(execution.active),
        by_order=conduct.jobs.by_order,
        jobs=job_views(execution),
        plan=_plan(execution),
        errand=errand_view(execution),
        forces=force_views(conduct),
        out_of_service=service_views(execution.automaton, conduct),
    )


def _plan(execution: Execution) -> PastPlanView:
    order = execution.plan.order
    past = [_step(execution, each, StepStatus.DONE if each.ended else StepStatus.RUNNING) for each in order.past]
    ahead = [
        _step(execution, each, StepStatus.PLANNED if index else StepStatus.NEXT)
        for index, each in enumerate(order.ahead)
    ]
    return PastPlanView(status=execution.plan.status, reason=execution.plan.reason, steps=past + ahead)


def _step(execution: Execution, step: Step, status: StepStatus) -> PastStepView:
    return PastStepView(
        ability=step.ability,
        title=execution.automaton.abilities[step.ability].title,
        status=status,
        tick=step.tick,
        started=None if step.started is None else step.started.epoch,
        ended=None if step.ended is None else step.ended.epoch,
    )
