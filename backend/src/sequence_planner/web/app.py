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
from pathlib import Path
from typing import Any

from fastapi import FastAPI
from starlette.concurrency import run_in_threadpool
from starlette.middleware.gzip import GZipMiddleware

from sequence_planner.backup.keeping import Shelf
from sequence_planner.history.process import HistoryProcess
from sequence_planner.journal.archive import Archive
from sequence_planner.mes.webhooks.deliverer import Deliverer
from sequence_planner.mes.webhooks.sending import Sender
from sequence_planner.storage.location import revisions_folder
from sequence_planner.web import (
    abilities,
    actions,
    alarms,
    approvals,
    attachments,
    audit,
    backups,
    capabilities,
    control_routes,
    corrections,
    draft_pipelines,
    errands,
    events,
    health,
    history,
    job_orders,
    job_responses,
    keys,
    language,
    metrics,
    model,
    modes,
    openapi_document,
    order_of_work,
    people,
    pipelines,
    problems,
    provider,
    revisions,
    ros,
    session,
    station,
    storage,
    stream,
    watch_stream,
    watches,
    webhooks,
    why_not,
)
from sequence_planner.web.access import check_declared
from sequence_planner.web.backup_desk import BackupDesk
from sequence_planner.web.binding import check_endpoint
from sequence_planner.web.broadcast import Broadcast
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.figures import Figures
from sequence_planner.web.forwarded import Forwarded
from sequence_planner.web.guard import Guard
from sequence_planner.web.identity import IdentityOffice
from sequence_planner.web.liveness import WayToDatabase
from sequence_planner.web.looking import FlowsShow, NetworkShow
from sequence_planner.web.noting import Noted, Noting, known_routes
from sequence_planner.web.openapi_document import describe
from sequence_planner.web.order_desk import OrderDesk
from sequence_planner.web.order_of_work import OrderOfWorkDesk
from sequence_planner.web.problems import LastResort
from sequence_planner.web.readiness import Readiness
from sequence_planner.web.remembering import Remembering
from sequence_planner.web.retention_desk import RetentionDesk
from sequence_planner.web.security_headers import SecurityHeaders
from sequence_planner.web.settings import Settings
from sequence_planner.web.static import PageFiles
from sequence_planner.web.sweeper import Sweeper
from sequence_planner.web.watch_show import WatchShow
from sequence_planner.web.workshop import Workshop

LONG = 10_000  # bytes; such answers are compressed for who takes them so
PARTS = (
    session.router,
    provider.router,
    station.router,
    modes.router,
    modes.bodiless,
    actions.router,
    actions.bodiless,
    alarms.router,
    control_routes.router,
    corrections.router,
    approvals.router,
    errands.advice_router,
    errands.router,
    why_not.router,
    abilities.router,
    attachments.router,
    ros.router,
    pipelines.router,
    stream.router,
    people.router,
    people.bodiless,
    keys.router,
    keys.bodiless,
    watches.router,
    watch_stream.router,
    order_of_work.router,
    webhooks.router,
    webhooks.bodiless,
    backups.router,
    backups.bodiless,
    storage.router,
    storage.bodiless,
    audit.router,
    history.router,
    job_orders.router,
    job_orders.bodiless,
    job_responses.router,
    events.router,
    capabilities.router,
    model.router,
    language.router,
    draft_pipelines.router,
    revisions.router,
    openapi_document.router,
)


class StationServer(FastAPI):
    """FastAPI whose OpenAPI document also knows the messages of the stream."""

    def openapi(self) -> dict[str, Any]:
        """The OpenAPI document of this server."""
        if self.openapi_schema is None:
            self.openapi_schema = describe(self)
        return self.openapi_schema


def _looking_back(model: Path, settings: Settings) -> HistoryProcess:
    return HistoryProcess(model, settings.database, settings.retention.folder)


def _workshop(office: IdentityOffice, model: Path, settings: Settings) -> Workshop:
    return Workshop(office, model, revisions_folder(settings.database, model), settings.stream, settings.start)


def _backup_desk(office: IdentityOffice, settings: Settings, controller: ControllerClient) -> BackupDesk | None:
    """Who looks after backups; nobody where there is no model to go with the database, or where it is forgotten."""
    if settings.model is None or settings.demonstration:
        return None
    shelf = Shelf(settings.database, settings.model, settings.backups)
    return BackupDesk(office, shelf, stands_by=lambda: controller.stands_by)


def _retention_desk(office: IdentityOffice, settings: Settings, controller: ControllerClient) -> RetentionDesk | None:
    """Who sees to it that the database does not grow for ever; nobody where there is none to keep."""
    if settings.model is None or settings.demonstration:
        return None
    return RetentionDesk(
        office, settings.database, settings.model, settings.retention, stands_by=lambda: controller.stands_by
    )


def create_app(settings: Settings, controller: ControllerClient) -> FastAPI:
    """The application for `settings`; while it is up it keeps `controller` connected and has the database open.

    Raises `SettingsError` for an endpoint that is not allowed, and `RuntimeError` when a route does not declare who may
    use it. Its lifespan raises `StorageError` when the database cannot be used.
    """
    check_endpoint(settings)
    broadcast = Broadcast(controller, settings.stream)
    network, flows = NetworkShow(controller, settings.stream), FlowsShow(controller, settings.stream)
    watch_show = WatchShow(controller, settings.stream)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        office = await run_in_threadpool(
            IdentityOffice.open,
            settings.database,
            demonstration=settings.demonstration,
            provider=settings.provider,
        )
        app.state.identity = office
        app.state.order_desk = desk = OrderDesk(office, controller)
        app.state.order_of_work = sequencing = OrderOfWorkDesk(office, controller, desk)
        folder, archives = settings.model, settings.retention.folder
        app.state.archive = Archive(archives)
        app.state.history = looking_back = (
            None if folder is None else HistoryProcess(folder, settings.database, archives)
        )
        app.state.workshop = shop = None if folder is None else _workshop(office, folder, settings)
        app.state.backups = backup_desk = _backup_desk(office, settings, controller)
        app.state.retention = retention_desk = _retention_desk(office, settings, controller)
        app.state.deliverer = deliverer = Deliverer(
            office.database, Sender(settings.webhooks), stands_by=lambda: controller.stands_by
        )
        parts = (controller, flows, Sweeper(office, controller), desk, sequencing, deliverer)
        running = [asyncio.create_task(each.run()) for each in parts]
        running += [asyncio.create_task(each.run()) for each in (backup_desk, retention_desk) if each is not None]
        if shop is not None:
            controller.listen(shop.hear)
        try:
            yield
        finally:
            for task in running:
                task.cancel()
            await asyncio.gather(*running, return_exceptions=True)
            if looking_back is not None:
                looking_back.close()
            if shop is not None:
                await shop.close()
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
    app.state.figures, app.state.noted = Figures(controller), Noted()
    app.state.readiness = Readiness(controller, app.state.figures)
    app.state.way_to_database = WayToDatabase(settings.database)
    problems.install(app)
    _route(app, settings)
    _surround(app, settings)
    return app


def _route(app: FastAPI, settings: Settings) -> None:
    """What answers each address: the interface, what watches over the station's health, and the page's files."""
    for part in (*PARTS, health.router, metrics.router):
        app.router.routes.extend(part.routes)
    check_declared(app.routes)
    app.router.default = PageFiles(settings.page)


def _surround(app: FastAPI, settings: Settings) -> None:
    """What each request passes before its route, and each answer after it; the last is outermost."""
    app.add_middleware(GZipMiddleware, minimum_size=LONG, compresslevel=1)
    app.add_middleware(Remembering)
    app.add_middleware(Guard, endpoint=settings)
    if settings.proxies:
        app.add_middleware(Forwarded, proxies=settings.proxies)
    app.add_middleware(LastResort)
    app.add_middleware(Noting, noted=app.state.noted, routes=cache(partial(known_routes, app.routes)))
    app.add_middleware(SecurityHeaders, https=settings.https)
