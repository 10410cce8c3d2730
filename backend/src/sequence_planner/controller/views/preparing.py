"""View of a station that is being prepared, or whose model cannot be run."""

from __future__ import annotations

from sequence_planner.analysis.report import AnalysisDocument
from sequence_planner.controller.alarms.alarm import Alarm
from sequence_planner.controller.alarms.kinds import MODEL_UNUSABLE, NO_SUPERVISOR
from sequence_planner.controller.views.part import ControlView
from sequence_planner.controller.views.station import (
    DeploymentView,
    PackML,
    PlanView,
    StandbyView,
    StationIdentity,
    StationStanding,
    StationView,
)
from sequence_planner.execution.vocabulary import Mode, PlanStatus, Production
from sequence_planner.texts.message import Message, message


def preparing_view(
    identity: StationIdentity,
    now: float,
    began: float,
    analysis: AnalysisDocument | None,
    trouble: str | None,
    standby: StandbyView | None = None,
    deployment: DeploymentView | None = None,
    *,
    control: ControlView | None = None,
    unusable: bool = False,
    too_large: bool = False,
) -> StationView:
    """Return what is shown while the safe set is being computed; with `trouble`, there is none and the station is not
    run.

    `control` is that with which it begins, as far as it is known. It is `unusable` where the model
    means nothing at all, and `too_large` where that set cannot be computed.
    """
    alarms = {}
    if trouble is not None:
        if unusable:
            cause = MODEL_UNUSABLE.cause("", {"trouble": trouble})
        elif too_large:
            cause = NO_SUPERVISOR.cause(
                "",
                {
                    "what": message("no-supervisor.too-large", trouble=trouble),
                    "action": message("no-supervisor.smaller"),
                },
            )
        else:
            what, action = message("no-supervisor.unmet"), message("no-supervisor.see")
            cause = NO_SUPERVISOR.cause("", {"what": what, "action": action})
        alarms[cause.key] = Alarm(cause, began).view()
    plan = PlanView(
        status=PlanStatus.IDLE,
        since=now,
        reason=(reason := _why_no_plan(trouble, unusable=unusable)),
        reason_message=reason,
        steps=[],
        ticks=0,
        minimal_ticks=False,
        minimal_starts=False,
        replanned=0,
        replacement=None,
        contract=None,
        engine="",
        milliseconds=None,
        why=None,
    )
    return StationView(
        station=identity,
        tick=0,
        time=now,
        revision=0,
        mode=Mode.AUTOMATIC,
        packml=PackML.RESETTING,
        standing=StationStanding.PREPARING,
        silent=[],
        failing=[],
        stepping=False,
        cycle_stop=None,
        breakpoints={},
        production=Production.PREPARING,
        unconfirmed=False,
        undecided={},
        control=control,
        resources={},
        variables={},
        abilities={},
        operations={},
        by_order=False,
        jobs={},
        plan=plan,
        errand=None,
        last_errand=None,
        forces={},
        out_of_service=[],
        questions=[],
        last_correction=None,
        who_can=None,
        approvals={},
        tasks={},
        topics={},
        overrides={},
        alarms=alarms,
        named_alarm=None,
        way_back=None,
        analysis=analysis,
        standby=standby,
        deployment=deployment,
    )


def _why_no_plan(trouble: str | None, *, unusable: bool) -> Message:
    if trouble is None:
        return message("plan.preparing")
    return message("plan.unusable" if unusable else "plan.no-supervisor")
