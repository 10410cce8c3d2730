"""WebSocket message schemas: station stream, ROS graph, pipeline edges and draft."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias, get_origin, get_type_hints

from pydantic import Field, RootModel
from typing_extensions import TypedDict

from sequence_planner.controller.views.details import NetworkView
from sequence_planner.controller.views.pipelines import FlowsView
from sequence_planner.controller.views.station import (
    StationView,
)
from sequence_planner.core.data_models import DataModel
from sequence_planner.editor.schemas.draft import WorkshopView

# What is said on the WebSocket `/api/v1/stream`. The page's TypeScript types are generated from these models.
#
# The server sends one snapshot, then deltas. `sequence` counts what is told to everybody; a client that misses a number
# asks for a new snapshot with `resync`. A snapshot carries the number of the last message that it includes, so the
# delta after it carries the next one.


_FIELDS = {name: kind for name, kind in get_type_hints(StationView).items() if name in StationView.model_fields}
MAPS = tuple(name for name, kind in _FIELDS.items() if get_origin(kind) is dict)
"""The members of `StationView` of which single entries are told."""

if TYPE_CHECKING:  # whose members are found out below
    StationChange: TypeAlias = Mapping[str, object]
    StationRemoval: TypeAlias = Mapping[str, list[str]]
else:
    StationChange = TypedDict("StationChange", _FIELDS, total=False)
    StationChange.__doc__ = "Members of `StationView` that changed. Of a map, only the entries that are new or changed."
    StationRemoval = TypedDict("StationRemoval", dict.fromkeys(MAPS, list[str]), total=False)
    StationRemoval.__doc__ = "Keys that are no longer in the maps of `StationView`."


class ControllerState(StrEnum):
    """Whether the server hears the controller. While it is lost, what was shown before is old."""

    HEARD = "heard"
    LOST = "lost"


class StreamPart(DataModel):
    """Base of all messages: immutable, and nothing beside what is declared."""


class Snapshot(StreamPart):
    """The whole view.

    `age` is how many seconds ago the server heard the controller's clock move; null where it never did, as of a
    controller that shows what it knew once more and then says nothing.
    """

    kind: Literal["snapshot"]
    sequence: int
    age: float | None
    view: StationView


class Delta(StreamPart):
    """What changed since the message before; at least one each second, with at least a fresh `time`."""

    kind: Literal["delta"]
    sequence: int
    changed: StationChange
    removed: StationRemoval


class Link(StreamPart):
    """The controller fell silent, or is back; then a snapshot follows."""

    kind: Literal["link"]
    sequence: int
    controller: ControllerState


class StreamError(StreamPart):
    """Something the client sent cannot be understood. The connection goes on."""

    kind: Literal["error"]
    detail: str


class StreamMessage(RootModel[Annotated[Snapshot | Delta | Link | StreamError, Field(discriminator="kind")]]):
    """Any message from the server."""


class Resync(StreamPart):
    """The client wants a new snapshot."""

    kind: Literal["resync"]


# What is said on the WebSockets that show one document again and again: the ROS graph, what passes the
# pipelines, and the draft of the model.
#
# Each message has the whole document. A client may ask for it again with `resync`, as on `/api/v1/stream`.


class NetworkSnapshot(StreamPart):
    """The ROS graph as it is now."""

    kind: Literal["network"]
    network: NetworkView


class FlowsSnapshot(StreamPart):
    """What has passed the pipelines by now."""

    kind: Literal["flows"]
    flows: FlowsView


class WorkshopSnapshot(StreamPart):
    """The draft of the model and its check as they are now."""

    kind: Literal["workshop"]
    workshop: WorkshopView


class Silence(StreamPart):
    """There is nothing to show: the controller is not heard, or is still preparing the station."""

    kind: Literal["link"]
    controller: ControllerState


class NetworkStreamMessage(RootModel[Annotated[NetworkSnapshot | Silence | StreamError, Field(discriminator="kind")]]):
    """Any message of `/api/v1/ros/stream`."""


class FlowsStreamMessage(RootModel[Annotated[FlowsSnapshot | Silence | StreamError, Field(discriminator="kind")]]):
    """Any message of `/api/v1/pipelines/stream`."""


class WorkshopStreamMessage(RootModel[Annotated[WorkshopSnapshot | StreamError, Field(discriminator="kind")]]):
    """Any message of `/api/v1/model/stream`."""
