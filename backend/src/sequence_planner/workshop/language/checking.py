"""What is wrong with a text: what grounding finds in it, at the places where it does."""

from __future__ import annotations

from dataclasses import dataclass

from sequence_planner.automaton.grounding.findings import Findings
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.syntax import Span
from sequence_planner.model.source import SourceText
from sequence_planner.workshop.language.field import Field
from sequence_planner.workshop.language.lexicon import Lexicon


@dataclass(frozen=True, order=True)
class Problem:
    """One thing wrong with a text, from `start` to `end` of it; both are its end where something is missing."""

    start: int
    end: int
    message: str


class _FoundIn(Findings):
    """What is found in one text, and nothing of what is found elsewhere meanwhile."""

    def __init__(self, text: SourceText) -> None:
        super().__init__()
        self._text = text
        self.problems: dict[Problem, None] = {}

    def add(self, where: SourceText | Place, message: str) -> None:
        if where is self._text:
            self.problems[Problem(0, len(self._text), message)] = None

    def add_within(self, text: SourceText, span: Span, message: str) -> None:
        if text is self._text:
            self.problems[Problem(span.start, span.end, message)] = None


def check(lexicon: Lexicon, field: Field, text: str) -> tuple[Problem, ...]:
    """What grounding would find in `text` at that field, for every choice of its parameters, each thing once."""
    source = SourceText(text, Place("", 1, 1), text)
    found = _FoundIn(source)
    meaning = lexicon.meaning(field, found)
    for scope in field.scopes(meaning):
        field.read(meaning, source, scope)
    return tuple(sorted(found.problems))
