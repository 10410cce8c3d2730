"""The names in the picture of a station, so that they are found and renamed with what they name."""

from __future__ import annotations

import re

from sequence_planner.editor.symbols.collectors import Expressions, Naming
from sequence_planner.editor.symbols.index import ModelPart, TextContext, Where, variable_of
from sequence_planner.editor.symbols.texts import MIMIC, entry, items, pairs, text_at
from sequence_planner.language.syntax import Span
from sequence_planner.model.source import SourceText

VARIABLE_IN_BRACES = re.compile(r"\{(?:(\w+)\.)?(\w+)(?:\[[^\]{}]*\])?\}")


class MimicCollector:
    """Goes through `mimic.yaml`: what is bound, with which values, and what its texts say."""

    def __init__(self, naming: Naming, expressions: Expressions) -> None:
        self._naming, self._read, self._add = naming, expressions, naming.gathered.add

    def collect(self, content: object) -> None:
        """Note all names in the file."""
        for name, symbol in pairs(entry(content, "symbols")):
            at = Where(MIMIC, ("symbols", str(name)), f"symbol {name}", 2, TextContext(None, f"symbol.{name}"))
            if (resource := text_at(symbol, "resource")) is not None:
                self._add(ModelPart("resource", None, str(resource)), at.to("resource"), resource)
            self._read.condition(entry(symbol, "level"), at.to("level"))
            for key in ("active", "visible"):
                self._tests(entry(symbol, key), at.to(key))
            for index, line in enumerate(items(entry(symbol, "text"))):
                below = at.to("text", index)
                self._tests(entry(line, "when"), below.to("when"))
                self._said(entry(line, "say"), below.to("say"))
            for index, slot in enumerate(items(entry(symbol, "slots"))):
                self._tests(entry(slot, "holds"), at.to("slots", index, "holds"))
            for name_of, bind in pairs(entry(symbol, "bind")):
                below = at.to("bind", str(name_of))
                self._tests(entry(bind, "visible"), below.to("visible"))
                self._tests(entry(bind, "when"), below.to("when"))
                self._said(entry(bind, "text"), below.to("text"))
            for index, part in enumerate(items(entry(symbol, "parts"))):
                self._part(part, at.to("parts", index))
            self._track(entry(symbol, "track"), at.to("track"))

    def _tests(self, content: object, at: Where) -> None:
        for name, wanted in pairs(content):
            below = at.to(name)
            self._read.condition(name, below)
            enumeration = self._values_of(name)
            self._naming.note_value(enumeration, below, wanted)
            for index, each in enumerate(items(wanted)):
                self._naming.note_value(enumeration, below.to(index), each)

    def _track(self, content: object, at: Where) -> None:
        of = text_at(content, "of")
        for key in ("of", "to", "previous"):
            self._read.condition(entry(content, key), at.to(key))
        enumeration = None if of is None else self._values_of(of)
        for stop, _ in pairs(entry(content, "stops")):
            self._naming.note_value(enumeration, at.to("stops", stop), stop)
        for index, way in enumerate(items(entry(content, "ways"))):
            for end, each in enumerate(items(way)):
                self._naming.note_value(enumeration, at.to("ways", index, end), each)

    def _part(self, content: object, at: Where) -> None:
        """A part of the product: its variable may be named without its index."""
        if (of := text_at(content, "of")) is None:
            return
        if str(of) in self._naming.declared.variables and "." not in of:
            self._add(variable_of(None, str(of)), at.to("of"), of)
        else:
            self._read.condition(of, at.to("of"))
        for value, _ in pairs(entry(content, "looks")):
            self._naming.note_value(self._values_of(of), at.to("looks", value), value)

    def _values_of(self, variable: str) -> str | None:
        resource, _, name = variable.partition("[")[0].rpartition(".")
        return self._naming.declared.enumeration(resource or None, name)

    def _said(self, content: object, at: Where) -> None:
        """A text for people, in which a variable stands in braces."""
        if isinstance(content, SourceText):
            for match in VARIABLE_IN_BRACES.finditer(content):
                resource, name = match.groups()
                if resource is not None:
                    self._add(ModelPart("resource", None, resource), at, content, Span(*match.span(1)))
                self._add(variable_of(resource, name), at, content, Span(*match.span(2)))
        for language, each in pairs(content):
            self._said(each, at.to(language))
