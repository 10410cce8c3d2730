"""Webhooks: other systems that are told of events. A secret is answered once, when the webhook is made."""

from __future__ import annotations

from functools import partial
from typing import Annotated, Any

from fastapi import Depends, Query, Request, Response
from pydantic import Field, StrictInt

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.mes.events import EventKind
from sequence_planner.mes.webhooks import deliveries
from sequence_planner.mes.webhooks import endpoints as webhooks
from sequence_planner.mes.webhooks.deliveries import DeadLetter
from sequence_planner.mes.webhooks.delivery import Deliverer, resolved
from sequence_planner.mes.webhooks.endpoints import Seal, Webhook, key_file
from sequence_planner.mes.webhooks.targets import LONGEST_URL, TargetRefused, Targets
from sequence_planner.server.api.history import LARGEST_NUMBER, MOST_RECORDS
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Actor, AnswerModel, Body, Identifier, Identity, Name
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.texts.message import message

ADMINISTRATOR = allowed(Role.ADMINISTRATOR, scope=Scope.WEBHOOKS)
bodiless = interface("/webhooks", tags=["webhooks"], dependencies=[ADMINISTRATOR])
router = interface("/webhooks", tags=["webhooks"], dependencies=[ADMINISTRATOR, JSON_ONLY])

MADE: dict[str, Any] = {
    "headers": {
        "Location": {
            "description": "Where the webhook is.",
            "required": True,
            "schema": {"type": "string", "format": "uri-reference"},
        }
    }
}
Number = Annotated[StrictInt, Field(ge=0, le=LARGEST_NUMBER)]


class AllowedAnswer(AnswerModel):
    """Allowed destinations of webhooks: hosts with their ports, and networks; with `loopback` also this machine."""

    hosts: list[str]
    networks: list[str]
    loopback: bool


class WebhooksAnswer(AnswerModel):
    """All webhooks, the newest first, and where whoever runs the station lets them go."""

    webhooks: list[Webhook]
    allowed: AllowedAnswer


class WebhookBody(Body):
    """A new webhook: what people call it, where events are sent to, and of which kinds; none are all.

    It is told of the events after the one with the number `after`; without, of those that are still to come.
    """

    title: Name
    url: Annotated[str, Field(min_length=1, max_length=LONGEST_URL)]
    kinds: list[EventKind] = Field(default_factory=list, max_length=100)
    after: Number | None = None


class NewWebhookAnswer(AnswerModel):
    """A webhook and its secret, which is shown this once."""

    webhook: Webhook
    secret: str


class DeadLettersAnswer(AnswerModel):
    """Events that were given up, the oldest first; `next` is the `after` with which to ask for what comes then."""

    dead_letters: list[DeadLetter]
    next: int


class AgainBody(Body):
    """The numbers of the events to send again; null: all that were given up."""

    events: Annotated[list[Number], Field(max_length=MOST_RECORDS)] | None = None


class AgainAnswer(AnswerModel):
    """Number of events that are sent again."""

    events: int


async def _targets(request: Request) -> Targets:
    """Return where webhooks may go."""
    targets: Targets = request.app.state.settings.webhooks
    return targets


AllowedTargets = Annotated[Targets, Depends(_targets)]


@bodiless.get("")
async def list_webhooks(identity: Identity, targets: AllowedTargets) -> WebhooksAnswer:
    """All webhooks, without their secrets, and how it goes with each; and where they may go."""
    networks = [str(each) for each in targets.networks]
    where = AllowedAnswer(hosts=targets.written, networks=networks, loopback=targets.loopback)
    return WebhooksAnswer(webhooks=await identity.read(webhooks.everyone), allowed=where)


@bodiless.get("/{webhook}", responses=refused(404))
async def read_webhook(webhook: Identifier, identity: Identity) -> Webhook:
    """A webhook, without its secret, and how it goes with it."""
    return await identity.read(lambda connection: webhooks.get(connection, webhook))


@router.post("", status_code=201, responses={201: MADE, **refused(409)})
async def create_webhook(
    body: WebhookBody,
    request: Request,
    response: Response,
    identity: Identity,
    actor: Actor,
    targets: AllowedTargets,
) -> NewWebhookAnswer:
    """Make a webhook. Its secret is answered this once; deliveries are signed with it."""
    try:
        await resolved(targets, targets.target(body.url))
    except TargetRefused as refusal:
        raise ProblemFound(
            422, "webhook-target-refused", message("refused.webhook-target-refused.why", why=refusal.why)
        ) from None
    seal, now = Seal(key_file(identity.database.place)), identity.now()
    secret, webhook = await identity.write(
        lambda connection: webhooks.make(connection, seal, body.title, body.url, body.kinds, body.after, actor, now),
        by=actor,
    )
    deliverer: Deliverer = request.app.state.deliverer
    deliverer.on_webhook()
    response.headers["Location"] = request.url_for("read_webhook", webhook=webhook.id).path
    return NewWebhookAnswer(webhook=webhook, secret=secret)


@bodiless.delete("/{webhook}", status_code=204, responses=refused(404))
async def remove_webhook(webhook: Identifier, identity: Identity, actor: Actor) -> None:
    """Tell it of nothing more; what was not delivered yet is not sent any more."""
    now = identity.now()
    await identity.write(lambda connection: webhooks.remove(connection, webhook, actor, now), by=actor)


@bodiless.get("/{webhook}/dead-letters", responses=refused(404))
async def dead_letters(
    webhook: Identifier,
    identity: Identity,
    after: Annotated[int, Query(ge=0, le=LARGEST_NUMBER)] = 0,
    limit: Annotated[int, Query(ge=1, le=MOST_RECORDS)] = 50,
) -> DeadLettersAnswer:
    """The events that were given up after many attempts, and why."""
    found = await identity.read(partial(deliveries.dead_letters, webhook=webhook, after=after, limit=limit))
    return DeadLettersAnswer(dead_letters=found, next=found[-1].event.number if found else after)


@router.post("/{webhook}/dead-letters/retry", responses=refused(404))
async def retry_dead_letters(webhook: Identifier, body: AgainBody, identity: Identity, actor: Actor) -> AgainAnswer:
    """Try events once more that were given up."""
    now = identity.now()
    count = await identity.write(
        lambda connection: deliveries.send_again(connection, webhook, body.events, actor, now), by=actor
    )
    return AgainAnswer(events=count)
