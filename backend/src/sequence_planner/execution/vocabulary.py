"""Words for how a station stands, which its core, its commands and its views have in common."""

from __future__ import annotations

from enum import StrEnum


class Mode(StrEnum):
    """Mode of execution (see `docs/semantics.md`)."""

    AUTOMATIC = "automatic"
    PAUSED = "paused"  # what runs may finish, nothing is started
    HOLD = "hold"  # paused, and what runs was called off where it can be
    RESTART = "restart"  # operations are paused; operator plans are carried out one by one


class Production(StrEnum):
    """State of production: nothing is published until a person has started it."""

    PREPARING = "preparing"  # the safe set is being computed, or the links are being checked
    WAITING = "waiting"  # ready; waits for a person to start production
    STARTED = "started"


class PlanStatus(StrEnum):
    """Status of the plan."""

    IDLE = "idle"  # no operation is active, so there is nothing to plan
    PLANNING = "planning"  # none yet, a worker is at it
    FOLLOWED = "followed"
    BROKEN = "broken"  # the state departed from it; a new one is being looked for
    NONE = "none"  # no plan was found


class JobState(StrEnum):
    """State of a job."""

    WAITING = "waiting"  # taken, but what its product brings is not there yet
    RUNNING = "running"
    PAUSED = "paused"  # none of its operations is active
    ENDED = "ended"  # all its operations are completed
    STOPPED = "stopped"  # ended by an order to begin nothing more
    ABORTED = "aborted"

    @property
    def is_over(self) -> bool:
        """True if it never changes any more."""
        return self in (JobState.ENDED, JobState.STOPPED, JobState.ABORTED)


class ServiceKind(StrEnum):
    """Kinds of things that can be taken out of service."""

    RESOURCE = "resource"
    ABILITY = "ability"
    OPERATION = "operation"
