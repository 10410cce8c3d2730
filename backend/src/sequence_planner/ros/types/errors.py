"""The things that can be wrong with a message: its definition, its name, a value put into it, or the bytes received."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from sequence_planner.language.names import suggestions

_LIKENESS = 0.6


class MessageDefinitionError(Exception):
    """A definition file cannot be used. `line` and `column` count from 1; `text` says what is wrong and what to do."""

    def __init__(self, path: Path, line: int, text: str, column: int = 1) -> None:
        super().__init__(f"{path}:{line}:{column}: {text}")
        self.path = path
        self.line = line
        self.column = column
        self.text = text


class UnknownMessageTypeError(LookupError):
    """No message, service or action has this name. `suggestion` is the nearest name there is, if one is near."""

    def __init__(self, type_name: str, known: Iterable[str], kind: str = "message") -> None:
        self.type_name = type_name
        self.suggestion = nearest(type_name, known)
        hint = f", did you mean {self.suggestion}?" if self.suggestion else ""
        super().__init__(f"no {kind} type {type_name!r}{hint}")

    def __str__(self) -> str:
        """The message itself (LookupError's children may print its repr)."""
        return str(self.args[0])


class MessageValueError(ValueError):
    """A value does not fit its field. `path` is the field's, as in `pose.position.x` or `names[2]`."""

    def __init__(self, type_name: str, path: str, expected: str, found: object) -> None:
        place = f"{type_name} {path}" if path else type_name
        super().__init__(f"{place}: expected {expected}, found {_brief(found)}")
        self.type_name = type_name
        self.path = path
        self.expected = expected
        self.found = found


class MalformedMessageError(ValueError):
    """Received bytes are not a message of the type; most often the peer was built with another definition."""

    def __init__(self, type_name: str, reason: str) -> None:
        super().__init__(f"not a {type_name}: {reason}")
        self.type_name = type_name
        self.reason = reason


def nearest(name: str, known: Iterable[str]) -> str | None:
    """Return the name of `known` closest to `name`, or None when none is close."""
    candidates = sorted(known)
    if (found := suggestions.nearest(name, candidates, _LIKENESS)) is not None:
        return found[1]
    # `String`, `std_msgs/String` and `std_msg/msg/String` all mean the same to their author.
    tail = name.rsplit("/", 1)[-1]
    same_tail = [candidate for candidate in candidates if candidate.rsplit("/", 1)[-1] == tail]
    return same_tail[0] if same_tail else None


def _brief(value: object) -> str:
    text = repr(value)
    return f"{text if len(text) <= 60 else text[:57] + '...'} ({type(value).__name__})"
