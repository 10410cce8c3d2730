"""Life cycle of an alarm (ISA-18.2): its cause, urgency and consequences, and its persistent suppression."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pydantic import BaseModel, ConfigDict, JsonValue, TypeAdapter, ValidationError

from sequence_planner.controller.alarms.kinds import KINDS, AlarmKind, Cause
from sequence_planner.controller.views.station import AlarmGroup, AlarmMessages, AlarmState, AlarmView, Priority
from sequence_planner.core.clock import Timestamp
from sequence_planner.texts.message import Message, as_it_was

# How urgent an alarm is.

_URGENCY = (Priority.LOW, Priority.MEDIUM, Priority.HIGH)


def urgency(priority: Priority) -> int:
    """The more, the more urgent."""
    return _URGENCY.index(priority)


def most_urgent(*priorities: Priority) -> Priority:
    """The most urgent of them."""
    return max(priorities, key=urgency)


# The life of an alarm (ISA-18.2): from when it comes until it has gone and a person knows of it.
#
# Where an alarm stands is never said twice: it follows from whether its cause is there, whether somebody has
# acknowledged it, and whether it has been put aside.


@dataclass(frozen=True)
class Suppression:
    """An alarm is not told: it is shelved `until` some time, or out of service where there is none."""

    by: str
    why: str
    until: Timestamp | None


@dataclass
class Alarm:
    """One alarm. `cause` is what was said of it last, and `since` when it came last, in seconds since the epoch.

    `away` says since when its cause has not been there, `ended` that this counts. Without `acknowledged` somebody still
    has to take note; of an alarm of low priority nobody has to.
    """

    cause: Cause
    since: float
    acknowledged: bool = False
    count: int = 1
    by: str | None = None  # who has acknowledged it
    away: Timestamp | None = None
    ended: float | None = None
    aside: Suppression | None = None
    part: bool = False  # it is told as a part of another
    worst: Priority = Priority.LOW  # how urgent it has been since somebody last had a reason to look

    @property
    def state(self) -> AlarmState:
        """The state in which it stands."""
        if self.aside is not None:
            return AlarmState.OUT_OF_SERVICE if self.aside.until is None else AlarmState.SHELVED
        if self.ended is not None:
            return AlarmState.RETURNED
        return AlarmState.ACKNOWLEDGED if self.acknowledged else AlarmState.UNACKNOWLEDGED

    @property
    def over(self) -> bool:
        """True if there is nothing more to tell of it."""
        return self.ended is not None and self.aside is None and self.acknowledged

    @property
    def shown(self) -> bool:
        """True if it has a place of its own; what is put aside is always in sight as such."""
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
        text, parts = (cause.past, cause.past_parts) if over else (cause.text, cause.parts)
        consequence, action = (None, None) if over else (cause.consequence, cause.action)
        return AlarmView(
            kind=cause.kind.name,
            subject=cause.subject,
            group=cause.kind.group,
            priority=cause.priority,
            state=self.state,
            text=str(text),
            consequence="" if consequence is None else str(consequence),
            action="" if action is None else str(action),
            parts=[str(part) for part in parts],
            messages=AlarmMessages(text, consequence, action, parts),
            resources=list(cause.resources),
            topics=list(cause.topics),
            since=self.since,
            ended=self.ended,
            by=self.by if aside is None else aside.by,
            until=None if aside is None or aside.until is None else aside.until.epoch,
            why=None if aside is None else aside.why,
            count=self.count,
        )


def needs_acknowledgement(cause: Cause) -> bool:
    """Return whether a person has to take note of such an alarm: of a mere notice nobody has to."""
    return cause.priority is not Priority.LOW


# What is shelved or out of service, written down so that it is so again after the controller was started anew.

KIND = "alarms-aside"  # of the record


class PutAside(BaseModel):
    """One that is put aside, and what was said of it last. `until` is null where it is out of service."""

    model_config = ConfigDict(frozen=True)
    priority: Priority
    text: Message | str  # a string where it is of a program that wrote no other
    past: Message | str = ""
    consequence: Message | str
    action: Message | str
    kind: str = ""
    subject: str = ""
    by: str
    why: str
    until: float | None

    @classmethod
    def of(cls, life: Alarm, aside: Suppression) -> PutAside:
        """To be written down."""
        cause, until = life.cause, None if aside.until is None else aside.until.epoch
        return cls(
            priority=cause.priority,
            text=cause.text,
            past=cause.past,
            consequence=cause.consequence,
            action=cause.action,
            kind=cause.kind.name,
            subject=cause.subject,
            by=aside.by,
            why=aside.why,
            until=until,
        )

    def cause(self, key: str) -> Cause:
        """Return the cause, as what was said of it."""
        kind, subject = (self.kind, self.subject) if self.kind else key.partition(":")[::2]
        said = (self.text, self.consequence, self.action, self.past or self.text)
        text, consequence, action, past = (as_it_was(each) for each in said)
        known = KINDS.get(kind, AlarmKind(kind, self.priority, AlarmGroup.SYSTEM))
        return Cause(key, known, subject, self.priority, text, consequence, action, past)

    def aside(self, now: Timestamp) -> Suppression:
        """That it is put aside."""
        until = None
        if self.until is not None:
            until = Timestamp(self.until, now.monotonic + self.until - now.epoch)
        return Suppression(self.by, self.why, until)


_ALL: TypeAdapter[dict[str, PutAside]] = TypeAdapter(dict[str, PutAside])


def aside_to_keep(lives: Mapping[str, Alarm]) -> dict[str, JsonValue]:
    """The content of a record of all that is put aside."""
    return aside_again({key: PutAside.of(life, life.aside) for key, life in lives.items() if life.aside is not None})


def aside_again(kept: Mapping[str, PutAside]) -> dict[str, JsonValue]:
    """The content of a record of what such a record has said."""
    found: JsonValue = _ALL.dump_python(dict(kept), mode="json")
    assert isinstance(found, dict)
    return {"aside": found}


def aside_from(content: Mapping[str, JsonValue]) -> dict[str, PutAside]:
    """Return what such a record says; nothing where it is of a program that wrote it differently."""
    try:
        return _ALL.validate_python(content.get("aside", {}))
    except ValidationError:
        return {}
