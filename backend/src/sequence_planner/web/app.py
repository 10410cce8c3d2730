"""The server's parts put together: routes, guards, problems, the stream, the page.

From the outside in, a request passes the security headers, the last resort for errors, the guard, and then the route
for its address; what no route knows is a file of the page, or nothing.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from fastapi import APIRouter, FastAPI

from sequence_planner.web import actions, attachments, health, pipelines, problems, ros, station, stream
from sequence_planner.web.broadcast import Broadcast
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.guard import Guard
from sequence_planner.web.looking import FlowsShow, NetworkShow
from sequence_planner.web.openapi_document import PROBLEM_RESPONSES, describe
from sequence_planner.web.problems import LastResort
from sequence_planner.web.security_headers import SecurityHeaders
from sequence_planner.web.settings import Settings, check_host
from sequence_planner.web.static import PageFiles

PREFIX = "/api/v1"


class StationServer(FastAPI):
    """FastAPI whose OpenAPI document also knows the messages of the stream."""

    def openapi(self) -> dict[str, Any]:
        """The OpenAPI document of this server."""
        if self.openapi_schema is None:
            self.openapi_schema = describe(self)
        return self.openapi_schema


def create_app(settings: Settings, controller: ControllerClient) -> FastAPI:
    """The application for `settings`; while it is up it keeps `controller` connected.

    Raises `SettingsError` for a host that is not allowed.
    """
    check_host(settings.host)
    broadcast = Broadcast(controller, settings.stream)
    network, flows = NetworkShow(controller, settings.stream), FlowsShow(controller, settings.stream)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        running = [asyncio.create_task(each.run()) for each in (controller, broadcast, network, flows)]
        try:
            yield
        finally:
            for task in running:
                task.cancel()
            await asyncio.gather(*running, return_exceptions=True)

    app = StationServer(
        title="Sequence Planner",
        version="1",
        description="The running station: what it does, and what a person or a system may ask of it.",
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=None,  # the usual viewers load their scripts from the network
        redoc_url=None,
        redirect_slashes=False,
        responses=PROBLEM_RESPONSES,
        lifespan=lifespan,
    )
    app.state.controller = controller
    app.state.broadcast, app.state.network_show, app.state.flows_show = broadcast, network, flows
    app.state.settings, app.state.attaching = settings, asyncio.Lock()
    problems.install(app)
    api = APIRouter(prefix=PREFIX)
    acting = (actions.router, actions.bodiless, attachments.router)
    for part in (station.router, *acting, ros.router, pipelines.router, stream.router):
        api.include_router(part)
    app.include_router(api)
    app.include_router(health.router)
    app.router.default = PageFiles(settings.page)
    for layer in (Guard, LastResort, SecurityHeaders):  # the last is outermost
        app.add_middleware(layer, **({"port": settings.port} if layer is Guard else {}))
    return app
