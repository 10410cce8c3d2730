"""The types of messages that a station defines, and those that their fields name."""

from __future__ import annotations

import re

from sequence_planner.expressions.place import Place
from sequence_planner.expressions.syntax import Span
from sequence_planner.model.source import SourceText
from sequence_planner.workshop.references.occurrences import Gathered, Occurrence, Where
from sequence_planner.workshop.references.parts import Part
from sequence_planner.workshop.references.texts import Content, message_of

# The type of a field that is a message itself: of the same package, or with its package, and `msg` or without.
_FIELD = re.compile(r"\s*((?:([a-z]\w*)/(?:msg/)?)?([A-Z]\w*))(?:\[[^\]]*\])?\s+\w+")


def read_definitions(content: Content, gathered: Gathered) -> None:
    """Note each definition, and the types of its fields."""
    for file, text in content.definitions.items():
        name = message_of(file) or ""
        where = Where(file, (), f"message {name}", 0)
        none = Span(0, 0)
        gathered.occurrences.append(Occurrence(Part("message", None, name), where, None, none, none, True))
        own = name.partition("/")[0]
        for number, line in enumerate(text.splitlines(), start=1):
            if found := _FIELD.match(line):
                part = Part("message", None, f"{found[2] or own}/msg/{found[3]}")
                written = SourceText(found[1], Place(file, number, found.start(1) + 1), found[1])
                gathered.add(part, where, written)
