"""Order queue: sequence and release of startable orders, and conflicts with preceding ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime

from sequence_planner.controller.views.details import WorkMastersView
from sequence_planner.controller.views.station import StationView
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.mes.order import JobOrder, OrderState
from sequence_planner.texts.message import Message, message

# In which order what may start is begun.

OrderOfWork = Callable[[Sequence[JobOrder]], list[JobOrder]]


def order_of_work(orders: Sequence[JobOrder]) -> list[JobOrder]:
    """The highest priority first, then what is due first, then what was stored first."""
    return sorted(orders, key=lambda each: (-each.priority, math.inf if each.due is None else each.due, each.number))


# Which of the orders that may start are handed to the station now, and what the others wait for.
#
# Two orders are in each other's way when they share an operation, or a variable that the products of both bring. What
# is in the way of an order that comes before it waits for that one, so that nothing is overtaken for ever.

_UNHEARD = message("order-waits.unheard")


@dataclass(frozen=True)
class Queue:
    """The orders that the station gets now, in this order, and of each other one that may start what it waits for.

    `revisions` has that of each of them, as it was looked at.
    """

    next: list[JobOrder] = field(default_factory=list)
    waits: dict[str, list[Message]] = field(default_factory=dict)
    revisions: dict[str, int] = field(default_factory=dict)

    def knows(self, order: JobOrder) -> bool:
        """Return whether it was looked at as it is."""
        return self.revisions.get(order.id) == order.revision


def queue(
    orders: Sequence[JobOrder],
    view: StationView | None,
    masters: WorkMastersView | None,
    now: float,
    sequence: OrderOfWork = order_of_work,
) -> Queue:
    """Return what comes of the orders that are not over. Without a `view` the station is not heard."""
    found, hindered = Queue(), station_waits(view)
    worked = _worked(orders, view)
    first: dict[str, str] = {}  # by work master, the title of the first that is not worked yet
    in_the_way_of: dict[str, list[Message]] = {}  # by work master, what is; there are few of these, and many orders
    waiting = [each for each in orders if each.state is OrderState.ALLOWED_TO_START and not each.is_at_station]
    for order in sequence(waiting):
        found.revisions[order.id] = order.revision
        waits = [*hindered, *_own_waits(order, masters, now)]
        if not waits and masters is not None:
            master = order.work_master
            if master not in in_the_way_of:
                in_the_way_of[master] = _in_front(masters, master, worked, first)
            waits = in_the_way_of[master]
            if master not in first:
                first[master] = order.title
                in_the_way_of.clear()
        if waits or masters is None:
            found.waits[order.id] = waits or [_UNHEARD]
        else:
            found.next.append(order)
    return found


def _in_front(
    masters: WorkMastersView, master: str, worked: Sequence[tuple[str, str]], first: Mapping[str, str]
) -> list[Message]:
    """Return what an order of this work master waits for, of those that are worked or that come first."""
    in_work = [title for title, other in worked if in_the_way(masters, master, other)]
    if in_work:
        return [message("order-waits.worked", title=title) for title in in_work]
    before = [title for other, title in first.items() if in_the_way(masters, master, other)]
    return [message("order-waits.first", title=title) for title in before]


def _worked(orders: Sequence[JobOrder], view: StationView | None) -> list[tuple[str, str]]:
    """The title and the work master of each job that the station may be working on."""
    known = {each.id for each in orders}
    strange = {} if view is None else {id_: job for id_, job in view.jobs.items() if id_ not in known}
    return [
        *((each.title, each.work_master) for each in orders if each.is_at_station),
        *((job.title, job.work_master) for job in strange.values() if not job.state.is_over),
    ]


def in_the_way(masters: WorkMastersView, one: str, other: str) -> bool:
    """Return whether jobs of these work masters cannot be worked at the same time."""
    first, second = masters.work_masters.get(one), masters.work_masters.get(other)
    if first is None or second is None:
        return one == other
    operations = first.operations.keys() & second.operations.keys()
    return bool(operations) or not set(first.brought).isdisjoint(second.brought)


def station_waits(view: StationView | None) -> list[Message]:
    """Return why the station begins no order now; empty where it does."""
    if view is None or view.production is Production.PREPARING:
        return [_UNHEARD if view is None else message("order-waits.preparing")]
    waits = [] if view.by_order else [message("order-waits.freely")]
    if view.production is not Production.STARTED:
        waits.append(message("order-waits.production"))
    if view.mode is not Mode.AUTOMATIC:
        waits.append(message(f"order-waits.{view.mode}"))
    return waits


def _own_waits(order: JobOrder, masters: WorkMastersView | None, now: float) -> list[Message]:
    waits = []
    if order.earliest is not None and order.earliest > now:
        earliest = datetime.fromtimestamp(order.earliest, UTC)
        waits.append(message("order-waits.earliest", time=f"{earliest:%Y-%m-%d %H:%M:%S}"))
    if masters is not None and order.work_master not in masters.work_masters:
        waits.append(message("order-waits.no-master", name=order.work_master))
    return waits
