"""What is asked about the orders of a station: the jobs under way as they are shown, then those that wait."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Final

from sequence_planner.control.job_view import JobStepState, JobView
from sequence_planner.control.view import StationView
from sequence_planner.control.vocabulary import JobState
from sequence_planner.control.work_master_view import WorkMastersView, WorkMasterView
from sequence_planner.mes.order import JobOrder
from sequence_planner.mes.order_of_work import order_of_work
from sequence_planner.mes.sequencing.known_times import KnownTimes
from sequence_planner.mes.sequencing.work import Operation, Work
from sequence_planner.mes.states import OrderState

MOST: Final = 1000  # orders that are put into an order, the first by rule; the others follow by rule


@dataclass(frozen=True)
class Asked:
    """Works, and groups of them of which no two may overlap."""

    works: tuple[Work, ...]
    exclusive: tuple[frozenset[str], ...]


def asked(orders: Sequence[JobOrder], view: StationView, masters: WorkMastersView, known: KnownTimes) -> Asked:
    """The works of orders that the station works on or may start. Jobs that are paused are none: nobody knows when they
    go on.
    """
    chosen = [each for each in orders if each.is_at_station or each.state is OrderState.ALLOWED_TO_START]
    first = sorted(order_of_work(chosen), key=lambda order: not order.is_at_station)
    works: list[Work] = []
    groups: dict[str, set[str]] = defaultdict(set)
    for order in islice(first, MOST):
        master, job = masters.work_masters.get(order.work_master), view.jobs.get(order.id)
        if master is None or (job is not None and (job.state is JobState.PAUSED or job.state.is_over)):
            continue
        works.append(_work(order, master, job, view, known))
        for name in (*master.operations, *master.brought):
            groups[name].add(order.id)
    exclusive = {frozenset(group) for group in groups.values() if len(group) > 1}
    return Asked(tuple(works), tuple(sorted(exclusive, key=sorted)))


def _work(order: JobOrder, master: WorkMasterView, job: JobView | None, view: StationView, known: KnownTimes) -> Work:
    operations: dict[str, Operation] = {}
    for name, operation in master.operations.items():
        step = None if job is None else job.steps.get(name)
        if step is not None and step.state is JobStepState.COMPLETED:
            continue
        resources = known.resources(name, _resources(operation.goal_reads, view))
        started = step.started if step is not None and step.state is JobStepState.ACTIVE else None
        operations[name] = Operation(frozenset(operation.after), known.seconds(name), resources, started)
    return Work(order.id, order.priority, order.due, order.earliest, operations, order.is_at_station)


def _resources(variables: Iterable[str], view: StationView) -> frozenset[str]:
    found = (view.variables[name].resource for name in variables if name in view.variables)
    return frozenset(name for name in found if name)


def held_up(jobs: Mapping[str, JobView]) -> frozenset[str]:
    """The jobs that may not go on by themselves: nothing of them is active. No other should wait for these for long."""
    return frozenset(
        id
        for id, job in jobs.items()
        if job.state is not JobState.RUNNING
        or not any(step.state is JobStepState.ACTIVE for step in job.steps.values())
    )
