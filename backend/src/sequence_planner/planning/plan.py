"""Questions to the planner and its answers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
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
        return starts_of(self.ticks)


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


@dataclass(frozen=True)
class WayBackRequest:
    """A state outside the safe set, from which a way back is wanted until `deadline` seconds have passed."""

    state: Mapping[str, Value | None]
    deadline: float = 2.0
    longest: int = 40


@dataclass(frozen=True)
class WayBack:
    """A way into the safe set, with the fewest ticks and then the fewest starts.

    `end` is the first safe state on it, one after step 3 or after the last of its starts. `breaks` are the
    specifications that it violates on the way although they were not violated before.
    """

    ticks: tuple[PlanTick, ...]
    end: Mapping[str, Value | None]
    breaks: tuple[str, ...]
    minimal_starts: bool

    @property
    def starts(self) -> tuple[tuple[int, str], ...]:
        """The starts in order, each with the number of its tick, counted from 1."""
        return starts_of(self.ticks)


@dataclass(frozen=True)
class WayBackAnswer:
    """An answer. Without a way, there is none of up to `searched` ticks.

    `threatened` are specifications that are not violated yet and that what happens without starts, faults included, can
    violate soonest; none are named while one is violated.
    """

    way: WayBack | None
    threatened: tuple[str, ...]
    searched: int
    seconds: float


Request = PlanRequest | WayBackRequest
Answer = PlanAnswer | WayBackAnswer


def starts_of(ticks: Iterable[PlanTick]) -> tuple[tuple[int, str], ...]:
    """All starts, each with the number of its tick, counted from 1."""
    return tuple((number, name) for number, tick in enumerate(ticks, 1) for name in tick.starts)
