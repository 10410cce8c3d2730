"""The ROS graph, read once or as it changes."""

from __future__ import annotations

from fastapi import WebSocket

from sequence_planner.control.network_view import NetworkView
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.web.access import allowed
from sequence_planner.web.interface import interface
from sequence_planner.web.looking import NetworkShow
from sequence_planner.web.problems import ProblemFound
from sequence_planner.web.request_parts import Controller, LiveView
from sequence_planner.web.stream import serve

router = interface("/ros", tags=["ros"], dependencies=[allowed(Role.VIEWER, scope=Scope.READ)])


@router.get("/graph")
async def ros_graph(view: LiveView, client: Controller) -> NetworkView:
    """All nodes, topics, services and actions that the station's transport knows, and how the station meets them.

    503 until the station is prepared and has joined the network.
    """
    if client.network is None:
        detail = "The station is being prepared and has not joined the network. Try again in a moment."
        raise ProblemFound(503, "preparing", "The station is being prepared", detail)
    return client.network


@router.websocket("/stream")
async def stream(websocket: WebSocket) -> None:
    """Serve one client: the graph, and again whenever it has changed."""
    show: NetworkShow = websocket.app.state.network_show
    await serve(websocket, show.latest)
