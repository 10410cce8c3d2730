"""Watches: devices at people's wrists that show the tasks of one resource and acknowledge them.

An operator offers a pairing and reads the code out; the device redeems it; the operator sees the device in the list
and confirms it. Only then is it told anything. Whatever is wrong with a code, the answer is the same.
"""

from __future__ import annotations

from fastapi import Request, Response
from starlette.concurrency import run_in_threadpool

from sequence_planner.control.view import StationView
from sequence_planner.identity import pairing, watches
from sequence_planner.identity.pairing import PairingOffer
from sequence_planner.identity.roles import Role
from sequence_planner.identity.watches import CONFIRMED_WITHIN, LIFE, Watch
from sequence_planner.web.access import allowed, watch_only
from sequence_planner.web.body import Identifier
from sequence_planner.web.cookies import keep_watch
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Address, Agent, Controller, Identity, LiveView
from sequence_planner.web.settings import Settings
from sequence_planner.web.watch_messages import (
    ConfirmationBody,
    NewOfferAnswer,
    OfferAnswer,
    OfferBody,
    PairingBody,
    WatchAnswer,
    WatchesAnswer,
    WatchResource,
    WatchSelfAnswer,
)

OPERATOR = allowed(Role.OPERATOR)
router = interface("/watches", tags=["watches"])


@router.get("", dependencies=[OPERATOR])
async def all_watches(identity: Identity, client: Controller) -> WatchesAnswer:
    """The watches there are or were, the offers that are open, and the resources that a watch can serve."""
    now = identity.now()
    found, offers = await identity.read(
        lambda connection: (watches.all_watches(connection, now), pairing.offers(connection, now))
    )
    return WatchesAnswer(
        watches=[_answered(each) for each in found],
        offers=[_offered(each) for each in offers],
        resources=_resources(client.view) if client.view is not None and client.heard else [],
    )


@router.post("/offers", status_code=201, dependencies=[OPERATOR, JSON_ONLY], responses=refused(409))
async def offer_pairing(body: OfferBody, identity: Identity, actor: Actor, view: LiveView) -> NewOfferAnswer:
    """Offer a pairing. Its code is answered this once and can be redeemed once, within two minutes."""
    if body.resource not in {each.name for each in _resources(view)}:
        detail = f'"{body.resource}" has no tasks for people. Choose one of the resources that GET /watches lists.'
        raise ProblemFound(422, "no-such-resource", "A watch cannot serve this resource", detail)
    now = identity.now()
    code, made = await identity.write(
        lambda connection: pairing.offer(connection, body.name, body.resource, actor, now), by=actor
    )
    return NewOfferAnswer(id=made.id, code=code, expires=made.expires)


@router.delete("/offers/{offer}", status_code=204, dependencies=[OPERATOR], responses=refused(404))
async def withdraw_offer(offer: Identifier, identity: Identity, actor: Actor) -> None:
    """Take an offer back: its code is worth nothing any more."""
    now = identity.now()
    await identity.write(lambda connection: pairing.withdraw_offer(connection, offer, actor, now), by=actor)


@router.post("/pairing", status_code=201, dependencies=[allowed(None), JSON_ONLY], responses=refused(429, 503))
async def pair_watch(
    body: PairingBody, request: Request, response: Response, identity: Identity, address: Address, agent: Agent
) -> WatchSelfAnswer:
    """Redeem a code. The device gets its credential, which is worth nothing before an operator has confirmed it.

    403 `wrong-code` whatever is wrong with it; 429 `too-many-attempts`.
    """
    now = identity.now()
    token, watch = await run_in_threadpool(
        pairing.redeem, identity.database, body.code, now, address=address, agent=agent
    )
    settings: Settings = request.app.state.settings
    keep_watch(response, settings, token, int(CONFIRMED_WITHIN + LIFE))
    return _itself(watch)


@router.post("/{watch}/confirmation", status_code=204, dependencies=[OPERATOR, JSON_ONLY], responses=refused(404, 409))
async def confirm_watch(watch: Identifier, body: ConfirmationBody, identity: Identity, actor: Actor) -> None:
    """Confirm that the device that has redeemed the code is the one that was meant; within two minutes."""
    now = identity.now()
    await identity.write(lambda connection: watches.confirm(connection, watch, actor, now), by=actor)


@router.delete("/{watch}", status_code=204, dependencies=[OPERATOR], responses=refused(404))
async def revoke_watch(watch: Identifier, identity: Identity, actor: Actor) -> None:
    """Refuse a device that waits, or revoke one that was confirmed; within two seconds it is told nothing any more."""
    now = identity.now()
    await identity.write(lambda connection: watches.revoke(connection, watch, actor, now), by=actor)


@router.get("/self", dependencies=[watch_only(waiting=True)])
async def this_watch(request: Request) -> WatchSelfAnswer:
    """What the watch that asks is called, whose tasks it shows, and whether it was confirmed yet."""
    watch: Watch = request.state.watch
    return _itself(watch)


def _resources(view: StationView) -> list[WatchResource]:
    theirs = {ability.resource for ability in view.abilities.values() if ability.human}
    found = [WatchResource(name=name, title=each.title) for name, each in view.resources.items() if name in theirs]
    return sorted(found, key=lambda resource: (resource.title.casefold(), resource.name))


def _answered(watch: Watch) -> WatchAnswer:
    return WatchAnswer.model_validate(watch, from_attributes=True)


def _offered(offer: PairingOffer) -> OfferAnswer:
    return OfferAnswer.model_validate(offer, from_attributes=True)


def _itself(watch: Watch) -> WatchSelfAnswer:
    return WatchSelfAnswer(id=watch.id, name=watch.name, resource=watch.resource, state=watch.state)
