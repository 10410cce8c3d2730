"""Timestamps on the wall clock and the monotonic clock, and their ISO 8601 form for other systems."""

from __future__ import annotations

import re
import time
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Annotated, Any, Final

from pydantic import BaseModel, BeforeValidator, Field, WithJsonSchema, computed_field

# An instant on both clocks: one that people read, and one that never goes back.


@dataclass(frozen=True)
class Timestamp:
    """`epoch` in seconds since the epoch; `monotonic` in seconds of `time.monotonic`, as samples carry them."""

    epoch: float
    monotonic: float

    @classmethod
    def now(cls) -> Timestamp:
        """This instant."""
        return cls(time.time(), time.monotonic())

    def epoch_of(self, monotonic: float | None) -> float | None:
        """Seconds since the epoch of an instant on the other clock."""
        return None if monotonic is None else self.epoch - (self.monotonic - monotonic)


# Times for other systems: seconds since the epoch as ever, and beside them ISO 8601.

LATEST: Final = 1e11  # seconds; what every reader of JSON and every database keeps, up to the year 5138
_FORM: Final = (
    r"^(19[7-9][0-9]|[2-4][0-9]{3})-(0[1-9]|1[0-2])-(0[1-9]|[12][0-9]|3[01])T([01][0-9]|2[0-3]):[0-5][0-9]:[0-5][0-9]"
    r"(\.[0-9]{1,9})?(Z|[+-]([01][0-9]|2[0-3]):[0-5][0-9])$"
)
_WANTED: Final = (
    "this has to be a time: seconds since 1970-01-01 00:00 UTC, or ISO 8601 with its zone as in 2027-01-15T06:00:00Z"
)


def _seconds(value: object) -> object:
    """A text in ISO 8601 as seconds since the epoch; what is no text stays as it is."""
    if not isinstance(value, str):
        return value
    if re.fullmatch(_FORM, value) is None:
        raise ValueError(_WANTED)
    try:
        return max(datetime.fromisoformat(value).timestamp(), 0.0)
    except ValueError:  # no day of the calendar, such as the 30th of February
        raise ValueError(_WANTED) from None


Time = Annotated[
    float,
    Field(ge=0, le=LATEST, allow_inf_nan=False, strict=True),
    BeforeValidator(_seconds),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "number", "minimum": 0, "maximum": LATEST},
                {"type": "string", "format": "date-time", "pattern": _FORM},
            ]
        }
    ),
]
"""A time in a request: in seconds, or in ISO 8601; as a value it is in seconds."""


def iso(name: str, *, optional: bool = False) -> Any:  # noqa: ANN401 - pydantic finds the field in the class body
    """A field of an answer that has the time `name` in ISO 8601, UTC: `due_at = iso("due")`."""

    def told(model: BaseModel) -> datetime | None:
        seconds = getattr(model, name)
        return None if seconds is None else datetime.fromtimestamp(seconds, UTC)

    return computed_field(return_type=datetime | None if optional else datetime)(property(told))
