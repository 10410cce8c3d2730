"""Why an ability does not start, an operation is not active or not done, or a goal does not hold."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import Path

from sequence_planner.control.asks import AskWhyNot
from sequence_planner.control.why_not_view import WhyNotView
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.web.access import allowed
from sequence_planner.web.errands import ENGINEER, GoalBody
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Controller

router = interface("/why-not", tags=["station"], responses=refused(504))


@router.get("/{of}/{name}", dependencies=[allowed(Role.VIEWER, scope=Scope.READ)], responses=refused(404))
async def why_not(
    of: Literal["ability", "operation"], name: Annotated[str, Path(max_length=400)], client: Controller
) -> WhyNotView:
    """What keeps an ability from starting, or an operation from being active or completed, and who could change it."""
    return await client.ask(AskWhyNot(of=of, name=name))


@router.post("/goal", dependencies=[ENGINEER, JSON_ONLY])
async def why_not_goal(body: GoalBody, client: Controller) -> WhyNotView:
    """What keeps a predicate from being true, and whether the station could reach it; 422 `bad-predicate`."""
    return await client.ask(AskWhyNot(of="goal", name=body.predicate))
