"""Fields of a record by their paths, such as `pose.position.x`, `joints[0]` or `transforms[0].header.frame_id`.

A path is found once, in the types; reading by it is then a few look-ups. What a stage gives is a field by the whole of
its name, so that `pose.position.x` given by a stage stands before that of the nested message.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.counting import counted
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.pipelines.record import FieldType, ListType, NestedType, RecordType

_STEP = re.compile(r"\.([A-Za-z_]\w*)|\[(\d+)\]")


@dataclass(frozen=True)
class FieldPath:
    """Where a field is: its key in the record, and from there through nested messages (names) and lists (indices)."""

    text: str
    key: str
    steps: tuple[str | int, ...] = ()

    def get(self, values: Mapping[str, object]) -> object:
        """Its value in a record; None where it is unknown or there is none."""
        value = values.get(self.key)
        for step in self.steps:
            if isinstance(step, int):
                value = value[step] if isinstance(value, list) and step < len(value) else None
            else:
                value = value.get(step) if isinstance(value, dict) else None
        return value

    def read(self, values: Mapping[str, object], troubles: list[str]) -> object:
        """The same for what makes something of the value: a number that is not finite is unknown, and a trouble."""
        value = self.get(values)
        if isinstance(value, float) and not math.isfinite(value):
            troubles.append(f"{self} is {value}")
            return None
        return value

    def __str__(self) -> str:
        return self.text


class NoFieldError(Exception):
    """A record has no field of that path; the text says which part is missing, with what may have been meant."""


def find_field(fields: RecordType, text: str) -> tuple[FieldPath, FieldType]:
    """The path written `text`, and its type. Raises `NoFieldError`."""
    text = str(text)
    for key, rest in _divisions(text):
        if key in fields:
            steps = _steps(rest)
            if steps is None:
                raise NoFieldError(f"`{text}` is no path: write it as in `pose.position.x` or `joints[0]`")
            return FieldPath(text, key, steps), _follow(fields[key], key, steps)
    key = re.split(r"[.\[]", text)[0]
    raise NoFieldError(f"there is no field `{text}` here{suggestion(key if '.' not in text else text, fields)}")


def _divisions(text: str) -> list[tuple[str, str]]:
    """Every way to cut a path into a key and the steps behind it, the longest key first."""
    cuts = [match.start() for match in re.finditer(r"[.\[]", text) if match.start()]
    return [(text, ""), *((text[:cut], text[cut:]) for cut in reversed(cuts))]


def _steps(rest: str) -> tuple[str | int, ...] | None:
    steps: list[str | int] = []
    position = 0
    while position < len(rest):
        match = _STEP.match(rest, position)
        if match is None:
            return None
        steps.append(match[1] if match[1] is not None else int(match[2]))
        position = match.end()
    return tuple(steps)


def _follow(type_: FieldType, above: str, steps: tuple[str | int, ...]) -> FieldType:
    for step in steps:
        if isinstance(step, int):
            if not isinstance(type_, ListType):
                raise NoFieldError(f"`{above}` is {type_}, and no list")
            if type_.length is not None and step >= type_.length:
                raise NoFieldError(f"`{above}` has only {counted(type_.length, 'item')}, the first of which is [0]")
            type_, above = type_.element, f"{above}[{step}]"
        else:
            if not isinstance(type_, NestedType):
                raise NoFieldError(f"`{above}` is {type_}, which has no fields")
            if step not in type_.fields:
                raise NoFieldError(f"`{above}` has no field `{step}`{suggestion(step, type_.fields)}")
            type_, above = type_.fields[step], f"{above}.{step}"
    return type_
