"""Language service for texts of a draft: diagnostics, formatting, and completion and hover views."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from sequence_planner.automaton.findings import Findings
from sequence_planner.editor.language.completion import Completion, Option
from sequence_planner.editor.language.field import FieldKind, TextField
from sequence_planner.editor.language.hover import Hover
from sequence_planner.editor.language.schemas import (
    CompletionView,
    DeclarationView,
    HoverView,
    OptionView,
    ProblemView,
)
from sequence_planner.editor.language.scope import Lexicon
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.syntax import ExpressionError, Span
from sequence_planner.language.types import Place
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import Message

# What is wrong with a text: what grounding finds in it, at the places where it does.


@dataclass(frozen=True, order=True)
class TextProblem:
    """One thing wrong with a text, from `start` to `end` of it; both are its end where something is missing."""

    start: int
    end: int
    message: str


class _FoundIn(Findings):
    """The findings in one text, and nothing of what is found elsewhere meanwhile."""

    def __init__(self, text: SourceText) -> None:
        super().__init__()
        self._text = text
        self.problems: dict[TextProblem, None] = {}

    def add(self, where: SourceText | Place, message: str) -> None:
        if where is self._text:
            self.problems[TextProblem(0, len(self._text), message)] = None

    def add_within(self, text: SourceText, span: Span, message: str) -> None:
        if text is self._text:
            self.problems[TextProblem(span.start, span.end, message)] = None


def check(lexicon: Lexicon, field: TextField, text: str) -> tuple[TextProblem, ...]:
    """Return what grounding would find in `text` at that field, for every choice of its parameters, each thing once."""
    source = SourceText(text, Place("", 1, 1), text)
    found = _FoundIn(source)
    meaning = lexicon.meaning(field, found)
    for scope in field.scopes(meaning):
        field.read(meaning, source, scope)
    return tuple(sorted(found.problems))


# A text as the printer writes it.

_FORMS: dict[FieldKind, tuple[Callable[[str], Any], Callable[[Any], str]]] = {
    FieldKind.CONDITION: (parse, print_expression),
    FieldKind.FORMULA: (parse_formula, print_expression),
    FieldKind.ACTION: (parse_assignment, print_assignment),
    FieldKind.ABILITY: (parse, print_expression),
}


def formatted(field: TextField, text: str) -> str:
    """`text` with one space between words and no bracket too many; it means the same, in the same names.

    What does not parse stays as it is, and so does what is no expression.
    """
    if field.kind not in _FORMS:
        return text
    read, write = _FORMS[field.kind]
    try:
        tree = read(text)
        printed = write(tree)
        return printed if read(printed) == tree else text
    except ExpressionError:
        return text


# What the page is told about a text, made from what was found.


def problem_view(problem: TextProblem) -> ProblemView:
    """The view of `problem`."""
    said = problem.message if isinstance(problem.message, Message) else None
    return ProblemView(start=problem.start, end=problem.end, message=problem.message, said=said)


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
        definition=hover.definition,
        expansion=hover.expansion,
        declared=place and DeclarationView(file=place.file, line=place.line, column=place.column),
    )


def _option_view(option: Option) -> OptionView:
    return OptionView(label=option.label, insert=option.insert, kind=option.kind, detail=option.detail)
