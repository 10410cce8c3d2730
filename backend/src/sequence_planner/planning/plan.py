"""Questions to the planner and its answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from sequence_planner.expressions.types import Value

# What is said of a station that the planner would not do justice to.
NO_FORMULAS = "plans do not keep to `local` formulas yet, so this station is not run: say it as a specification"


@dataclass(frozen=True)
class PlanTick:
    """One tick of a plan: the effects that are expected in its sense, then the starts, in order."""

    effects: tuple[str, ...]
    starts: tuple[str, ...]


@dataclass(frozen=True)
class Plan:
    """A way to the goals. The goals hold after step 3 of the last tick at the latest, so it has no starts."""

    ticks: tuple[PlanTick, ...]
    minimal_ticks: bool
    minimal_starts: bool

    @property
    def starts(self) -> tuple[tuple[int, str], ...]:
        """The start order, each with the number of its tick, counted from 1."""
        return tuple((number, name) for number, tick in enumerate(self.ticks, 1) for name in tick.starts)


@dataclass(frozen=True)
class PlanRequest:
    """A state to plan from and the operations whose goals shall be reached, until `deadline` seconds have passed."""

    state: Mapping[str, Value | None]
    goals: tuple[str, ...]
    deadline: float = 5.0
    longest: int = 60


class Verdict(StrEnum):
    """What kind of answer it is."""

    FOUND = "found"
    NONE_UP_TO = "none up to"  # none within the searched number of ticks, or in time
    NONE_AT_ALL = "none at all"  # proven


@dataclass(frozen=True)
class PlanAnswer:
    """An answer. `left_out` are goals that could not be planned together with the others, lowest priority first.

    `searched` is the number of ticks up to which the search is complete; `seconds` is the time it took.
    """

    verdict: Verdict
    plan: Plan | None
    goals: tuple[str, ...]
    left_out: tuple[str, ...]
    searched: int
    seconds: float
