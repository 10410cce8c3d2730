"""Builds what people do at a station that is not as it should be: corrections, plans, tests, forces, approvals."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from sequence_planner.controller.commands.approvals import ApprovedCommand, ForceVariable
from sequence_planner.controller.commands.bus import Handler
from sequence_planner.controller.features.approvals import Approvals
from sequence_planner.controller.features.commissioning import Breakpoints, Forces
from sequence_planner.controller.features.control_lock import ControlLock
from sequence_planner.controller.planner_client import AdvisorClient
from sequence_planner.controller.recovery.consistency import ConsistencyMonitor
from sequence_planner.controller.recovery.corrections import Corrections
from sequence_planner.controller.recovery.explain import ConditionContext, TellsBelief
from sequence_planner.controller.recovery.proposals import Offers
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.controller.recovery.trials import Trials
from sequence_planner.controller.recovery.why_not import WhyNot
from sequence_planner.execution.executor import Executor
from sequence_planner.synthesis.guards import SupervisorGuard


def build_recovery(
    execution: Executor,
    advisor: AdvisorClient,
    beliefs: TellsBelief,
    consistency: ConsistencyMonitor,
    still: StallDetector,
    in_control: ControlLock,
    feeds: Mapping[str, str],
    timed: frozenset[str],
    since: Callable[[str], float | None],
    guards: Callable[[], Mapping[str, SupervisorGuard]],
    real_devices: Callable[[], Sequence[str]],
    perform: Handler,
) -> tuple[ConditionContext, Forces, Breakpoints, Approvals, tuple[object, ...]]:
    """Build what explanations draw on, the features that build.py names, and all others.

    `perform` carries out what two people have agreed on.
    """
    around = ConditionContext(feeds, since, beliefs, guards, timed)
    forces = Forces(execution)

    def require_feasible(command: ApprovedCommand) -> None:
        if isinstance(command, ForceVariable):
            forces.check(command)
        else:
            corrections.check(command)

    approvals = Approvals(execution, in_control, require_feasible, perform)
    corrections = Corrections(execution, advisor.answer, beliefs, consistency, approvals.require_one)
    offers = Offers(execution, advisor, corrections.correct, consistency.impossible, still)
    others = (corrections, offers, Trials(execution, around, real_devices), WhyNot(execution, around, advisor))
    return around, forces, Breakpoints(execution), approvals, others
