"""The states of a job order and the commands that each allows, after OPC 10031-4.

What is asked of an order that the station works on is a wish until the station has done it. Meanwhile the order allows
what it would once that has happened, so that the last word holds.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Final


class OrderState(StrEnum):
    """Where an order stands."""

    NOT_ALLOWED_TO_START = "NotAllowedToStart"
    ALLOWED_TO_START = "AllowedToStart"
    RUNNING = "Running"
    INTERRUPTED = "Interrupted"
    ENDED = "Ended"
    ABORTED = "Aborted"


class OrderCommand(StrEnum):
    """What may be asked of an order."""

    START = "Start"
    REVOKE_START = "RevokeStart"
    PAUSE = "Pause"
    RESUME = "Resume"
    STOP = "Stop"
    ABORT = "Abort"
    CANCEL = "Cancel"
    CLEAR = "Clear"


class Wish(StrEnum):
    """What is asked of an order that is worked, in the words of the controller."""

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
