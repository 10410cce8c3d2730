"""What is shelved or out of service, written down so that it is so again after the controller was started anew."""

from __future__ import annotations

from collections.abc import Mapping

from pydantic import BaseModel, ConfigDict, JsonValue, TypeAdapter, ValidationError

from sequence_planner.control.alarm_view import Priority
from sequence_planner.control.alarming.cause import Cause
from sequence_planner.control.alarming.life import Aside, Life
from sequence_planner.control.moment import Moment

KIND = "alarms-aside"  # of the record


class PutAside(BaseModel):
    """One that is put aside, and what was said of it last. `until` is null where it is out of service."""

    model_config = ConfigDict(frozen=True)
    priority: Priority
    text: str
    past: str = ""  # of a program that did not write it
    consequence: str
    action: str
    by: str
    why: str
    until: float | None

    @classmethod
    def of(cls, life: Life, aside: Aside) -> PutAside:
        """To be written down."""
        cause, until = life.cause, None if aside.until is None else aside.until.epoch
        return cls(
            priority=cause.priority,
            text=cause.text,
            past=cause.past,
            consequence=cause.consequence,
            action=cause.action,
            by=aside.by,
            why=aside.why,
            until=until,
        )

    def cause(self, key: str) -> Cause:
        """What was said of it."""
        return Cause(key, self.priority, self.text, self.consequence, self.action, past=self.past or self.text)

    def aside(self, now: Moment) -> Aside:
        """That it is put aside."""
        until = None
        if self.until is not None:
            until = Moment(self.until, now.monotonic + self.until - now.epoch)
        return Aside(self.by, self.why, until)


_ALL: TypeAdapter[dict[str, PutAside]] = TypeAdapter(dict[str, PutAside])


def aside_to_keep(lives: Mapping[str, Life]) -> dict[str, JsonValue]:
    """The content of a record of all that is put aside."""
    return aside_again({key: PutAside.of(life, life.aside) for key, life in lives.items() if life.aside is not None})


def aside_again(kept: Mapping[str, PutAside]) -> dict[str, JsonValue]:
    """The content of a record of what such a record has said."""
    found: JsonValue = _ALL.dump_python(dict(kept), mode="json")
    assert isinstance(found, dict)
    return {"aside": found}


def aside_from(content: Mapping[str, JsonValue]) -> dict[str, PutAside]:
    """What such a record says; nothing where it is of a program that wrote it differently."""
    try:
        return _ALL.validate_python(content.get("aside", {}))
    except ValidationError:
        return {}
