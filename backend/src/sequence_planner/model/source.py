"""Places in documents: a text knows the file, line and column it was written at, and so does what is wrong with it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Self, TypeVar

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from sequence_planner.language.syntax import Span
from sequence_planner.language.types import Place
from sequence_planner.texts.message import message


@dataclass(frozen=True, order=True)
class Finding:
    """One thing wrong with a model: where, what, and what would be right."""

    place: Place
    message: str

    def __str__(self) -> str:
        return f"{self.place}: {self.message}"


class ModelError(Exception):
    """A model that cannot be used, with all that was found wrong in it."""

    def __init__(self, findings: list[Finding]) -> None:
        self.findings = told_once(sorted(set(findings)))
        super().__init__("\n".join(map(str, self.findings)))


def told_once(findings: list[Finding]) -> list[Finding]:
    """The same, with one for what is wrong in a type, which names the instances that have it."""
    if not any(finding.place.instance for finding in findings):
        return findings
    return [
        Finding(alike[0].place._replace(instance=""), in_instances([each.place for each in alike], alike[0].message))
        for alike in alike_in_types(findings, lambda each: each)
    ]


T = TypeVar("T")


def alike_in_types(said: Iterable[T], finding: Callable[[T], Finding]) -> list[list[T]]:
    """What is said, each with its `finding`: what is the same of one place in a type, but for the names of its
    instances, together.
    """
    together: dict[tuple[Place, str], list[T]] = {}
    for each in said:
        place, message = (found := finding(each)).place, found.message
        own = re.escape(place.instance.partition(" ")[0] or "\0")
        together.setdefault((place._replace(instance=""), re.sub(rf"\b{own}\b", "\0", message)), []).append(each)
    return list(together.values())


def in_instances(places: Sequence[Place], what: str) -> str:
    """Say of which instances of a type something is said there; nothing more where it is not said of a type."""
    first, *others = (each.instance for each in places)
    if not first:
        return what
    names = [first, *(other.partition(" ")[0] for other in others)]
    instances = message("list.and", most=", ".join(names[:-1]), last=names[-1]) if others else first
    return message("found.in", instances=instances, what=what)


class SourceText(str):
    """A text from a document, which knows its place and how it was quoted."""

    __slots__ = ("place", "raw")
    place: Place
    raw: str

    def __new__(cls, text: str, place: Place, raw: str) -> Self:
        """`raw` is the text as written, quotes and line breaks included; it begins at `place`."""
        self = super().__new__(cls, text)
        self.place = place
        self.raw = raw
        return self

    def __reduce__(self) -> tuple[type[SourceText], tuple[str, Place, str]]:
        return SourceText, (str(self), self.place, self.raw)

    def at(self, span: Span) -> Place:
        """The place of a span of this text; the end of the text is just behind its last character.

        Quoting and folding only add quotes, escapes and white space, so counting the other characters finds the
        place again.
        """
        before = sum(not character.isspace() for character in self[: span.start])
        at_end = not self[span.start :].strip()
        written = _written(self.raw)
        if at_end:
            index = written[before - 1][1] if 0 < before <= len(written) else 0
        else:
            index = written[before][0] if before < len(written) else 0
        above = self.raw[:index]
        breaks = above.count("\n")
        column = index - above.rfind("\n") if breaks else self.place.column + index
        return self.place._replace(line=self.place.line + breaks, column=column)

    def written(self, span: Span) -> tuple[int, int]:
        """Return where a span of this text, which begins and ends with no white space, begins and ends in `raw`."""
        before, length = (
            sum(not character.isspace() for character in part)
            for part in (self[: span.start], self[span.start : span.end])
        )
        characters = _written(self.raw)
        return characters[before][0], characters[before + length - 1][1]

    def offset(self, index: int) -> int:
        """Return which character of this text is written at `index` of `raw`, or next behind it."""
        before = sum(begin < index for begin, _ in _written(self.raw))
        solid = [at for at, character in enumerate(self) if not character.isspace()]
        if before >= len(solid):
            return len(self)
        behind = solid[before - 1] + 1 if before else 0
        gap = len(self.raw[:index]) - len(self.raw[:index].rstrip())
        return min(behind + gap, solid[before])

    @classmethod
    def __get_pydantic_core_schema__(cls, source: type[Any], handler: GetCoreSchemaHandler) -> CoreSchema:
        """Pass unchanged through pydantic; anything else is no text."""
        return core_schema.is_instance_schema(cls, cls_repr="text")

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """To an editor it is a string."""
        return {"type": "string"}


# How one character of a text is written, by the style of the text.
_CHARACTER = {
    '"': re.compile(r"\\(?:x..|u....|U........|.)|.", re.DOTALL),
    "'": re.compile(r"''|.", re.DOTALL),
    "": re.compile(r".", re.DOTALL),
}
_ESCAPED_SPACE = frozenset({"\\" + character for character in "\n \tnrtvfNLP_"})


def _written(raw: str) -> list[tuple[int, int]]:
    """Return where each character of a text but white space begins and ends in `raw`. A closing quote comes last."""
    quote = raw[:1] if raw[:1] in ("'", '"') else ""
    is_block = raw[:1] in ("|", ">")
    start = (raw.find("\n") + 1 or len(raw)) if is_block else len(quote)
    found = _CHARACTER[quote].finditer(raw, start)
    return [match.span() for match in found if not _is_space(match[0])]


def _is_space(written: str) -> bool:
    """Return whether a character is white space, as it is or by an escape such as `\\n` or `\\x20`."""
    is_number = len(written) > 2 and written[1] in "xuU"
    return written.isspace() or written in _ESCAPED_SPACE or (is_number and chr(int(written[2:], 16)).isspace())


# Texts of a type of resources, with arguments in the place of parameters.


class Piece(NamedTuple):
    """A part of a text, from `start` to `end`, that stands for what was written from `begin` to `stop`.

    `given` is where an instance gives that.
    """

    start: int
    end: int
    begin: int
    stop: int
    argument: SourceText | None
    given: Place | None = None


class ExpandedText(SourceText):
    """A text of a type in which arguments stand for parameters. It knows where it is written in the type."""

    __slots__ = ("pieces", "template")
    template: SourceText
    pieces: tuple[Piece, ...]

    def __new__(cls, template: SourceText, text: str, pieces: tuple[Piece, ...], place: Place) -> Self:
        """`text` was made of `template`, which stands at `place`."""
        self = super().__new__(cls, text, place, template.raw)
        self.template, self.pieces = template, pieces
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return ExpandedText, (self.template, str(self), self.pieces, self.place)

    def at(self, span: Span) -> Place:
        """The place in the type of a span; where it is an argument, with the place of that."""
        place = self.template.at(self.in_template(span))
        given = (each.given for each in self.pieces if each.start <= span.start < each.end)
        return place._replace(instance=with_given_at(self.place.instance, next(given, None)))

    def written(self, span: Span) -> tuple[int, int]:
        """Return where a span begins and ends in `raw`."""
        return self.template.written(self.in_template(span))

    def argument(self, span: Span) -> SourceText | None:
        """The argument within which a span lies."""
        found = (each.argument for each in self.pieces if each.start <= span.start < each.end and span.end <= each.end)
        return next(found, None)

    def in_template(self, span: Span) -> Span:
        """The span of the template that this span of the text was made of."""
        return Span(self._before(span.start, at_end=False), self._before(span.end, at_end=True))

    def _before(self, index: int, *, at_end: bool) -> int:
        shift = 0
        for piece in self.pieces:
            if index < piece.start or (at_end and index == piece.start):
                break
            if index < piece.end or (at_end and index == piece.end):
                return piece.stop if at_end else piece.begin
            shift = piece.stop - piece.end
        return index + shift


def with_given_at(instance: str, place: Place | None) -> str:
    """An instance by its name, with another place in it, if there is one."""
    return instance if place is None else f"{instance.partition(' ')[0]} ({place})"
