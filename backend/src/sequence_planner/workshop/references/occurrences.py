"""Places at which parts of a model are named, as they are gathered from its files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from sequence_planner.expressions.syntax import Span
from sequence_planner.model.paths import shown_path
from sequence_planner.model.reading import EntryPath
from sequence_planner.model.source import SourceText
from sequence_planner.workshop.references.parts import Part


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What names mean around a text: its resource, and the parameters of what it stands in, with their enumerations.

    `holder` is the owner of these parameters; `has_flags` holds within an ability.
    """

    resource: str | None = None
    holder: str = ""
    parameters: Mapping[str, str] = field(default_factory=dict)
    has_flags: bool = False


@dataclass(frozen=True, slots=True)
class Where:
    """An entry of a file, and whom it is a part of: `owner`, which stands at the first `depth` steps of its path."""

    file: str
    path: EntryPath
    owner: str
    depth: int
    around: Surroundings = Surroundings()

    def to(self, *steps: str | int) -> Where:
        """An entry within this one."""
        return Where(self.file, self.path + tuple(map(_plain, steps)), self.owner, self.depth, self.around)

    def within(self, owner: str, around: Surroundings | None = None) -> Where:
        """This entry as a part of its own, with names of its own."""
        return Where(self.file, self.path, owner, len(self.path), self.around if around is None else around)

    @property
    def said(self) -> str:
        """In words a person knows, such as `ability robot.move: start.when`."""
        inner = shown_path(self.path[self.depth :])
        return f"{self.owner}: {inner}" if inner else self.owner


def _plain(step: str | int) -> str | int:
    return str(step) if isinstance(step, str) else step


@dataclass(frozen=True, slots=True)
class Occurrence:
    """A part named at `span` of a text, within the name at `whole`. `fixed` says why it cannot be written otherwise,
    and `writes` holds where a variable is given a value.

    The text of the declaration of a resource or of a type of message is the name of its file, so there is none.
    """

    part: Part
    where: Where
    text: SourceText | None
    span: Span
    whole: Span
    declares: bool = False
    fixed: str | None = None
    writes: bool = False


class Unwritten(NamedTuple):
    """A variable that an entry gives a value, or else reads, though no text there names it; `why` says how that is."""

    part: Part
    where: Where
    writes: bool
    why: str


class Binding(NamedTuple):
    """A pipeline at whose end a variable is a field of a message, because both have the name `field`; `why` says so."""

    file: str
    path: tuple[str, ...]
    incoming: bool
    field: str
    why: str


@dataclass
class Gathered:
    """All that was found.

    `links` are pairs of values that are one because variables of their enumerations are compared. `ties` are parts
    whose names are not the model's alone, each with why; `bindings` are variables for which a stage could say what
    their names do. `hidden` are pairs of parts of which one stands in the way of the other. `unwritten` are uses
    without a text that names what is used. `unread` are texts that make no sense, so that names in them may be missed.
    """

    occurrences: list[Occurrence] = field(default_factory=list)
    links: set[frozenset[Part]] = field(default_factory=set)
    ties: dict[Part, str] = field(default_factory=dict)
    bindings: dict[Part, list[Binding]] = field(default_factory=dict)
    hidden: set[tuple[Part, Part]] = field(default_factory=set)
    unwritten: list[Unwritten] = field(default_factory=list)
    unread: list[tuple[Where, SourceText]] = field(default_factory=list)

    def add(
        self,
        part: Part,
        where: Where,
        text: SourceText,
        span: Span | None = None,
        *,
        whole: Span | None = None,
        declares: bool = False,
        fixed: str | None = None,
        writes: bool = False,
    ) -> None:
        """Note that `text` names a part at `span`, or as a whole."""
        span = Span(0, len(text)) if span is None else span
        self.occurrences.append(Occurrence(part, where, text, span, whole or span, declares, fixed, writes))

    def tie(self, part: Part, why: str) -> None:
        """Note that the name of a part is not the model's alone."""
        self.ties.setdefault(part, why)
