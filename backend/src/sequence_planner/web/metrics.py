"""`/metrics`: the station in figures, in Prometheus' text format or OpenMetrics, as who asks prefers.

Told to programs on this machine, and to keys with the scope `metrics` from anywhere. docs/operation.md lists them all.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable

from fastapi import Request, Response
from prometheus_client import CollectorRegistry, Metric
from prometheus_client.exposition import choose_encoder
from prometheus_client.registry import Collector

from sequence_planner.identity.roles import Scope
from sequence_planner.parts_file import read_restarts
from sequence_planner.web import metric_families as families
from sequence_planner.web.access import beside_or
from sequence_planner.web.figures import Figures
from sequence_planner.web.interface import beside_interface
from sequence_planner.web.readiness import Readiness
from sequence_planner.web.request_parts import Controller, Identity
from sequence_planner.web.settings import Settings

router = beside_interface(tags=["health"])
FORMATS = {"text/plain": {"schema": {"type": "string"}}, "application/openmetrics-text": {"schema": {"type": "string"}}}


class _Collected(Collector):
    """What was collected for one answer."""

    def __init__(self, collected: Iterable[Metric]) -> None:
        self._collected = list(collected)

    def collect(self) -> Iterable[Metric]:
        """All of it."""
        return self._collected


@router.get(
    "/metrics",
    dependencies=[beside_or(Scope.METRICS)],
    response_class=Response,
    responses={200: {"description": "All figures", "content": FORMATS}},
)
async def metrics(request: Request, client: Controller, identity: Identity) -> Response:
    """The station in figures. The controller is asked for its own at most once a second, and waits for nobody."""
    state = request.app.state
    settings: Settings = state.settings
    asked: Figures = state.figures
    readiness: Readiness = state.readiness
    figures = await asked.newest()
    failing = await readiness.failing(identity.database)
    restarts = await asyncio.to_thread(read_restarts, settings.controller_socket.parent)
    registry = CollectorRegistry(auto_describe=False)
    registry.register(
        _Collected(
            [
                *families.of_server(state.noted, failing, restarts),
                *families.of_controller(figures),
                *families.of_view(client.view if client.heard else None),
                *families.of_backups(None if state.backups is None else state.backups.newest),
                *families.of_retention(state.retention),
            ]
        )
    )
    encode, kind = choose_encoder(request.headers.get("accept", ""))
    return Response(encode(registry), media_type=None, headers={"Content-Type": kind})
