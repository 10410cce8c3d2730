"""Routes of smartwatches: pairing, confirmation and revocation, and their REST and stream schemas."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import Request, Response
from pydantic import Field, RootModel
from starlette.concurrency import run_in_threadpool

from sequence_planner.auth import watches
from sequence_planner.auth import watches as pairing
from sequence_planner.auth.roles import Role
from sequence_planner.auth.watches import CONFIRMED_WITHIN, LIFE, PairingOffer, Watch, WatchState
from sequence_planner.controller.commands.queries import AboutNames
from sequence_planner.controller.views.details import NamesView
from sequence_planner.controller.views.station import AlarmState, Priority, StationStanding, StationView, TaskView
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.server.auth import allowed, watch_only
from sequence_planner.server.dependencies import (
    JSON_ONLY,
    Actor,
    Address,
    Agent,
    AnswerModel,
    Body,
    Controller,
    Identifier,
    Identity,
    LiveView,
    Name,
)
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.http.credentials import keep_watch
from sequence_planner.server.interface import interface
from sequence_planner.server.settings import Settings
from sequence_planner.server.stream.messages import Silence, StreamError, StreamPart
from sequence_planner.texts.message import Message, message

# What is said of watches over REST, and on the WebSocket `/api/v1/wearables/stream`.
#
# Times are in seconds since the epoch.


class WatchAnswer(AnswerModel):
    """A watch, as operators see it; `paired_by` is the name of who let it in.

    `agent` is what its browser calls itself; it was paired from `address`.
    """

    id: str
    name: str
    resource: str
    state: WatchState
    paired_by: str
    created: float
    expires: float
    last_seen: float
    agent: str
    address: str


class OfferAnswer(AnswerModel):
    """A pairing that nobody has redeemed yet. Its code is not told again."""

    id: str
    name: str
    resource: str
    offered_by: str
    expires: float


class WatchResource(AnswerModel):
    """A resource that has tasks for people, so that a watch can serve it."""

    name: str
    title: str


class WatchesAnswer(AnswerModel):
    """All watches and open offers, the newest first, and the resources to choose from.

    There are no resources while the controller is not heard.
    """

    watches: list[WatchAnswer]
    offers: list[OfferAnswer]
    resources: list[WatchResource]


class OfferBody(Body):
    """A watch is to be paired: what it will be called, and whose tasks it shows."""

    name: Name
    resource: Annotated[str, Field(min_length=1, max_length=200)]


class NewOfferAnswer(AnswerModel):
    """The code to type in on the watch until `expires`; it is shown this once."""

    id: str
    code: str
    expires: float


class PairingBody(Body):
    """The code that an operator has read out."""

    code: Annotated[str, Field(min_length=1, max_length=32)]


class ConfirmationBody(Body):
    """Nothing: to confirm is all that there is to say."""


class WatchSelfAnswer(AnswerModel):
    """A watch's own data."""

    id: str
    name: str
    resource: str
    state: WatchState


class WatchAlarm(AnswerModel):
    """What is wrong where help is needed, and what to do: in English, and as messages for other languages."""

    text: str
    action: str
    message: Message
    action_message: Message | None
    priority: Priority
    state: AlarmState
    since: float


class WatchNext(AnswerModel):
    """What the plan has for the watch's own resource next, and `at` about which time, where that is known."""

    ability: str
    title: str
    at: float | None


class WatchProgress(AnswerModel):
    """How many operations of the order in work, or else of the present round, are `done`, of how many in `all`."""

    done: int
    all: int


class WatchDoing(AnswerModel):
    """Something that a device does now."""

    ability: str
    title: str


class WatchSnapshot(StreamPart):
    """The tasks of the watch's own resource, by id, as of `time`; `station` is the station's title. `age` is as in the
    station's own stream.

    `standing` says whether anything starts by itself, `silent` which devices are not heard, `failing` which of
    the others do not do what they should. Where any of these means that help is needed, `alarm` is the most urgent one.
    `next` is null where nothing is planned, or nothing starts by itself; `progress` where nothing is in work.
    `doing` is what devices do now by the plan; `awaits_order` says that nothing is made as no order may start.
    """

    kind: Literal["watch"]
    time: float
    age: float | None
    station: str
    mode: Mode
    standing: StationStanding
    silent: list[str]
    failing: list[str]
    alarm: WatchAlarm | None
    next: WatchNext | None
    progress: WatchProgress | None
    doing: list[WatchDoing]
    awaits_order: bool
    tasks: dict[str, TaskView]


class WatchStreamMessage(RootModel[Annotated[WatchSnapshot | Silence | StreamError, Field(discriminator="kind")]]):
    """Any message of `/api/v1/wearables/stream`."""


# Watches: devices at people's wrists that show the tasks of one resource and acknowledge them.
#
# An operator offers a pairing and reads the code out; the device redeems it; the operator sees the device in the list
# and confirms it. Only then is it told anything. Whatever is wrong with a code, the answer is the same.

OPERATOR = allowed(Role.OPERATOR)
_NO_PARTS_OF_WATCHES = ("variables", "operations", "specifications", "work_masters")
router = interface("/wearables", tags=["wearables"])


@router.get("", dependencies=[OPERATOR])
async def list_wearables(identity: Identity, client: Controller) -> WatchesAnswer:
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
        raise ProblemFound(422, "no-such-resource", message("refused.no-such-resource.choose", resource=body.resource))
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
async def pair_wearable(
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
async def confirm_wearable(watch: Identifier, body: ConfirmationBody, identity: Identity, actor: Actor) -> None:
    """Confirm that the device that has redeemed the code is the one that was meant; within two minutes."""
    now = identity.now()
    await identity.write(lambda connection: watches.confirm(connection, watch, actor, now), by=actor)


@router.delete("/{watch}", status_code=204, dependencies=[OPERATOR], responses=refused(404))
async def revoke_wearable(watch: Identifier, identity: Identity, actor: Actor) -> None:
    """Refuse a device that waits, or revoke one that was confirmed; within two seconds it is told nothing any more."""
    now = identity.now()
    await identity.write(lambda connection: watches.revoke(connection, watch, actor, now), by=actor)


@router.get("/self", dependencies=[watch_only(waiting=True)])
async def this_wearable(request: Request) -> WatchSelfAnswer:
    """The asking watch: its name, whose tasks it shows, and if it was confirmed yet."""
    watch: Watch = request.state.watch
    return _itself(watch)


@router.get("/names", dependencies=[watch_only()], responses=refused(504))
async def names_for_wearables(request: Request, client: Controller, view: LiveView) -> NamesView:
    """What the station, its devices and the asking watch's own resource are called in other languages, with what these
    do; nothing of other people.
    """
    watch: Watch = request.state.watch
    names = await client.ask(AboutNames())
    others = {each.name for each in _resources(view)} - {watch.resource}
    told: dict[str, object] = {
        "resources": {name: words for name, words in names.resources.items() if name not in others},
        "abilities": {name: words for name, words in names.abilities.items() if name.partition(".")[0] not in others},
        "tasks": {name: words for name, words in names.tasks.items() if name.partition(".")[0] == watch.resource},
    }
    return names.model_copy(update={"values": [], **{key: {} for key in _NO_PARTS_OF_WATCHES}, **told})


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
