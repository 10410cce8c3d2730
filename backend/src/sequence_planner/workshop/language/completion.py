"""What can be written at a place of a text."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from sequence_planner.workshop.language_view import NameKind

MOST_OPTIONS = 100


@dataclass(frozen=True)
class Option:
    """One thing that can be written: `label` is what is shown, `insert` what is written, `detail` its type or so.

    What ends in a dot or an opening bracket stands for all that begins so.
    """

    label: str
    insert: str
    kind: NameKind
    detail: str = ""


@dataclass(frozen=True)
class Completion:
    """Options for the text between `start` and `end`, the most useful first."""

    start: int
    end: int
    options: tuple[Option, ...]


def completion(start: int, end: int, options: Iterable[Option]) -> Completion:
    """The first of `options`, each once."""
    different = {option.insert: option for option in reversed(list(options))}
    return Completion(start, end, tuple(reversed(different.values()))[:MOST_OPTIONS])


def option(text: str, kind: NameKind, detail: object = "") -> Option:
    """An option that is written as it is shown."""
    return Option(text, text, kind, str(detail))
