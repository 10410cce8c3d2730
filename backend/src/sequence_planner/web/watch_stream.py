"""The WebSocket `/api/v1/watches/stream`: what a confirmed watch is shown."""

from __future__ import annotations

from fastapi import WebSocket

from sequence_planner.identity.watches import Watch
from sequence_planner.web.access import watch_only
from sequence_planner.web.interface import interface
from sequence_planner.web.stream import serve
from sequence_planner.web.watch_show import WatchShow

router = interface("/watches")


@router.websocket("/stream", dependencies=[watch_only()])
async def watch_stream(websocket: WebSocket) -> None:
    """Serve one watch with the tasks of its own resource until it leaves, or is no longer a watch of this station."""
    show: WatchShow = websocket.app.state.watch_show
    watch: Watch = websocket.state.watch
    await serve(websocket, show.of(watch.resource))
