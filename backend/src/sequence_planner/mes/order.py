"""A job order: content, states and permitted commands (OPC 10031-4), and its refusal."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from sqlalchemy import RowMapping

from sequence_planner.core.actor import Actor
from sequence_planner.core.data_models import DataModel
from sequence_planner.texts.refused import Refused

# The states of a job order and the commands that each allows, after OPC 10031-4.
#
# What is asked of an order that the station works on is a wish until the station has done it. Meanwhile the order
# allows what it would once that has happened, so that the last word holds.


class OrderState(StrEnum):
    """State of an order."""

    NOT_ALLOWED_TO_START = "NotAllowedToStart"
    ALLOWED_TO_START = "AllowedToStart"
    RUNNING = "Running"
    INTERRUPTED = "Interrupted"
    ENDED = "Ended"
    ABORTED = "Aborted"


class OrderCommand(StrEnum):
    """Requests that an order accepts."""

    START = "Start"
    REVOKE_START = "RevokeStart"
    PAUSE = "Pause"
    RESUME = "Resume"
    STOP = "Stop"
    ABORT = "Abort"
    CANCEL = "Cancel"
    CLEAR = "Clear"


class Wish(StrEnum):
    """The wish that is asked of an order that is worked, in the words of the controller."""

    PAUSE = "pause"
    RESUME = "resume"
    STOP = "stop"
    ABORT = "abort"


OVER: Final = frozenset({OrderState.ENDED, OrderState.ABORTED})
BEFORE_START: Final = frozenset({OrderState.NOT_ALLOWED_TO_START, OrderState.ALLOWED_TO_START})

_ALLOWED: Final[Mapping[OrderState, tuple[OrderCommand, ...]]] = MappingProxyType(
    {
        OrderState.NOT_ALLOWED_TO_START: (OrderCommand.START, OrderCommand.ABORT, OrderCommand.CANCEL),
        OrderState.ALLOWED_TO_START: (OrderCommand.REVOKE_START, OrderCommand.ABORT, OrderCommand.CANCEL),
        OrderState.RUNNING: (OrderCommand.PAUSE, OrderCommand.STOP, OrderCommand.ABORT),
        OrderState.INTERRUPTED: (OrderCommand.RESUME, OrderCommand.STOP, OrderCommand.ABORT),
        OrderState.ENDED: (OrderCommand.CLEAR,),
        OrderState.ABORTED: (OrderCommand.CLEAR,),
    }
)
_ALLOWED_WHILE: Final[Mapping[Wish, tuple[OrderCommand, ...]]] = MappingProxyType(
    {
        Wish.PAUSE: _ALLOWED[OrderState.INTERRUPTED],
        Wish.RESUME: _ALLOWED[OrderState.RUNNING],
        Wish.STOP: (OrderCommand.ABORT,),
        Wish.ABORT: (),
    }
)
WISHES: Final[Mapping[OrderCommand, Wish]] = MappingProxyType(
    {
        OrderCommand.PAUSE: Wish.PAUSE,
        OrderCommand.RESUME: Wish.RESUME,
        OrderCommand.STOP: Wish.STOP,
        OrderCommand.ABORT: Wish.ABORT,
    }
)
"""The commands that the station has to carry out where it works on the order."""

AT_ONCE: Final[Mapping[OrderCommand, OrderState]] = MappingProxyType(
    {
        OrderCommand.START: OrderState.ALLOWED_TO_START,
        OrderCommand.REVOKE_START: OrderState.NOT_ALLOWED_TO_START,
        OrderCommand.ABORT: OrderState.ABORTED,
    }
)
"""The state that a command leads to where the station does not work on the order."""


def allowed(state: OrderState, *, handed_over: bool, wish: Wish | None) -> tuple[OrderCommand, ...]:
    """The commands that an order allows. One that was `handed_over` may be at the station already."""
    if state in OVER or not handed_over:
        return _ALLOWED[state]
    if wish is not None:
        return _ALLOWED_WHILE[wish]
    # Until the station has said that it works on it, nothing but this has a meaning in either case.
    return (OrderCommand.ABORT,) if state is OrderState.ALLOWED_TO_START else _ALLOWED[state]


# A job order: what a MES wants to be made, and where that stands.

LONGEST_TITLE = 200  # characters
SHOWN_OF_DRAWN: Final = 4  # characters of a number that was drawn by lot
_DRAWN: Final = re.compile(r"[0-9a-f]{16}")  # as the server draws them


class OrderContent(DataModel):
    """What is ordered: a job of a work master.

    How late it is weighs by its `priority`; nothing begins before `earliest`. Times are in seconds
    since the epoch.
    """

    work_master: str
    description: str = ""
    priority: int = 0
    due: float | None = None
    earliest: float | None = None


def title_of(id: str, description: str) -> str:
    """Return what people call an order: its number, or what it is described as where the number was drawn by lot.

    Of a drawn number the end alone tells two of the same description from each other.
    """
    if _DRAWN.fullmatch(id) is None:
        return id[:LONGEST_TITLE]
    mark = id[-SHOWN_OF_DRAWN:]
    said = description.strip()
    return f"{said[: LONGEST_TITLE - len(mark) - 3]} · {mark}" if said else mark


class JobOrder(OrderContent):
    """An order as it is stored; `number` counts the orders as they came, `revision` the changes of this one.

    Since it was `handed_over` the station may work on it, `wish` is what it is still to do with it. That was wished, or
    it was paused or cancelled, because of `wished_because`.
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
    def from_row(cls, row: RowMapping) -> JobOrder:
        """The order in a row of its table."""
        by = row["wished_by"]
        return cls.model_validate({**row, "wished_by": None if by is None else json.loads(by)})

    @property
    def allowed(self) -> tuple[OrderCommand, ...]:
        """The commands that it allows now."""
        return allowed(self.state, handed_over=self.handed_over is not None, wish=self.wish)

    @property
    def is_over(self) -> bool:
        """True if nothing more will be made of it."""
        return self.state in OVER

    @property
    def is_at_station(self) -> bool:
        """True if the station works on it, or may do so by now."""
        return self.handed_over is not None and not self.is_over

    @property
    def title(self) -> str:
        """The name that people at the station call it by."""
        return title_of(self.id, self.description)


# Errors of the interface for job orders.


class OrderRefused(Refused):
    """A refusal: what was asked of an order is not done, and nothing has changed.

    `allowed` are the commands that the order does allow, where another one was given.
    """

    def __init__(self, slug: str, detail: str, status: int = 409, *, allowed: Sequence[OrderCommand] = ()) -> None:
        super().__init__(slug, detail, status)
        self.allowed = tuple(allowed)
