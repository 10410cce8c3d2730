"""What is said of watches over REST, and on the WebSocket `/api/v1/watches/stream`.

Times are in seconds since the epoch.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, Field, RootModel

from sequence_planner.control.view import StationStanding, TaskView
from sequence_planner.control.vocabulary import Mode
from sequence_planner.identity.watches import WatchState
from sequence_planner.web.body import Body, Name
from sequence_planner.web.looking_messages import Silence
from sequence_planner.web.stream_messages import StreamError, StreamPart


class WatchAnswer(BaseModel):
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


class OfferAnswer(BaseModel):
    """A pairing that nobody has redeemed yet. Its code is not told again."""

    id: str
    name: str
    resource: str
    offered_by: str
    expires: float


class WatchResource(BaseModel):
    """A resource that has tasks for people, so that a watch can serve it."""

    name: str
    title: str


class WatchesAnswer(BaseModel):
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


class NewOfferAnswer(BaseModel):
    """The code to type in on the watch until `expires`; it is shown this once."""

    id: str
    code: str
    expires: float


class PairingBody(Body):
    """The code that an operator has read out."""

    code: Annotated[str, Field(min_length=1, max_length=32)]


class ConfirmationBody(Body):
    """Nothing: to confirm is all that there is to say."""


class WatchSelfAnswer(BaseModel):
    """What a watch is told of itself."""

    id: str
    name: str
    resource: str
    state: WatchState


class WatchSnapshot(StreamPart):
    """The tasks of the watch's own resource, by id, as of `time`; `station` is the station's title.

    `standing` says whether anything starts by itself, `silent` which devices are not heard, `failing` which of
    the others do not do what they should.
    """

    kind: Literal["watch"]
    time: float
    station: str
    mode: Mode
    standing: StationStanding
    silent: list[str]
    failing: list[str]
    tasks: dict[str, TaskView]


class WatchStreamMessage(RootModel[Annotated[WatchSnapshot | Silence | StreamError, Field(discriminator="kind")]]):
    """Any message of `/api/v1/watches/stream`."""
