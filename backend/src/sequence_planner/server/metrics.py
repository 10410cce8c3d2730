"""Prometheus metrics, and the health and readiness checks of the station."""

from __future__ import annotations

import asyncio
import contextlib
import platform
import time
from collections.abc import Collection, Iterable, Iterator, Mapping
from enum import StrEnum
from functools import cache
from typing import Literal

import structlog
from anyio import CapacityLimiter, to_thread
from fastapi import Request, Response
from prometheus_client import CollectorRegistry, Metric
from prometheus_client.core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
    InfoMetricFamily,
)
from prometheus_client.exposition import choose_encoder
from prometheus_client.registry import Collector
from pydantic import BaseModel, JsonValue
from sqlalchemy import Connection, text

from sequence_planner.auth.roles import Scope
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.queries import AskFigures
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.controller.views.metrics import DistributionView, FiguresView
from sequence_planner.controller.views.station import AlarmState, PackML, Priority, StationView
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.process.restarts import read_restarts
from sequence_planner.server.auth import allowed, beside_or
from sequence_planner.server.dependencies import Controller, Identity
from sequence_planner.server.errors import problem_response, refused
from sequence_planner.server.http.middleware import RequestMetrics
from sequence_planner.server.interface import beside_interface
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.server.services.retention import RetentionService
from sequence_planner.server.settings import Settings
from sequence_planner.server.stream.messages import ControllerState
from sequence_planner.version import VERSION

# The controller's figures, asked for at most once a second, whoever wants them and however many they are.

FIGURES_FRESH = 1.0  # seconds


class ControllerFigures:
    """The figures that `controller` has counted and timed of itself."""

    def __init__(self, controller: ControllerClient) -> None:
        self._controller = controller
        self._turn = asyncio.Lock()
        self._due = 0.0  # on the clock of `time.monotonic`
        self._newest: FiguresView | None = None

    async def newest(self) -> FiguresView | None:
        """They are a second old at most; None where the controller is silent, or has none yet."""
        async with self._turn:
            if time.monotonic() >= self._due:
                self._newest = await self._asked()
                self._due = time.monotonic() + FIGURES_FRESH
            return self._newest

    async def _asked(self) -> FiguresView | None:
        if not self._controller.heard:
            return None
        try:
            return await self._controller.ask(AskFigures())
        except CommandRefused:  # the station is being prepared, or the controller is gone
            return None


# Whether starting the server again would help: it does where its own way to the database is shut and another is open.
#
# A database that nobody can reach comes back by itself, and the station goes on meanwhile: that is no reason to end it.

LOG = structlog.get_logger(__name__)
EVERY = 2.0  # seconds between two looks
PATIENCE = 2.0  # seconds in which a database answers
SHUT_AFTER = 10.0  # seconds for which it must be so: many who ask at once are no reason


class WayToDatabase:
    """Looks whenever somebody asks, in the background: who asks hears at once what was found last."""

    def __init__(self, url: str) -> None:
        self._url = url
        self._looking: asyncio.Task[None] | None = None
        self._due = 0.0  # on the clock of `time.monotonic`, as is the next
        self._shut_since: float | None = None
        self._threads: CapacityLimiter | None = None  # others may have taken all that there are

    def is_shut(self, office: IdentityService) -> bool:
        """Return whether nothing has come through it for a while that would have come through another."""
        now = time.monotonic()
        if now >= self._due and (self._looking is None or self._looking.done()):
            self._due = now + EVERY
            self._looking = asyncio.create_task(self._look(office))
        return self._shut_since is not None and now - self._shut_since >= SHUT_AFTER

    async def _look(self, office: IdentityService) -> None:
        if await self._answers(office) or not await self._would_answer():
            self._shut_since = None
        elif self._shut_since is None:
            self._shut_since = time.monotonic()
            LOG.error("the server's connections to the database are stuck, and a new one is not")

    async def _answers(self, office: IdentityService) -> bool:
        try:
            async with asyncio.timeout(PATIENCE):
                await office.read(_ask)
        except (TimeoutError, StorageError):
            return False
        return True

    async def _would_answer(self) -> bool:
        if self._threads is None:
            self._threads = CapacityLimiter(1)
        try:
            async with asyncio.timeout(PATIENCE):
                await to_thread.run_sync(self._try, abandon_on_cancel=True, limiter=self._threads)
        except (TimeoutError, StorageError):
            return False
        return True

    def _try(self) -> None:
        with contextlib.closing(Database.open(self._url, create=False)) as another, another.reading() as connection:
            _ask(connection)


def _ask(connection: Connection) -> None:
    connection.execute(text("SELECT 1"))


# Whether the station can work: each check by itself, and why one fails, in words that name nothing secret.

FRESH = 2.0  # seconds for which that it could counts, so that nobody wears it out by asking
MOST_APART = 2.0  # seconds between the time that a view tells and the time here


class ReadinessCheck(StrEnum):
    """The metrics."""

    CONTROLLER = "controller"  # it is heard
    PREPARED = "prepared"  # the safe states are known, and the devices are its own to command
    JOURNAL = "journal"  # what happens is durable in time
    TIME = "time"  # its views are of now
    DATABASE = "database"  # it can be written to


SILENT = "The controller has been silent for two seconds."
WRONG = {
    ReadinessCheck.CONTROLLER: SILENT,
    ReadinessCheck.PREPARED: "The station is being prepared.",
    ReadinessCheck.JOURNAL: "What happens is not journalled in time, so nothing is started. The alarms say why.",
    ReadinessCheck.TIME: "The controller's time is not the server's: its views come late, or the clock was set.",
    ReadinessCheck.DATABASE: "The database cannot be written to. The server's log says why.",
}


class Readiness:
    """Looks whenever somebody asks."""

    def __init__(self, controller: ControllerClient, figures: ControllerFigures) -> None:
        self._controller = controller
        self._figures = figures
        self._turn = asyncio.Lock()
        self._due = 0.0  # on the clock of `time.monotonic`
        self._writable = False

    async def failing(self, database: Database) -> dict[ReadinessCheck, str]:
        """The checks that fail, with the reason of each; without any the station is ready.

        What nobody knows while the controller is silent fails too.
        """
        passed = {
            ReadinessCheck.CONTROLLER: self._controller.heard,
            ReadinessCheck.PREPARED: self._prepared(),
            ReadinessCheck.JOURNAL: await self._keeps_up(),
            ReadinessCheck.TIME: self._on_time(),
            ReadinessCheck.DATABASE: await self._can_be_written(database),
        }
        heard = passed[ReadinessCheck.CONTROLLER]
        of_it = (ReadinessCheck.PREPARED, ReadinessCheck.JOURNAL, ReadinessCheck.TIME)
        return {
            check: WRONG[check] if heard or check not in of_it else SILENT
            for check, is_so in passed.items()
            if not is_so
        }

    def _prepared(self) -> bool:
        view = self._controller.view
        return self._controller.heard and view is not None and view.production is not Production.PREPARING

    def _on_time(self) -> bool:
        view = self._controller.view
        return self._controller.heard and view is not None and abs(time.time() - view.time) <= MOST_APART

    async def _keeps_up(self) -> bool:
        figures = await self._figures.newest()
        if figures is None:
            return self._controller.heard and not self._prepared()  # nothing happens yet that is to be journalled
        return not figures.journal.behind

    async def _can_be_written(self, database: Database) -> bool:
        async with self._turn:
            if time.monotonic() >= self._due:
                self._writable = await _written(database)
                self._due = time.monotonic() + FRESH
            return self._writable


async def _written(database: Database) -> bool:
    try:
        async with asyncio.timeout(PATIENCE):
            await to_thread.run_sync(database.try_writing, abandon_on_cancel=True)
    except TimeoutError:
        LOG.error("the database cannot be written to", says=f"nothing was written within {PATIENCE:g} s")
        return False
    except StorageError as error:
        LOG.error("the database cannot be written to", says=str(error))
        return False
    return True


# Whether the station is alive, for whoever would start it again, and whether it is ready, for whoever would use it.
#
# Both are told to everybody: 200, or 503 with the reasons, which say nothing that is secret.

SHUT = "The server's connections to the database are stuck, and a new one is not. Start the station again."

health_router = beside_interface(tags=["health"], dependencies=[allowed(None)])


class Health(BaseModel):
    """The server answers, and a view of the controller came within two seconds."""

    status: Literal["alive"]
    controller: Literal[ControllerState.HEARD]
    version: str


class Ready(BaseModel):
    """All of these checks were passed."""

    status: Literal["ready"]
    checks: list[ReadinessCheck]


@health_router.get("/healthz", response_model=Health, responses=refused(503))
async def healthz(request: Request, client: Controller, identity: Identity) -> Health | Response:
    """Alive: the server answers, its controller is heard, and nothing is wrong that would be right after a restart.

    Else 503 `not-alive`, with `reasons` by name.
    """
    way: WayToDatabase = request.app.state.way_to_database
    is_shut = way.is_shut(identity)
    if client.heard and not is_shut:
        return Health(status="alive", controller=ControllerState.HEARD, version=VERSION)
    reasons = {} if client.heard else {ReadinessCheck.CONTROLLER: SILENT}
    reasons |= {ReadinessCheck.DATABASE: SHUT} if is_shut else {}
    more = {"controller": (ControllerState.HEARD if client.heard else ControllerState.LOST).value}
    return _refusal("not-alive", "The station is not well", reasons, more)


@health_router.get("/readyz", response_model=Ready, responses=refused(503))
async def readyz(request: Request, identity: Identity) -> Ready | Response:
    """Ready to work: prepared, with a journal that keeps up, a database that can be written to, and views of now.

    Else 503 `not-ready`, with `reasons` by the name of each check that fails.
    """
    readiness: Readiness = request.app.state.readiness
    failing = await readiness.failing(identity.database)
    if not failing:
        return Ready(status="ready", checks=list(ReadinessCheck))
    return _refusal("not-ready", "The station is not ready", failing, {})


def _refusal(slug: str, title: str, reasons: Mapping[ReadinessCheck, str], more: Mapping[str, str]) -> Response:
    named: dict[str, JsonValue] = {check.value: why for check, why in reasons.items()}
    detail = " ".join(dict.fromkeys(reasons.values()))
    return problem_response(503, slug, title, detail, more={"reasons": named, **more})


# What the metrics are called, and how they follow of what is known. Names and units follow Prometheus' conventions.

PREFIX = "sequence_planner"


def of_server(
    noted: RequestMetrics, failing: Collection[ReadinessCheck], restarts: Mapping[str, int]
) -> Iterator[Metric]:
    """Yield what the server itself knows."""
    yield InfoMetricFamily(f"{PREFIX}_build", "What is running.", _build())
    ready = GaugeMetricFamily(f"{PREFIX}_ready", "Whether a check of /readyz is passed.", labels=["check"])
    for check in ReadinessCheck:
        ready.add_metric([check], check not in failing)
    yield ready
    requests = CounterMetricFamily(
        f"{PREFIX}_http_requests", "Requests that were answered.", labels=["method", "route", "status"]
    )
    for (method, route, status), count in sorted(noted.requests.items()):
        requests.add_metric([method, route, str(status)], count)
    yield requests
    took = HistogramMetricFamily(
        f"{PREFIX}_http_request_duration_seconds", "How long requests took to be answered.", labels=["route"]
    )
    for route, distribution in sorted(noted.took.items()):
        _add(took, [route], DistributionView.of(distribution))
    yield took
    streams = GaugeMetricFamily(f"{PREFIX}_stream_clients", "Streams that are open.", labels=["route"])
    for route, count in sorted(noted.streams.items()):
        streams.add_metric([route], count)
    yield streams
    parts = CounterMetricFamily(
        f"{PREFIX}_part_restarts", "How often a part has died and was started again.", labels=["part"]
    )
    for part, count in sorted(restarts.items()):
        parts.add_metric([part], count)
    yield parts


def of_controller(figures: FiguresView | None) -> Iterator[Metric]:
    """Yield what the controller has counted and timed since it began; nothing where it does not tell."""
    if figures is None:
        return
    yield GaugeMetricFamily(
        f"{PREFIX}_controller_start_time_seconds",
        "When the controller began, in seconds since the epoch.",
        figures.began,
    )
    ticks = HistogramMetricFamily(f"{PREFIX}_tick_duration_seconds", "How long ticks took.", labels=[])
    _add(ticks, [], figures.ticks)
    yield ticks
    yield CounterMetricFamily(f"{PREFIX}_ticks", "Ticks that were taken.", sum(figures.ticks.counts))
    latency = HistogramMetricFamily(
        f"{PREFIX}_journal_latency_seconds", "How long records of what happened took to be durable.", labels=[]
    )
    _add(latency, [], figures.journal.latency)
    yield latency
    yield GaugeMetricFamily(
        f"{PREFIX}_journal_waiting_records",
        "Records of what happened that are not durable yet.",
        figures.journal.waiting,
    )
    planner = HistogramMetricFamily(
        f"{PREFIX}_planner_duration_seconds",
        "How long the planner took, by what it was asked and what came of that.",
        labels=["question", "outcome"],
    )
    for each in figures.planner:
        _add(planner, [each.question, each.outcome], each.took)
    yield planner
    replaced = CounterMetricFamily(
        f"{PREFIX}_worker_replacements",
        "How often a process that answers the controller was replaced.",
        labels=["worker"],
    )
    for worker, count in sorted(figures.replaced.items()):
        replaced.add_metric([worker], count)
    yield replaced


def of_view(view: StationView | None) -> Iterator[Metric]:
    """Yield what the station shows; nothing while it is not heard."""
    yield GaugeMetricFamily(f"{PREFIX}_controller_up", "Whether the controller is heard.", view is not None)
    if view is None:
        return
    yield _states("mode", "The mode that the station is in.", Mode, view.mode)
    yield _states("packml_state", "The state of PackML that the station is in.", PackML, view.packml)
    yield _states("production", "Whether production is started.", Production, view.production)
    alarms = GaugeMetricFamily(f"{PREFIX}_alarms", "Alarms there are.", labels=["priority", "state"])
    for priority in Priority:
        for state in AlarmState:
            among = [each for each in view.alarms.values() if (each.priority, each.state) == (priority, state)]
            alarms.add_metric([priority, state], len(among))
    yield alarms
    yield from _topics(view)
    completed = CounterMetricFamily(
        f"{PREFIX}_operations_completed", "How often an operation was completed.", labels=["operation"]
    )
    for name, operation in view.operations.items():
        completed.add_metric([name], operation.completed)
    yield completed
    yield GaugeMetricFamily(f"{PREFIX}_tasks", "Tasks that wait for a person.", len(view.tasks))


def of_backups(newest: float | None) -> Iterator[Metric]:
    """Yield the time when the newest backup was made; nothing where there is none."""
    if newest is not None:
        yield GaugeMetricFamily(
            f"{PREFIX}_backup_time_seconds", "When the newest backup was made, in seconds since the epoch.", newest
        )


def _topics(view: StationView) -> Iterator[Metric]:
    labels = ["topic", "direction"]
    age = GaugeMetricFamily(f"{PREFIX}_topic_age_seconds", "How long ago a topic had its last message.", labels=labels)
    fresh = GaugeMetricFamily(f"{PREFIX}_topic_fresh", "Whether a topic keeps to its deadline.", labels=labels)
    messages = CounterMetricFamily(f"{PREFIX}_topic_messages", "Messages of a topic.", labels=labels)
    now = time.time()
    for name, topic in view.topics.items():
        if topic.last is not None:
            age.add_metric([name, topic.direction], max(0.0, now - topic.last))
        fresh.add_metric([name, topic.direction], topic.fresh)
        messages.add_metric([name, topic.direction], topic.messages)
    yield from (age, fresh, messages)


def of_retention(desk: RetentionService | None) -> Iterator[Metric]:
    """Yield how much is kept, as it was looked at last, and whether it can be archived; nothing where nothing is
    kept.
    """
    if desk is None:
        return
    if desk.sizes is not None:
        sizes = GaugeMetricFamily(
            f"{PREFIX}_storage_bytes", "Bytes of what is kept, and what is free on its disk.", labels=["of"]
        )
        for name, size in desk.sizes.told():
            sizes.add_metric([name], size)
        yield sizes
    if desk.last_done is not None:
        text = "When retention has last done its work, in seconds since the epoch."
        yield GaugeMetricFamily(f"{PREFIX}_retention_time_seconds", text, desk.last_done)
    in_trouble = desk.trouble is not None
    yield GaugeMetricFamily(f"{PREFIX}_retention_in_trouble", "Whether something is in the way of it.", in_trouble)


def _states(name: str, text: str, states: type[StrEnum], present: StrEnum) -> Metric:
    """One of several states: 1 for the present one, and 0 for all others."""
    family = GaugeMetricFamily(f"{PREFIX}_{name}", text, labels=["state"])
    for state in states:
        family.add_metric([state], state == present)
    return family


def _add(family: HistogramMetricFamily, labels: list[str], took: DistributionView) -> None:
    """With how many took at most as long as each bound, as Prometheus counts."""
    total, buckets = 0, list[tuple[str, float]]()
    for bound, count in zip([*took.bounds, float("inf")], took.counts, strict=True):
        total += count
        buckets.append(("+Inf" if bound == float("inf") else str(bound), total))
    family.add_metric(labels, buckets, took.seconds)


@cache
def _build() -> dict[str, str]:
    return {"version": VERSION, "python": platform.python_version()}


# `/metrics`: the station in figures, in Prometheus' text format or OpenMetrics, as who asks prefers.
#
# Told to programs on this machine, and to keys with the scope `metrics` from anywhere. docs/operation.md lists them
# all.

metrics_router = beside_interface(tags=["health"])
FORMATS = {"text/plain": {"schema": {"type": "string"}}, "application/openmetrics-text": {"schema": {"type": "string"}}}


class _Collected(Collector):
    """The metrics collected for one answer."""

    def __init__(self, collected: Iterable[Metric]) -> None:
        self._collected = list(collected)

    def collect(self) -> Iterable[Metric]:
        """All of it."""
        return self._collected


@metrics_router.get(
    "/metrics",
    dependencies=[beside_or(Scope.METRICS)],
    response_class=Response,
    responses={200: {"description": "All figures", "content": FORMATS}},
)
async def metrics(request: Request, client: Controller, identity: Identity) -> Response:
    """The station in figures. The controller is asked for its own at most once a second, and waits for nobody."""
    state = request.app.state
    settings: Settings = state.settings
    asked: ControllerFigures = state.figures
    readiness: Readiness = state.readiness
    figures = await asked.newest()
    failing = await readiness.failing(identity.database)
    restarts = await asyncio.to_thread(read_restarts, settings.controller_socket.parent)
    registry = CollectorRegistry(auto_describe=False)
    registry.register(
        _Collected(
            [
                *of_server(state.noted, failing, restarts),
                *of_controller(figures),
                *of_view(client.view if client.heard else None),
                *of_backups(None if state.backups is None else state.backups.newest),
                *of_retention(state.retention),
            ]
        )
    )
    encode, kind = choose_encoder(request.headers.get("accept", ""))
    return Response(encode(registry), media_type=None, headers={"Content-Type": kind})
