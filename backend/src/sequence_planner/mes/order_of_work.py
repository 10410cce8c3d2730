"""In which order what may start is begun."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from sequence_planner.mes.order import JobOrder

OrderOfWork = Callable[[Sequence[JobOrder]], list[JobOrder]]


def order_of_work(orders: Sequence[JobOrder]) -> list[JobOrder]:
    """The highest priority first, then what is due first, then what was stored first."""
    return sorted(orders, key=lambda each: (-each.priority, math.inf if each.due is None else each.due, each.number))
