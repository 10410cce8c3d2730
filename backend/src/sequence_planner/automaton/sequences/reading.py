"""Sequences as they are written: `for` written out, and other sequences in their places."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise

from sequence_planner.automaton.declarations import OPERATION, Declarations
from sequence_planner.automaton.findings import Binding, Findings, with_arguments, without_arguments
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.parser import parse
from sequence_planner.language.syntax import ExpressionError, Name
from sequence_planner.language.types import Place
from sequence_planner.model.loader import Station
from sequence_planner.model.sequences import SequenceKind, SequencePart
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message


@dataclass(frozen=True)
class SequenceTerm:
    """An operation, where it has no `kind`, or several terms in such an order. `text` is where it was written first."""

    text: SourceText
    name: str = ""
    kind: SequenceKind | None = None
    parts: tuple[SequenceTerm, ...] = ()

    def operations(self) -> Iterator[SequenceTerm]:
        """All operations in it, in the order in which they are written."""
        if self.kind is None:
            yield self
        for part in self.parts:
            yield from part.operations()

    @property
    def begins(self) -> tuple[SequenceTerm, ...]:
        """The operations with which it begins."""
        if self.kind is None:
            return (self,)
        parts = self.parts[:1] if self.kind == "sequence" else self.parts
        return tuple(each for part in parts for each in part.begins)

    @property
    def ends(self) -> tuple[str, ...]:
        """The operations with which it ends."""
        if self.kind is None:
            return (self.name,)
        parts = self.parts[-1:] if self.kind == "sequence" else self.parts
        return tuple(each for part in parts for each in part.ends)


def terms_within(term: SequenceTerm) -> Iterator[SequenceTerm]:
    """A term and all those that it consists of."""
    yield term
    for part in term.parts:
        yield from terms_within(part)


def orders_within(term: SequenceTerm) -> Iterator[tuple[SequenceTerm, SequenceTerm]]:
    """Each term that stands behind another in a sequence, with that."""
    for part in terms_within(term):
        if part.kind == "sequence":
            yield from ((after, before) for before, after in pairwise(part.parts))


class SequenceReader:
    """Reads sequences over the ground `operations` of a station and over each other; what is wrong is noted."""

    def __init__(
        self, declarations: Declarations, findings: Findings, station: Station, operations: Collection[str]
    ) -> None:
        self._declarations = declarations
        self.findings = findings
        self.station = station
        self._operations = operations
        self.used: set[str] = set()  # sequences that stand in others
        self.terms: dict[str, SequenceTerm] = {}  # of all sequences, by name, once they are read

    def term_of(self, part: SequencePart, *names: str) -> SequenceTerm | None:
        """What a part means, within the sequences `names`; None where it means nothing."""
        self._check_parameters(part)
        term = self._part(part, {}, names)
        seen: dict[str, SourceText] = {}
        for each in () if term is None else term.operations():
            if each.name in seen:
                line = seen[each.name].place.line
                self.findings.add(each.text, message("wrong.in-sequence-already", name=each.name, line=line))
                term = None
            seen.setdefault(each.name, each.text)
        return term

    def branch(self, text: SourceText, binding: Binding, names: tuple[str, ...]) -> SequenceTerm | None:
        """The operation or the sequence that `text` names."""
        scope = NameScope(self._declarations.types, (), binding)
        try:
            written = parse(text)
            if not isinstance(written, Name) or len(written.path) != 1:
                raise ExpressionError(message("wrong.expected-operation"), written.span)
        except ExpressionError as error:
            self.findings.add_within(text, error.span, error.message)
            return None
        name = str(scope.substitute(written))
        if name in self._operations:
            return SequenceTerm(text, name)
        if (known := self.station.sequences.get(SourceText(name, text.place, name))) is not None:
            self.used.add(name)
            if name in names:
                circle = " → ".join((*names[names.index(name) :], name))
                self.findings.add(text, message("wrong.sequences-in-circle", names=circle))
                return None
            return self._part(known, {}, (*names, name))
        if f"{OPERATION}.{without_arguments(name)}" not in self._declarations.broken:
            self.findings.add(text, self._unknown(name))
        return None

    def _part(self, part: SequencePart, binding: Binding, names: tuple[str, ...]) -> SequenceTerm | None:
        parts: list[SequenceTerm] = []
        for inner in self._declarations.bindings(part.each):
            own = {**binding, **inner}
            for branch in part.branches:
                if isinstance(branch, SequencePart):
                    found = self._part(branch, own, names)
                else:
                    found = self.branch(branch, own, names)
                if found is not None:
                    parts.append(found)
        return SequenceTerm(parts[0].text, kind=part.kind, parts=tuple(parts)) if parts else None

    def _check_parameters(self, part: SequencePart) -> None:
        """Note what is wrong with what `for` says, once for all values."""
        self._declarations.noting(self.findings).check_parameters(part.each)
        for branch in part.branches:
            if isinstance(branch, SequencePart):
                self._check_parameters(branch)

    def _unknown(self, name: str) -> str:
        bare = without_arguments(name)
        written = self.station.operations.get(SourceText(bare, Place("", 1, 1), bare))
        if written is None or (written.parameters and bare != name):
            known = [*self._operations, *map(str, self.station.sequences)]
            return f"there is no operation `{name}`{suggestion(name, known)}"
        if not written.parameters:
            return f"`{bare}` has no parameters: write `{bare}`"
        one = next(each for each in self._operations if without_arguments(each) == name)
        over = ", ".join(f"{parameter}: {enumeration}" for parameter, enumeration in written.parameters.items())
        all_of_them = f"{{for: {{{over}}}, parallel: {with_arguments(name, map(str, written.parameters))}}}"
        return f"`{name}` has parameters: write one, such as `{one}`, or all of them, such as `{all_of_them}`"


def read_sequences(reader: SequenceReader) -> dict[str, SequenceTerm]:
    """The sequences that stand in no other, by name; orders that contradict each other are noted."""
    found = {str(name): reader.term_of(document, str(name)) for name, document in reader.station.sequences.items()}
    reader.terms = {name: term for name, term in found.items() if term is not None}
    terms = {name: term for name, term in reader.terms.items() if name not in reader.used}
    before: dict[str, dict[str, tuple[str, SourceText]]] = {}
    for name, term in terms.items():
        for after, earlier in orders_within(term):
            for each in after.begins:
                before.setdefault(each.name, {}).update((end, (name, each.text)) for end in earlier.ends)
    try:
        TopologicalSorter(before).prepare()
    except CycleError as error:
        circle = error.args[1]
        said = [before[later][earlier] for earlier, later in pairwise(circle)]
        names = [f"`{each}`" for each in dict.fromkeys(name for name, _ in said)]
        wrong = message("wrong.order-in-circle", names=" → ".join(circle), sequences=", ".join(names))
        reader.findings.add(said[-1][1], wrong)
    return terms
