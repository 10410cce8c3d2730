"""The names in the scenarios by which a station is tested, so that they are found and renamed with what they name."""

from __future__ import annotations

import re
from collections.abc import Callable

from sequence_planner.editor.symbols.collectors import Expressions, Naming
from sequence_planner.editor.symbols.index import ModelPart, TextContext, Where, variable_of
from sequence_planner.editor.symbols.texts import entry, items, pairs, text_at
from sequence_planner.language.syntax import Span
from sequence_planner.model.source import SourceText

# Notes what a text names at some place.
NameNote = Callable[[object, Where], None]

_WORD = re.compile(r"\S+")


class ScenarioCollector:
    """Goes through files of `tests`; `operation` and `ability` note what names one."""

    def __init__(self, naming: Naming, expressions: Expressions, operation: NameNote, ability: NameNote) -> None:
        self._naming, self._read, self._add = naming, expressions, naming.gathered.add
        self._operation, self._ability = operation, ability

    def collect(self, file: str, content: object) -> None:
        """Note all names in a file."""
        for name, scenario in pairs(content):
            at = Where(file, (str(name),), f"scenario {name}", 1, TextContext(None, f"scenario.{name}"))
            self._values(entry(scenario, "given"), at.to("given"))
            never = entry(scenario, "never")
            self._read.condition(never, at.to("never"))
            for index, each in enumerate(items(never)):
                self._read.condition(each, at.to("never", index))
            for index, step in enumerate(items(entry(scenario, "steps"))):
                self._step(step, at.to("steps", index))

    def _step(self, step: object, at: Where) -> None:
        self._values(entry(step, "set"), at.to("set"))
        self._read.condition(entry(step, "holds"), at.to("holds"))
        self._operation(entry(step, "completes"), at.to("completes"))
        self._ability(entry(step, "done"), at.to("done"))
        starts = entry(step, "starts")
        self._ability(starts, at.to("starts"))
        for index, each in enumerate(items(starts)):
            self._ability(each, at.to("starts", index))
        if (fault := text_at(step, "fault")) is not None:
            self._fault(fault, at.to("fault"))

    def _values(self, content: object, at: Where) -> None:
        for name, value in pairs(content):
            below = at.to(name)
            self._read.condition(name, below)
            self._naming.note_value(self._values_of(name), below, value)

    def _values_of(self, variable: str) -> str | None:
        resource, _, name = variable.partition("[")[0].rpartition(".")
        return self._naming.declared.enumeration(resource or None, name)

    def _fault(self, text: SourceText, at: Where) -> None:
        """A fault: of which resource or variable, and the value that is wrong."""
        words = [(match[0], Span(*match.span())) for match in _WORD.finditer(text)]
        if words and words[0][0] == "clear":
            words = words[1:]
        if not words:
            return
        target, span = words[0]
        resource, dot, variable = target.partition(".")
        if resource in self._naming.declared.resources:
            end = span.start + len(resource)
            self._add(ModelPart("resource", None, resource), at, text, Span(span.start, end), whole=span)
            if dot:
                name = variable.partition("[")[0]
                named = Span(end + 1, end + 1 + len(name))
                self._add(variable_of(resource, name), at, text, named, whole=span)
        if len(words) > 2 and words[1][0] == "wrong":
            self._wrong(target, *words[2], text, at)

    def _wrong(self, target: str, value: str, span: Span, text: SourceText, at: Where) -> None:
        enumeration = self._values_of(target)
        if enumeration is not None and self._naming.has(enumeration, value):
            self._add(self._naming.declared.value(enumeration, value), at, text, span)
