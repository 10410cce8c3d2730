"""What the page is told about a text, made from what was found."""

from __future__ import annotations

from sequence_planner.workshop.language.checking import Problem
from sequence_planner.workshop.language.completion import Completion, Option
from sequence_planner.workshop.language.hovering import Hover
from sequence_planner.workshop.language_view import (
    CompletionView,
    DeclarationView,
    HoverView,
    OptionView,
    ProblemView,
)


def problem_view(problem: Problem) -> ProblemView:
    """The view of `problem`."""
    return ProblemView(start=problem.start, end=problem.end, message=problem.message)


def completion_view(completion: Completion) -> CompletionView:
    """The view of `completion`."""
    options = tuple(map(_option_view, completion.options))
    return CompletionView(start=completion.start, end=completion.end, options=options)


def hover_view(hover: Hover) -> HoverView:
    """The view of `hover`."""
    place = hover.place
    return HoverView(
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
        part=hover.part,
        declared=place and DeclarationView(file=place.file, line=place.line, column=place.column),
    )


def _option_view(option: Option) -> OptionView:
    return OptionView(label=option.label, insert=option.insert, kind=option.kind, detail=option.detail)
