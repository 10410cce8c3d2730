"""The server's parts put together: routes, guards, problems, the stream, the page.

From the outside in, a request passes the security headers, what notes it, the last resort for errors, what knows
proxies where there are any, the guard, what remembers whose connection it is, what compresses long answers, and then
the route for its address; what no route knows is a file of the page, or nothing.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import cache, partial
from typing import Any

from fastapi import FastAPI
from starlette.concurrency import run_in_threadpool
from starlette.middleware.gzip import GZipMiddleware

from sequence_planner.backup.service import Shelf
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.history.client import HistoryProcess
from sequence_planner.journal.archive import Archive
from sequence_planner.mes.webhooks.delivery import Deliverer, Sender
from sequence_planner.server import errors, metrics
from sequence_planner.server import metrics as health
from sequence_planner.server.api.job_orders import OrderOfWorkDesk
from sequence_planner.server.auth import Remembering, check_declared
from sequence_planner.server.binding import check_endpoint
from sequence_planner.server.errors import ErrorMiddleware
from sequence_planner.server.http.middleware import (
    Forwarded,
    RequestGuard,
    RequestLog,
    RequestMetrics,
    SecurityHeaders,
    known_routes,
)
from sequence_planner.server.http.page_files import PageFiles
from sequence_planner.server.http.renamed import Renamed
from sequence_planner.server.metrics import ControllerFigures, Readiness, WayToDatabase
from sequence_planner.server.openapi_document import describe
from sequence_planner.server.routers import ROUTERS
from sequence_planner.server.services.backups import BackupService
from sequence_planner.server.services.drafts import furnish
from sequence_planner.server.services.identity import IdentityService, Sweeper
from sequence_planner.server.services.orders import OrderService
from sequence_planner.server.services.retention import RetentionService
from sequence_planner.server.settings import Settings
from sequence_planner.server.stream.broadcast import Broadcast, FlowsFeed, NetworkFeed
from sequence_planner.server.stream.endpoints import WatchShow

LONG = 10_000  # bytes; such answers are compressed for who takes them so


class StationServer(FastAPI):
    """FastAPI whose OpenAPI document also knows the messages of the stream."""

    def openapi(self) -> dict[str, Any]:
        """The OpenAPI document of this server."""
        if self.openapi_schema is None:
            self.openapi_schema = describe(self)
        return self.openapi_schema


def _backup_desk(office: IdentityService, settings: Settings, controller: ControllerClient) -> BackupService | None:
    """Return who looks after backups; nobody where there is no model to go with the database, or where it is
    forgotten.
    """
    if settings.model is None or settings.demonstration:
        return None
    shelf = Shelf(settings.database, settings.model, settings.backups)
    return BackupService(office, shelf, stands_by=lambda: controller.stands_by)


def _retention_desk(
    office: IdentityService, settings: Settings, controller: ControllerClient
) -> RetentionService | None:
    """Return who sees to it that the database does not grow for ever; nobody where there is none to keep."""
    if settings.model is None or settings.demonstration:
        return None
    return RetentionService(
        office, settings.database, settings.model, settings.retention, stands_by=lambda: controller.stands_by
    )


def create_app(settings: Settings, controller: ControllerClient) -> FastAPI:
    """The application for `settings`; while it is up it keeps `controller` connected and has the database open.

    Raises `SettingsError` for an endpoint that is not allowed, and `RuntimeError` when a route does not declare who may
    use it. Its lifespan raises `StorageError` when the database cannot be used.
    """
    check_endpoint(settings)
    broadcast = Broadcast(controller, settings.stream)
    network, flows = NetworkFeed(controller, settings.stream), FlowsFeed(controller, settings.stream)
    watch_show = WatchShow(controller, settings.stream)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        office = await run_in_threadpool(
            IdentityService.open,
            settings.database,
            demonstration=settings.demonstration,
            provider=settings.provider,
        )
        app.state.identity = office
        app.state.order_desk = desk = OrderService(office, controller)
        app.state.order_of_work = sequencing = OrderOfWorkDesk(office, controller, desk)
        folder, archives = settings.model, settings.retention.folder
        app.state.archive = Archive(archives)
        app.state.history = looking_back = (
            None if folder is None else HistoryProcess(folder, settings.database, archives)
        )
        shop, deployments, recordings, examples = furnish(office, settings, controller)
        app.state.workshop, app.state.deployments = shop, deployments
        app.state.examples, app.state.recordings = examples, recordings
        app.state.backups = backup_desk = _backup_desk(office, settings, controller)
        app.state.retention = retention_desk = _retention_desk(office, settings, controller)
        app.state.deliverer = deliverer = Deliverer(
            office.database, Sender(settings.webhooks), stands_by=lambda: controller.stands_by
        )
        parts = (controller, flows, Sweeper(office, controller), desk, sequencing, deliverer)
        running = [asyncio.create_task(each.run()) for each in parts]
        running += [asyncio.create_task(each.run()) for each in (backup_desk, retention_desk) if each is not None]
        if deployments is not None:
            controller.listen(deployments.shop.hear)
            controller.listen(deployments.note_view)
        try:
            yield
        finally:
            for task in running:
                task.cancel()
            await asyncio.gather(*running, return_exceptions=True)
            if looking_back is not None:
                looking_back.close()
            await asyncio.gather(*(each.close() for each in (examples, recordings) if each is not None))
            if deployments is not None:
                await deployments.close()
            await run_in_threadpool(office.close)

    app = StationServer(
        title="Sequence Planner",
        version="1",
        description="The running station: what it does, and what a person or a system may ask of it.",
        openapi_url=None,  # it has a route like others, which declares who may read it
        docs_url=None,  # the usual viewers load their scripts from the network
        redoc_url=None,
        redirect_slashes=False,
        lifespan=lifespan,
    )
    app.state.controller = controller
    app.state.broadcast, app.state.watch_show = broadcast, watch_show
    app.state.network_show, app.state.flows_show = network, flows
    app.state.streams = Counter()  # how many each person, key and watch has open, by id
    app.state.settings, app.state.attaching = settings, asyncio.Lock()
    app.state.figures, app.state.noted = ControllerFigures(controller), RequestMetrics()
    app.state.readiness = Readiness(controller, app.state.figures)
    app.state.way_to_database = WayToDatabase(settings.database)
    errors.install(app)
    _route(app, settings)
    _surround(app, settings)
    return app


def _route(app: FastAPI, settings: Settings) -> None:
    """Add what answers each address: the interface, what watches over the station's health, and the page's files."""
    for part in (*ROUTERS, health.health_router, metrics.metrics_router):
        app.router.routes.extend(part.routes)
    check_declared(app.routes)
    app.router.default = Renamed(app.router, PageFiles(settings.page, settings.beside))


def _surround(app: FastAPI, settings: Settings) -> None:
    """Add what each request passes before its route, and each answer after it; the last is outermost."""
    app.add_middleware(GZipMiddleware, minimum_size=LONG, compresslevel=1)
    app.add_middleware(Remembering)
    app.add_middleware(RequestGuard, endpoint=settings, largest_recording=settings.largest_recording)
    if settings.proxies:
        app.add_middleware(Forwarded, proxies=settings.proxies)
    app.add_middleware(ErrorMiddleware)
    app.add_middleware(RequestLog, noted=app.state.noted, routes=cache(partial(known_routes, app.routes)))
    app.add_middleware(SecurityHeaders, https=settings.https)
