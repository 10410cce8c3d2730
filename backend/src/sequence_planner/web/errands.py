"""Plans that a person may take: what the advisor offers, a goal by hand, the reset of an operation.

Asking changes nothing. What is offered belongs to the state it was made for, and is refused once the station has moved.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Response
from pydantic import Field

from sequence_planner.control.asks import LONGEST_PREDICATE, AskAdvice, AskGoal, AskReset
from sequence_planner.control.offer_view import AdviceView, OfferView
from sequence_planner.control.restart_commands import GivenValue, StopErrand, TakeErrand
from sequence_planner.identity.roles import Role
from sequence_planner.journal.entry import LONGEST_REASON
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body, Reason
from sequence_planner.web.carried_out import CARRIED_OUT, carried_out
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller

MOST_STARTS = 150  # of a plan that a person confirms start by start; a body holds no more
OPERATOR, ENGINEER = allowed(Role.OPERATOR), allowed(Role.ENGINEER)
advice_router = interface(tags=["restart"], responses=refused(409, 504))
router = interface("/errands", tags=["restart"], dependencies=[JSON_ONLY], responses=refused(409, 504))


class GoalBody(Body):
    """What shall hold, in the model's language."""

    predicate: Annotated[str, Field(min_length=1, max_length=LONGEST_PREDICATE)]


class ResetBody(Body):
    """The operation whose precondition shall hold again."""

    operation: Annotated[str, Field(min_length=1, max_length=200)]


class ErrandBody(Body):
    """The offer, and all that it contains as the person has seen it: the starts in order, and the corrections."""

    offer: Annotated[str, Field(min_length=1, max_length=100)]
    starts: Annotated[list[Annotated[str, Field(max_length=200)]], Field(max_length=MOST_STARTS)]
    corrections: Annotated[dict[str, GivenValue], Field(default_factory=dict, max_length=200)]
    reason: Annotated[str, Field(min_length=1, max_length=LONGEST_REASON)]


class StopBody(Body):
    """To stop is all that there is to say, but perhaps why."""

    reason: Reason = None


@advice_router.get("/advice", dependencies=[OPERATOR])
async def advice(client: Controller) -> AdviceView:
    """Proven ways on from the present state, the least effort first, each with its plan.

    409 `errand-under-way` while a plan is being carried out. With an offer in `obstacle` stands what to do first.
    """
    return await client.ask(AskAdvice())


@router.post("/goal-preview", dependencies=[ENGINEER])
async def preview_goal(body: GoalBody, client: Controller) -> OfferView:
    """A plan to whatever shall hold, to be looked at and perhaps taken.

    422 `bad-predicate` names the place; 409 `goal-holds` and `no-plan` say why there is nothing to take.
    """
    return await client.ask(AskGoal(predicate=body.predicate))


@router.post("/reset-preview", dependencies=[OPERATOR], responses=refused(404))
async def preview_reset(body: ResetBody, client: Controller) -> OfferView:
    """A plan to the precondition of an operation, from which it begins anew; 409 `no-plan` where there is none."""
    return await client.ask(AskReset(operation=body.operation))


@router.post("", status_code=204, dependencies=[OPERATOR], responses=refused(422))
async def take_errand(body: ErrandBody, client: Controller, actor: Actor) -> None:
    """Make the corrections of an offer and have its plan carried out, and nothing else. It takes control.

    409 `offer-gone` and `state-moved` ask to look again; `not-confirmed`: starts and corrections are not the offer's.
    """
    command = TakeErrand(
        actor=actor, offer=body.offer, starts=body.starts, corrections=body.corrections, reason=body.reason
    )
    await client.send(command)


@router.post("/stop", status_code=204, dependencies=[OPERATOR], responses=CARRIED_OUT)
async def stop_errand(body: StopBody, client: Controller, actor: Actor) -> Response:
    """Start no more of what is carried out; what runs goes on to its end. Anybody who may act can do it.

    200 says that it was done and the journal does not have it yet.
    """
    return carried_out(await client.send(StopErrand(actor=actor, reason=body.reason)))
