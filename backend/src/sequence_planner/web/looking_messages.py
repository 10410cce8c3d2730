"""What is said on the WebSockets that show one document again and again: the ROS graph, what passes the
pipelines, and the draft of the model.

Each message has the whole document. A client may ask for it again with `resync`, as on `/api/v1/stream`.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, RootModel

from sequence_planner.control.network_view import NetworkView
from sequence_planner.control.pipeline_view import FlowsView
from sequence_planner.web.stream_messages import ControllerState, StreamError, StreamPart
from sequence_planner.workshop.view import WorkshopView


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
