"""What the page is told about a text while it is written."""

from __future__ import annotations

from sequence_planner.control.view_part import Value, View
from sequence_planner.workshop.language.checking import Problem
from sequence_planner.workshop.language.completion import Completion, Option
from sequence_planner.workshop.language.hovering import Hover
from sequence_planner.workshop.language.names import NameKind


class ProblemView(View):
    """One thing wrong with a text; `start` and `end` count its characters."""

    start: int
    end: int
    message: str

    @classmethod
    def of(cls, problem: Problem) -> ProblemView:
        """The view of `problem`."""
        return cls(start=problem.start, end=problem.end, message=problem.message)


class OptionView(View):
    """One thing that can be written: what is shown of it, and what is written."""

    label: str
    insert: str
    kind: NameKind
    detail: str

    @classmethod
    def of(cls, option: Option) -> OptionView:
        """The view of `option`."""
        return cls(label=option.label, insert=option.insert, kind=option.kind, detail=option.detail)


class CompletionView(View):
    """What can stand in place of the text between `start` and `end`, the most useful first."""

    start: int
    end: int
    options: tuple[OptionView, ...]

    @classmethod
    def of(cls, completion: Completion) -> CompletionView:
        """The view of `completion`."""
        options = tuple(map(OptionView.of, completion.options))
        return cls(start=completion.start, end=completion.end, options=options)


class DeclarationView(View):
    """Where something is declared: a file of the station, and line and column from 1."""

    file: str
    line: int
    column: int


class HoverView(View):
    """What the name between `start` and `end` is.

    `names` are the full names it has, of which the page knows the values; a reference through a parameter has one for
    each choice, and `pattern` is then all of them at once. `domain` are the values of its `type`.
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
    declared: DeclarationView | None

    @classmethod
    def of(cls, hover: Hover) -> HoverView:
        """The view of `hover`."""
        place = hover.place
        return cls(
            start=hover.start,
            end=hover.end,
            name=hover.name,
            kind=hover.kind,
            pattern=hover.pattern,
            names=hover.names,
            type=None if hover.type is None else str(hover.type),
            domain=() if hover.type is None else hover.type.domain,
            initial=hover.initial,
            resource=hover.resource,
            title=hover.title,
            declared=place and DeclarationView(file=place.file, line=place.line, column=place.column),
        )
