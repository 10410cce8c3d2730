"""Plans to something that a person wants to hold, as the adviser finds them, and why there is none."""

from __future__ import annotations

from dataclasses import dataclass

from sequence_planner.control.adviser import Adviser
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.planning.advice.offer import Offer
from sequence_planner.planning.advice.request import ErrandRequest
from sequence_planner.planning.plan import Goal
from sequence_planner.planning.reasons.diagnosis import Diagnosis, DiagnosisRequest

WAITING = 3.0  # seconds beyond a request's deadline: the adviser may be at something else
GOAL = "asked for"  # its name in reasons
AIMED_WITHIN = 5.0  # seconds a plan may take
EXPLAINED_WITHIN = 5.0  # seconds, where nothing was found


@dataclass(frozen=True)
class Aimed:
    """What there is to offer; or that there is nothing, which may be `proven`, and why, as far as that was found."""

    offer: Offer | None
    proven: bool = False
    why_not: Diagnosis | None = None


async def aim(adviser: Adviser, request: ErrandRequest) -> Aimed:
    """Ask for a plan, and where there is none for the reasons. Raises `CommandRefused`."""
    advice = await adviser.answer(request, request.deadline + WAITING)
    if advice.offers:
        return Aimed(advice.offers[0])
    goal = Goal(GOAL, request.target)
    reasons = DiagnosisRequest(request.state, (goal,), request.circumstances, EXPLAINED_WITHIN)
    try:
        diagnosis = await adviser.answer(reasons, EXPLAINED_WITHIN + WAITING)
    except CommandRefused:
        return Aimed(None, advice.complete)
    if diagnosis.reason is None:
        return Aimed(None, advice.complete)
    return Aimed(None, proven=True, why_not=diagnosis)
