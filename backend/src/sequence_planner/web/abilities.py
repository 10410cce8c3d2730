"""Abilities one by one: how one is defined, what of that holds now, and a trial of it alone."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path
from pydantic import Field, StrictBool

from sequence_planner.control.asks import AskDefinition
from sequence_planner.control.definition_view import AbilityDefinitionView
from sequence_planner.control.restart_commands import TryAbility
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body, Reason
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller

LONGEST_ABILITY = 400  # characters
router = interface(tags=["abilities"])


class TrialBody(Body):
    """`real_devices` confirms that devices may move which are not emulated ones."""

    ability: Annotated[str, Field(min_length=1, max_length=LONGEST_ABILITY)]
    real_devices: StrictBool = False
    reason: Reason = None


@router.get(
    "/abilities/{name}/definition",
    dependencies=[allowed(Role.VIEWER, scope=Scope.READ)],
    responses=refused(404, 504),
)
async def ability_definition(
    name: Annotated[str, Path(max_length=LONGEST_ABILITY)], client: Controller
) -> AbilityDefinitionView:
    """Its guards, actions and expected reactions as they are written, what of them holds now, and its last trial."""
    return await client.ask(AskDefinition(ability=name))


@router.post(
    "/trials",
    status_code=204,
    dependencies=[JSON_ONLY, allowed(Role.ENGINEER)],
    responses=refused(404, 409, 422, 504),
)
async def try_ability(body: TrialBody, client: Controller, actor: Actor) -> None:
    """Start the ability alone, at once; `POST /errands/stop` ends that. It takes control, and the paused mode.

    409 `not-startable` says what its guards or the supervisor lack; `real-devices`: they have not been confirmed.
    """
    await client.send(TryAbility(actor=actor, ability=body.ability, real_devices=body.real_devices, reason=body.reason))
