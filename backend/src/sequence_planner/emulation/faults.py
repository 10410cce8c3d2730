"""Faults that emulated devices can have."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from sequence_planner.expressions.types import Value


class FaultKind(StrEnum):
    """What can be wrong with a device."""

    SILENT = "silent"  # it says nothing
    STUCK = "stuck"  # it says what it said when the fault began
    WRONG = "wrong"  # it says another value than is true
    OFFLINE = "offline"  # it is not on the network
    RESTARTED = "restarted"  # offline, and then as at the beginning, without a command
    SLOW = "slow"  # it takes so many times as long for everything
    DROP = "drop"  # a share of its messages, and of those to it, is lost
    GARBAGE = "garbage"  # it sends bytes without sense


@dataclass(frozen=True)
class Fault:
    """A fault of a resource, of a topic of it or of a measured variable.

    `amount` is how many times as slow it is, or the share of messages that is lost; `value` is the wrong one. Without
    `seconds` it lasts until it is cleared.
    """

    kind: FaultKind
    target: str
    amount: float = 1.0
    value: Value | None = None
    seconds: float | None = None

    def __str__(self) -> str:
        behind = {
            FaultKind.WRONG: f" {str(self.value).lower() if isinstance(self.value, bool) else self.value}",
            FaultKind.SLOW: f" {self.amount:g}",
            FaultKind.DROP: f" {self.amount:g}",
        }.get(self.kind, "")
        lasting = "" if self.seconds is None else f" for {self.seconds:g} s"
        return f"{self.target} {self.kind}{behind}{lasting}"


@dataclass(frozen=True)
class Clear:
    """The end of all faults, or of those of one target."""

    target: str | None = None

    def __str__(self) -> str:
        return "clear" if self.target is None else f"clear {self.target}"
