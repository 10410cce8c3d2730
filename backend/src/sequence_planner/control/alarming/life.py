"""The life of an alarm (ISA-18.2): from when it comes until it has gone and a person knows of it.

Where an alarm stands is never said twice: it follows from whether its cause is there, whether somebody has
acknowledged it, and whether it has been put aside.
"""

from __future__ import annotations

from dataclasses import dataclass

from sequence_planner.control.alarm_view import AlarmState, AlarmView, Priority
from sequence_planner.control.alarming.cause import Cause
from sequence_planner.control.moment import Moment


@dataclass(frozen=True)
class Aside:
    """An alarm is not told: it is shelved `until` some time, or out of service where there is none."""

    by: str
    why: str
    until: Moment | None


@dataclass
class Life:
    """One alarm. `cause` is what was said of it last, and `since` when it came last, in seconds since the epoch.

    `away` says since when its cause has not been there, `ended` that this counts. Without `acknowledged` somebody still
    has to take note; of an alarm of low priority nobody has to.
    """

    cause: Cause
    since: float
    acknowledged: bool = False
    count: int = 1
    by: str | None = None  # who has acknowledged it
    away: Moment | None = None
    ended: float | None = None
    aside: Aside | None = None
    part: bool = False  # it is told as a part of another
    worst: Priority = Priority.LOW  # how urgent it has been since somebody last had a reason to look

    @property
    def state(self) -> AlarmState:
        """Where it stands."""
        if self.aside is not None:
            return AlarmState.OUT_OF_SERVICE if self.aside.until is None else AlarmState.SHELVED
        if self.ended is not None:
            return AlarmState.RETURNED
        return AlarmState.ACKNOWLEDGED if self.acknowledged else AlarmState.UNACKNOWLEDGED

    @property
    def over(self) -> bool:
        """Whether there is nothing more to tell of it."""
        return self.ended is not None and self.aside is None and self.acknowledged

    @property
    def shown(self) -> bool:
        """Whether it has a place of its own; what is put aside is always in sight as such."""
        return self.aside is not None or not self.part

    def come(self, now: float, lasts: bool) -> None:
        """Its cause is there again. With `lasts` it had not been away long enough to count."""
        self.count += 1
        self.away = None
        if not lasts:
            self.since, self.ended = now, None
            self.must_be_seen()

    def must_be_seen(self) -> None:
        """Somebody has to take note of it, if anybody ever has to."""
        self.acknowledged = not needs_acknowledgement(self.cause)
        self.by, self.worst = None, self.cause.priority

    def acknowledge(self, by: str) -> None:
        """A person has taken note of it."""
        self.acknowledged, self.by, self.count = True, by, 0

    def view(self) -> AlarmView:
        """As it is shown. Of one that is over nothing comes any more, and nothing is to be done about it."""
        aside, cause, over = self.aside, self.cause, self.ended is not None
        return AlarmView(
            priority=cause.priority,
            state=self.state,
            text=cause.past if over else cause.text,
            consequence="" if over else cause.consequence,
            action="" if over else cause.action,
            since=self.since,
            ended=self.ended,
            by=self.by if aside is None else aside.by,
            until=None if aside is None or aside.until is None else aside.until.epoch,
            why=None if aside is None else aside.why,
            count=self.count,
            parts=list(cause.past_parts if over else cause.parts),
        )


def needs_acknowledgement(cause: Cause) -> bool:
    """Whether a person has to take note of such an alarm: of a mere notice nobody has to."""
    return cause.priority is not Priority.LOW
