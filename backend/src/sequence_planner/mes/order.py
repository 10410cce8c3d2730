"""A job order: what a MES wants to be made, and where that stands."""

from __future__ import annotations

import json

from pydantic import BaseModel, ConfigDict
from sqlalchemy import RowMapping

from sequence_planner.actor import Actor
from sequence_planner.mes.states import OVER, OrderCommand, OrderState, Wish, allowed

LONGEST_TITLE = 200  # characters


class OrderContent(BaseModel):
    """What is ordered: a job of a work master.

    How late it is weighs by its `priority`; nothing begins before `earliest`. Times are in seconds
    since the epoch.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    work_master: str
    description: str = ""
    priority: int = 0
    due: float | None = None
    earliest: float | None = None


class JobOrder(OrderContent):
    """An order as it is stored; `number` counts the orders as they came, `revision` the changes of this one.

    Since it was `handed_over` the station may work on it, `wish` is what it is still to do with it.
    """

    number: int
    id: str
    state: OrderState
    revision: int
    stored: float
    stored_by: str
    changed: float
    handed_over: float | None
    began: float | None
    ended: float | None
    wish: Wish | None
    wished_by: Actor | None
    wished_because: str | None
    removed: float | None

    @classmethod
    def of(cls, row: RowMapping) -> JobOrder:
        """The order in a row of its table."""
        by = row["wished_by"]
        return cls.model_validate({**row, "wished_by": None if by is None else json.loads(by)})

    @property
    def allowed(self) -> tuple[OrderCommand, ...]:
        """The commands that it allows now."""
        return allowed(self.state, handed_over=self.handed_over is not None, wish=self.wish)

    @property
    def is_over(self) -> bool:
        """Whether nothing more will be made of it."""
        return self.state in OVER

    @property
    def is_at_station(self) -> bool:
        """Whether the station works on it, or may do so by now."""
        return self.handed_over is not None and not self.is_over

    @property
    def title(self) -> str:
        """What people at the station call it."""
        return (self.description.strip() or self.id)[:LONGEST_TITLE]
