"""What the metrics are called, and how they follow of what is known. Names and units follow Prometheus' conventions."""

from __future__ import annotations

import platform
import time
from collections.abc import Collection, Iterator, Mapping
from enum import StrEnum
from functools import cache

from prometheus_client import Metric
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, HistogramMetricFamily, InfoMetricFamily

from sequence_planner.control.alarm_view import AlarmState, Priority
from sequence_planner.control.figures_view import DistributionView, FiguresView
from sequence_planner.control.view import PackML, StationView
from sequence_planner.control.vocabulary import Mode, Production
from sequence_planner.version import VERSION
from sequence_planner.web.noting import Noted
from sequence_planner.web.readiness import ReadinessCheck
from sequence_planner.web.retention_desk import RetentionDesk

PREFIX = "sequence_planner"


def of_server(noted: Noted, failing: Collection[ReadinessCheck], restarts: Mapping[str, int]) -> Iterator[Metric]:
    """What the server itself knows."""
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
    """What the controller has counted and timed since it began; nothing where it does not tell."""
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
    """What the station shows; nothing while it is not heard."""
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
    """When the newest backup was made; nothing where there is none."""
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


def of_retention(desk: RetentionDesk | None) -> Iterator[Metric]:
    """How much is kept, as it was looked at last, and whether it can be archived; nothing where nothing is kept."""
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
