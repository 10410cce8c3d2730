"""Which parts a dotted name names: what `Scope` looks up in a sound model, in one that may be broken elsewhere."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from sequence_planner.automaton.grounding.declarations import FLAGS
from sequence_planner.expressions.syntax import NOWHERE, Name, Span
from sequence_planner.model.source import SourceText
from sequence_planner.workshop.references.declared import Declared, Parameters, is_activity
from sequence_planner.workshop.references.occurrences import Gathered, Surroundings, Where
from sequence_planner.workshop.references.parts import Part, value_of, variable_of

_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


class Word(NamedTuple):
    """A word of a name, and where it stands in the text."""

    text: str
    span: Span


class Step(NamedTuple):
    """One part of a dotted name, with its arguments."""

    word: Word
    arguments: tuple[Word, ...] = ()


class Named(NamedTuple):
    """What a name names: its parts by the step that does, the parameters that the arguments of a step are for, and the
    enumeration over which it ranges.
    """

    parts: Mapping[int, Part]
    arguments: tuple[int, Parameters] | None = None
    enumeration: str | None = None


def steps_of(name: Name, text: str) -> tuple[Step, ...]:
    """The steps of a name that was read from `text`."""
    start = name.span.start
    if name.is_word:
        return (Step(Word(name.path[0].name, name.span)),)
    words = (
        Word(match[0], Span(start + match.start(), start + match.end()))
        for match in _WORD.finditer(text[start : name.span.end])
    )
    return tuple(Step(next(words), tuple(next(words) for _ in part.arguments)) for part in name.path)


def _without_places(name: Name) -> tuple[Step, ...]:
    return tuple(
        Step(Word(part.name, NOWHERE), tuple(Word(each, NOWHERE) for each in part.arguments)) for part in name.path
    )


class Naming:
    """Names in the light of what is declared; what they name is noted in `gathered`."""

    def __init__(self, declared: Declared, gathered: Gathered) -> None:
        self.declared = declared
        self.gathered = gathered
        self._found: dict[tuple[str, str, str | None, bool], Named | None] = {}

    def find(self, name: Name, around: Surroundings) -> Named | None:
        """What a name names; nothing where no such name is declared."""
        key = (str(name), around.holder, around.resource, around.has_flags)
        if key not in self._found:
            self._found[key] = self._find(_without_places(name), around)
        return self._found[key]

    def _find(self, steps: tuple[Step, ...], around: Surroundings) -> Named | None:
        word = steps[0].word.text
        is_word = len(steps) == 1 and not steps[0].arguments
        if is_word and word in around.parameters:
            enumeration = around.parameters[word]
            return Named({0: Part("parameter", around.holder, word)}, None, enumeration)
        if is_word and around.has_flags and word in FLAGS:
            return Named({})
        candidates = list(self._candidates(steps, around.resource))
        fitting = (each for each in candidates if self._fits(each, steps))
        return next(fitting, candidates[0] if candidates else None)

    def implied(self, steps: tuple[Step, ...], around: Surroundings) -> Named | None:
        """What a name that is declared nowhere would name."""
        names = [step.word.text for step in steps]
        if len(names) > 1 and names[0] in self.declared.resources:
            resource = Part("resource", None, names[0])
            is_flag = names[-1] in FLAGS
            return Named({0: resource, 1: Part("ability" if is_flag else "variable", names[0], names[1])})
        if is_activity(names):
            return Named({1: Part("operation", None, names[1])})
        if around.resource is not None and len(names) == 1:
            return Named({0: variable_of(around.resource, names[0])})
        if around.resource is not None and len(names) == 2 and names[1] in FLAGS:
            return Named({0: Part("ability", around.resource, names[0])})
        return None

    def note(
        self, named: Named, steps: tuple[Step, ...], where: Where, text: SourceText, *, writes: bool = False
    ) -> None:
        """Note that a name at some place names these parts, or with `writes` gives the last of them a value."""
        whole = Span(steps[0].word.span.start, (steps[-1].arguments or (steps[-1].word,))[-1].span.end)
        for index, part in named.parts.items():
            is_written = writes and index == max(named.parts)
            self.gathered.add(part, where, text, steps[index].word.span, whole=whole, writes=is_written)
        if named.arguments is not None:
            index, parameters = named.arguments
            self.note_arguments(steps[index].arguments, parameters, where, text, whole)

    def note_arguments(
        self, words: tuple[Word, ...], parameters: Parameters, where: Where, text: SourceText, whole: Span | None = None
    ) -> None:
        """Note what the arguments of a name are: parameters around it, or values."""
        around = where.around
        for word, enumeration in zip(words, parameters.values(), strict=False):
            if word.text in around.parameters:
                self.gathered.add(Part("parameter", around.holder, word.text), where, text, word.span, whole=whole)
                self.link(around.parameters[word.text], enumeration)
            elif word.text in self.declared.enumerations.get(enumeration, ()):
                self.gathered.add(value_of(enumeration, word.text), where, text, word.span, whole=whole)

    def note_value(self, enumeration: str | None, where: Where, text: object) -> None:
        """Note that a whole text is a value of an enumeration, if it is."""
        if enumeration is not None and isinstance(text, SourceText) and self.has(enumeration, text):
            self.gathered.add(value_of(enumeration, str(text)), where, text)

    def has(self, enumeration: str, value: str) -> bool:
        """Whether an enumeration has a value."""
        return value in self.declared.enumerations.get(enumeration, ())

    def tie_values(self, enumeration: str | None, why: str) -> None:
        """Note that the names of an enumeration's values are not the model's alone."""
        for value in self.declared.enumerations.get(enumeration or "", ()):
            self.gathered.tie(value_of(enumeration or "", value), why)

    def link(self, one: str | None, other: str | None) -> None:
        """Note that values of two enumerations are compared, or become one another."""
        if one is None or other is None or one == other:
            return
        values = set(self.declared.enumerations.get(one, ())) & set(self.declared.enumerations.get(other, ()))
        self.gathered.links |= {frozenset({value_of(one, each), value_of(other, each)}) for each in values}

    def _candidates(self, steps: tuple[Step, ...], resource: str | None) -> Iterator[Named]:
        names = [step.word.text for step in steps]
        if resource is not None:
            yield from self._own(resource, steps, 0)
        if len(names) == 1 and names[0] in self.declared.variables:
            yield self._variable(None, names[0], 0)
        elif is_activity(names) and names[1] in self.declared.operations:
            yield Named({1: Part("operation", None, names[1])}, (1, self.declared.operations[names[1]]))
        elif names[0] in self.declared.resources:
            for own in self._own(names[0], steps, 1):
                yield own._replace(parts={0: Part("resource", None, names[0]), **own.parts})

    def _own(self, resource: str, steps: tuple[Step, ...], first: int) -> Iterator[Named]:
        """What the steps from `first` on name in a resource."""
        if first >= len(steps):
            return
        name, rest = steps[first].word.text, steps[first + 1 :]
        full = f"{resource}.{name}"
        if not rest and full in self.declared.variables:
            yield self._variable(resource, name, first)
        elif len(rest) == 1 and rest[0].word.text in FLAGS and full in self.declared.abilities:
            yield Named({first: Part("ability", resource, name)}, (first, self.declared.abilities[full]))

    def _variable(self, resource: str | None, name: str, index: int) -> Named:
        part = variable_of(resource, name)
        parameters = self.declared.variables[part.full].parameters
        return Named({index: part}, (index, parameters), self.declared.enumeration(resource, name))

    def _fits(self, named: Named, steps: tuple[Step, ...]) -> bool:
        """Whether there are arguments where there must be some, and nowhere else."""
        at, parameters = named.arguments or (-1, {})
        wanted = [len(parameters) if index == at else 0 for index in range(len(steps))]
        return wanted == [len(step.arguments) for step in steps]
