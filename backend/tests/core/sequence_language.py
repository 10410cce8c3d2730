"""Sequences as languages: the orders in which their operations can be completed, and random ones of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from .choices import Choices

Word = tuple[str, ...]
KINDS = ("sequence", "parallel", "alternative", "arbitrary")


@dataclass(frozen=True)
class Sop:
    """An operation, or several sequences of operations in an order."""

    kind: str
    name: str = ""
    parts: tuple[Sop, ...] = ()

    def __str__(self) -> str:
        """As YAML in flow style."""
        return self.name if not self.parts else f"{{{self.kind}: [{', '.join(map(str, self.parts))}]}}"

    def names(self) -> Iterator[str]:
        if not self.parts:
            yield self.name
        for part in self.parts:
            yield from part.names()


def sop(choices: Choices, most: int) -> Sop:
    """At least three operations, at most so many, and each once. No part is of the same kind as what it is in."""
    names = [f"o{number}" for number in range(choices.number(3, most))]
    return _over(choices, names, KINDS)


def _over(choices: Choices, names: list[str], kinds: Sequence[str]) -> Sop:
    if len(names) == 1:
        return Sop("operation", names[0])
    cuts = choices.different(range(1, len(names)), 1, 2)
    pieces = [names[start:end] for start, end in pairwise((0, *sorted(cuts), len(names)))]
    kind = choices.pick(kinds)
    others = [each for each in KINDS if each != kind]
    return Sop(kind, parts=tuple(_over(choices, piece, others) for piece in pieces))


def words(term: Sop) -> frozenset[Word]:
    """All orders in which a whole sequence can be completed."""
    if not term.parts:
        return frozenset({(term.name,)})
    languages = [words(part) for part in term.parts]
    if term.kind == "alternative":
        return frozenset().union(*languages)
    if term.kind == "sequence":
        return _in_order(languages)
    if term.kind == "parallel":
        found = languages[0]
        for language in languages[1:]:
            found = frozenset(word for one in found for other in language for word in _shuffled(one, other))
        return found
    return frozenset(word for order in _orders(languages) for word in _in_order(order))


def _in_order(languages: list[frozenset[Word]]) -> frozenset[Word]:
    found: frozenset[Word] = frozenset({()})
    for language in languages:
        found = frozenset(one + other for one in found for other in language)
    return found


def _orders(languages: list[frozenset[Word]]) -> Iterator[list[frozenset[Word]]]:
    if not languages:
        yield []
    for index, language in enumerate(languages):
        for rest in _orders(languages[:index] + languages[index + 1 :]):
            yield [language, *rest]


def _shuffled(one: Word, other: Word) -> Iterator[Word]:
    if not one or not other:
        yield one + other
        return
    for rest in _shuffled(one[1:], other):
        yield (one[0], *rest)
    for rest in _shuffled(one, other[1:]):
        yield (other[0], *rest)


def beginnings(language: frozenset[Word]) -> frozenset[Word]:
    """All words with which some word of a language begins."""
    return frozenset(word[:length] for word in language for length in range(len(word) + 1))
