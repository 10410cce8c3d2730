"""A job order as it is answered over REST."""

from __future__ import annotations

from collections.abc import Sequence

from pydantic import BaseModel

from sequence_planner.mes.order import JobOrder
from sequence_planner.mes.states import OrderCommand, OrderState, Wish
from sequence_planner.mes.times import iso
from sequence_planner.web.order_desk import OrderDesk

_COMMANDS = {
    Wish.PAUSE: OrderCommand.PAUSE,
    Wish.RESUME: OrderCommand.RESUME,
    Wish.STOP: OrderCommand.STOP,
    Wish.ABORT: OrderCommand.ABORT,
}


class OrderAnswer(BaseModel):
    """An order. Times are in seconds since the epoch, and in ISO 8601 where `_at` is added.

    `stored_by` is the name of a person or a key.

    `commanded` is what the station is still to do with it, `allowed` the commands that the order allows now. Since
    `began` the station works on it. `waits_for` says in words why nothing is done for it now.
    """

    id: str
    work_master: str
    description: str
    priority: int
    due: float | None
    due_at = iso("due", optional=True)
    earliest: float | None
    earliest_at = iso("earliest", optional=True)
    state: OrderState
    commanded: OrderCommand | None
    allowed: list[OrderCommand]
    revision: int
    stored: float
    stored_at = iso("stored")
    stored_by: str
    changed: float
    changed_at = iso("changed")
    began: float | None
    began_at = iso("began", optional=True)
    ended: float | None
    ended_at = iso("ended", optional=True)
    waits_for: list[str]


_KEPT = OrderAnswer.model_fields.keys() & JobOrder.model_fields.keys()


def answered(order: JobOrder, desk: OrderDesk) -> OrderAnswer:
    """An order as it is told to who asks `desk`, which knows how it stands at the station."""
    return all_answered([order], desk)[0]


def all_answered(orders: Sequence[JobOrder], desk: OrderDesk) -> list[OrderAnswer]:
    """Orders as they are told to who asks `desk`."""
    waits = desk.waits_for(orders)
    return [
        OrderAnswer(
            **each.model_dump(include=_KEPT),
            commanded=None if each.wish is None else _COMMANDS[each.wish],
            allowed=[] if each.removed is not None else list(each.allowed),
            waits_for=waits[each.id],
        )
        for each in orders
    ]
