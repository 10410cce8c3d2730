"""The names of a record between the stages of a pipeline, and which of them are variables."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

from sequence_planner.expressions.syntax import Span
from sequence_planner.model.source import SourceText
from sequence_planner.workshop.references.naming import Naming, Word
from sequence_planner.workshop.references.occurrences import Where
from sequence_planner.workshop.references.parts import Part, variable_of

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_INDEX = re.compile(r"\[([^\[\]]*)\]")


class Field(NamedTuple):
    """A name in a record: the variable that it is, if it is one, and the enumeration over which it ranges."""

    part: Part | None
    enumeration: str | None = None


Fields = dict[str, Field]


class Names:
    """The names of the record that a resource's pipeline has, as they change from stage to stage.

    `given` are all names that some stage of it gives: others of an incoming one are as the message has them. `kinds`
    are the enumerations of names that are no variables.
    """

    def __init__(
        self,
        naming: Naming,
        resource: str,
        incoming: bool,
        fields: Fields,
        given: frozenset[str],
        kinds: Mapping[str, str] | None = None,
    ) -> None:
        self.naming = naming
        self.resource = resource
        self.incoming = incoming
        self.fields = fields
        self._given = given
        self._kinds = kinds or {}

    def read(
        self, text: object, where: Where, at: int = 0, end: int | None = None, *, is_message: bool = False
    ) -> str | None:
        """Note what the path between `at` and `end` of a text names; returns the enumeration over which it ranges.

        `is_message` holds for what is made something else of: in an incoming message that is a field of it.
        """
        found = self._found(str(text)[at:end], is_message) if isinstance(text, SourceText) else None
        if found is None or not isinstance(text, SourceText):
            return None
        field, start, base = found
        if field.part is None:
            return field.enumeration
        span = Span(at + start, at + start + len(base))
        self.naming.gathered.add(field.part, where, text, span)
        rest = self._arguments(field.part, text, span.end, where)
        return field.enumeration if not text[rest:end].strip() else None

    def is_known(self, path: str) -> bool:
        """Whether a path is of something else than a field of the message."""
        return self._found(path, False) is not None

    def enumeration(self, path: str) -> str | None:
        """The enumeration over which a path ranges."""
        found = self._found(path, False)
        return None if found is None else found[0].enumeration

    def give(self, text: object, where: Where, fixed: str | None = None) -> str | None:
        """Note the name that a stage gives; returns the enumeration over which that ranges."""
        if not isinstance(text, SourceText):
            return None
        match = _NAME.match(text)
        if not self.incoming or match is None:
            self.fields[str(text)] = Field(None)
            return None
        part = variable_of(self.resource, match[0])
        enumeration = self.naming.declared.enumeration(self.resource, match[0])
        if part.full not in self.naming.declared.variables:
            enumeration = self._kinds.get(match[0])
        self.naming.gathered.add(part, where, text, Span(0, match.end()), fixed=fixed, writes=True)
        self._arguments(part, text, match.end(), where)
        self.fields[match[0]] = Field(part, enumeration)
        return enumeration

    def _found(self, text: str, is_message: bool) -> tuple[Field, int, str] | None:
        """The field that a path begins with: where its own name begins in the path, and that name."""
        cuts = [match.start() for match in re.finditer(r"[.\[]", text)]
        for end in (len(text), *reversed(cuts)):
            key = text[:end]
            if key in self.fields:
                start = key.rfind(".") + 1
                return self.fields[key], start, key[start:]
        match = _NAME.match(text)
        if match is None or (self.incoming and (is_message or match[0] in self._given)):
            return None
        part = variable_of(self.resource, match[0])
        variable = self.naming.declared.variables.get(part.full)
        if variable is None or (self.incoming and variable.section != "measured"):
            return None
        return Field(part, self.naming.declared.enumeration(self.resource, match[0])), 0, match[0]

    def _arguments(self, part: Part, text: SourceText, at: int, where: Where) -> int:
        """Note the arguments of a variable behind its name; returns where they end."""
        variable = self.naming.declared.variables.get(part.full)
        match = _INDEX.match(text, at)
        if variable is None or match is None or not variable.parameters:
            return at
        words = tuple(
            Word(word[0], Span(match.start(1) + word.start(), match.start(1) + word.end()))
            for word in _NAME.finditer(match[1])
        )
        self.naming.note_arguments(words, variable.parameters, where, text)
        return match.end()
