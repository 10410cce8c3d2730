"""State of the station at any journal record, and its view."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.views.execution import force_views, operator_plan_view, packml, service_views
from sequence_planner.controller.views.jobs import job_views
from sequence_planner.controller.views.station import StepStatus
from sequence_planner.controller.views.wording import reason_text
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.outlook import simulate_plan
from sequence_planner.execution.plan_tracker import PlannedStart
from sequence_planner.execution.record.codec import HistoryError
from sequence_planner.execution.record.replay import Replayed, replay
from sequence_planner.history.timeline import (
    MomentView,
    PastPlanView,
    PastStepView,
    PastView,
    record_view,
    standing_alarms,
)
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.texts.message import message

# How the station was at any record of the journal.


def looking_back(run: WholeRun, automaton: Automaton, supervisor: Supervisor, number: int) -> Replayed:
    """A record, with the execution as it was right after it.

    Raises `HistoryError` if there is no such record, if it cannot be replayed, or is not replayed as it was written.
    """
    if run.get(number) is None:
        begin = run.last_trimmed.number
        raise HistoryError(
            "no-record",
            message("refused.no-record.trimmed", number=number, begin=begin)
            if number <= begin
            else message("refused.no-record.number", number=number),
        )
    last: Replayed | None = None
    for last in replay(run, automaton, supervisor, number, number):
        if last.difference is not None:
            raise HistoryError(
                "history-differs", message("refused.history-differs.record", number=number, why=last.difference)
            )
    if last is None or last.record.number != number:
        raise HistoryError("history-gone", message("refused.history-gone.record", number=number))
    return last


# An execution of the past, as it is shown.


CalledOff = Collection[tuple[str, float]]  # an ability, and when its run was called off


def moment_view(run: WholeRun, replayed: Replayed) -> MomentView:
    """A moment as it is shown."""
    number = replayed.record.number
    ends = {step.ended.epoch for step in replayed.execution.plan.order.past if step.ended is not None}
    return MomentView(
        record=record_view(replayed.record),
        past=past_view(replayed.execution, called_off(record for end in ends for record in _written_at(run, end))),
        alarms=standing_alarms(run, number),
    )


def called_off(records: Iterable[RunRecord]) -> CalledOff:
    """Return what was called off according to these records."""
    telling = (each for each in records if '"called_off":' in each.content)
    return {(name, each.time) for each in telling for name in json.loads(each.content)["called_off"]}


def _written_at(run: WholeRun, time: float) -> Iterable[RunRecord]:
    """The records of a time."""
    number = run.at(time)
    while (record := run.get(number)) is not None and record.time == time:
        yield record
        number -= 1


def past_view(execution: Executor, called_off: CalledOff = ()) -> PastView:
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
        plan=_plan(execution, called_off),
        errand=operator_plan_view(execution),
        forces=force_views(conduct),
        out_of_service=service_views(execution.automaton, conduct),
    )


def _plan(execution: Executor, called_off: CalledOff) -> PastPlanView:
    order = execution.plan.order
    outlook = simulate_plan(order, execution.simulated(), execution.automaton)
    serving = {name: outlook.steps_for(name) for name in sorted(execution.active)}

    def view_of(step: PlannedStart, status: StepStatus) -> PastStepView:
        return PastStepView(
            ability=step.ability,
            title=execution.automaton.abilities[step.ability].title,
            status=status,
            tick=step.tick,
            started=None if step.started is None else step.started.epoch,
            ended=None if step.ended is None else step.ended.epoch,
            called_off=step.ended is not None and (step.ability, step.ended.epoch) in called_off,
            operations=[] if step.ended else [name for name, steps in serving.items() if step.number in steps],
        )

    past = [
        view_of(each, StepStatus.DONE if each.ended else StepStatus.RUNNING)
        for each in order.past
        if each.ended is None or each.number >= order.first
    ]
    ahead = [view_of(each, StepStatus.PLANNED if index else StepStatus.NEXT) for index, each in enumerate(order.ahead)]
    reason = reason_text(execution.plan.reason)
    return PastPlanView(status=execution.plan.status, reason=reason, reason_message=reason, steps=past + ahead)
