"""The things that the page is told about a text while it is written."""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.controller.views.part import Value, View
from sequence_planner.texts.message import Message


class NameKind(StrEnum):
    """Kind of a word in a text."""

    MEASURED = "measured"
    OUTPUT = "output"
    ESTIMATED = "estimated"
    FLAG = "flag"
    ACTIVITY = "activity"
    PARAMETER = "parameter"
    VALUE = "value"
    KEYWORD = "keyword"
    RESOURCE = "resource"
    ABILITY = "ability"
    OPERATION = "operation"
    ENUMERATION = "enumeration"
    SET = "set"
    PREDICATE = "predicate"
    RELATION = "relation"
    MAP = "map"


class ProblemView(View):
    """One thing wrong with a text; `start` and `end` count its characters. `said` is the message for readers of other
    languages, null where there is none.
    """

    start: int
    end: int
    message: str
    said: Message | None


class OptionView(View):
    """One thing that can be written: what is shown of it, and what is written."""

    label: str
    insert: str
    kind: NameKind
    detail: str


class CompletionView(View):
    """Completions for the text between `start` and `end`, the most useful first."""

    start: int
    end: int
    options: tuple[OptionView, ...]


class DeclarationView(View):
    """Place of a declaration: a file of the station, and line and column from 1."""

    file: str
    line: int
    column: int


class HoverView(View):
    """What the name between `start` and `end` is.

    `names` are the full names it has, of which the page knows the values; a reference through a parameter has one for
    each choice, and `pattern` is then all of them at once. `domain` are the values of its `type`, and `part` is the id
    by which it is looked for in the model, but for a parameter. Where it is written for short, `definition` is the
    condition that it was given, and `expansion` what it stands for in the end.
    """

    start: int
    end: int
    name: str
    kind: NameKind
    pattern: str
    names: tuple[str, ...]
    type: str | None
    domain: tuple[Value, ...]
    initial: Value | None
    resource: str | None
    title: str | None
    part: str | None
    definition: str | None
    expansion: str | None
    declared: DeclarationView | None
