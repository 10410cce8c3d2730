"""What documents of resources have in common, and where they differ in words that a parameter could stand for."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum

from sequence_planner.model.types.expansion import DocumentShape, ParameterUse
from sequence_planner.model.yaml.reader import EntryPath

_IN_NAMES = re.compile(r"\w+|\W")
_IN_CONDITIONS = re.compile(r"'[^']*'|[A-Za-z_]\w*|\d+(?:\.\d+)?|\s+|[^\w\s]+")
_WORD = re.compile(r"\w+")


class GapKind(Enum):
    """Where a gap is: what may stand there, and how."""

    IN_BRACES = "in braces"  # a part of a name or of a text for people
    ENUMERATION = "enumeration"  # a type alone
    VALUE = "value"  # a value alone
    WORD = "word"  # a word of a condition
    RESOURCE = "resource"  # the first part of a name in a condition
    NUMBER = "number"  # a number that is no text


@dataclass(frozen=True)
class Gap:
    """What differs: the word that each of the documents has there. Numbers alone are of the entry `of` one name."""

    words: tuple[str | int | float, ...]
    kind: GapKind
    of: str = ""


Written = tuple[str | Gap, ...]
"""What is written in all documents, with the gaps in it."""


@dataclass(frozen=True)
class Likeness:
    """An entry that all documents have, under a name in each: what is within it, or what is written there where they
    differ. `partial_in` are those that have more in it.
    """

    names: tuple[str | int, ...]
    name: Written = ()
    written: Written = ()
    entries: tuple[Likeness, ...] = ()
    partial_in: frozenset[int] = frozenset()

    def all_within(self, path: EntryPath = (), document: int = 0) -> Iterator[tuple[EntryPath, Likeness]]:
        """All entries in it, each with its path in one of the documents."""
        for each in self.entries:
            here = (*path, each.names[document])
            yield here, each
            yield from each.all_within(here, document)

    @property
    def gaps(self) -> Iterator[Gap]:
        """The gaps in its name, and in what is written."""
        return (each for each in (*self.name, *self.written) if isinstance(each, Gap))


@dataclass(frozen=True)
class DocumentComparison:
    """A comparison of documents, in which only gaps that are allowed count: such that something can stand in them.

    `names` of entries belong together whatever they are.
    """

    may_be: Callable[[Gap], bool]
    names: frozenset[str]

    def of_documents(self, contents: Sequence[object], shape: DocumentShape) -> Likeness | None:
        """What documents have in common; None where that is nothing."""
        return self._of(contents, shape, ("",) * len(contents), (), "")

    def _of(
        self, contents: Sequence[object], shape: DocumentShape, names: tuple[str | int, ...], name: Written, key: str
    ) -> Likeness | None:
        first = contents[0]
        if all(isinstance(each, dict) for each in contents):
            return self._of_mappings([each for each in contents if isinstance(each, dict)], shape, names, name)
        if all(isinstance(each, list) for each in contents):
            return self._of_lists([each for each in contents if isinstance(each, list)], shape, names, name, key)
        if all(isinstance(each, str) for each in contents):
            written = self._of_texts([str(each) for each in contents], shape.text)
            return None if written is None else Likeness(names, name, written)
        if all(type(each) is type(first) and each == first for each in contents):
            return Likeness(names, name)
        numbers = tuple(each for each in contents if isinstance(each, int | float) and not isinstance(each, bool))
        gap = Gap(numbers, GapKind.NUMBER, key)
        if len(numbers) == len(contents) and shape.is_number and self.may_be(gap):
            return Likeness(names, name, (gap,))
        return None

    def _of_mappings(
        self,
        contents: Sequence[dict[object, object]],
        shape: DocumentShape,
        names: tuple[str | int, ...],
        name: Written,
    ) -> Likeness | None:
        entries: list[Likeness] = []
        orders = [list(map(str, each)) for each in contents]
        for keys, written in self._paired(orders, shape.keys):
            values = [each[key] for each, key in zip(contents, keys, strict=True)]
            found = self._of(values, shape.step_into(keys[0]), tuple(keys), written, keys[0])
            if found is not None:
                entries.append(found)
        if not entries and any(contents):
            return None
        if shape.entries is not None:
            entries = _in_one_order(entries, orders)
        more = {index for index, each in enumerate(contents) if len(each) > len(entries)}
        partial_in = more.union(*(each.partial_in for each in entries))
        return Likeness(names, name, entries=tuple(entries), partial_in=frozenset(partial_in))

    def _of_lists(
        self,
        contents: Sequence[list[object]],
        shape: DocumentShape,
        names: tuple[str | int, ...],
        name: Written,
        key: str,
    ) -> Likeness | None:
        """Lists are alike as a whole, or not at all."""
        if len(set(map(len, contents))) > 1:
            return None
        entries: list[Likeness] = []
        for index, values in enumerate(zip(*contents, strict=True)):
            found = self._of(values, shape.step_into(index), (index,) * len(contents), (), key)
            if found is None or found.partial_in:
                return None
            entries.append(found)
        return Likeness(names, name, entries=tuple(entries))

    def _paired(self, keys: Sequence[list[str]], use: ParameterUse) -> Iterator[tuple[list[str], Written]]:
        """The names of entries that belong together: those that are the same, and those that differ in some words."""
        shared = set(keys[0]).intersection(*keys[1:])
        left = [[key for key in each if key not in shared] for each in keys]
        for key in keys[0]:
            if key in shared:
                yield [key, *([key] * (len(keys) - 1))], ()
                continue
            found = [key]
            for others in left[1:]:
                found += [other for other in others if self._belong_together(key, other, use)][:1]
            if len(found) == len(keys) and (written := self._of_texts(found, use)) is not None:
                yield found, written
                for each, one in zip(left, found, strict=True):
                    each.remove(one)

    def _belong_together(self, one: str, other: str, use: ParameterUse) -> bool:
        """Return whether two names have a word in common, and differ in as many places as both have words."""
        first, second = (_WORD.findall(each) for each in (one, other))
        is_alike = _WORD.sub("", one) == _WORD.sub("", other) and len(first) == len(second)
        alike = sum(a == b for a, b in zip(first, second, strict=False))
        return (
            use is ParameterUse.NAMES
            and is_alike
            and (alike > 0 or {one, other} <= {f"/{each}" for each in self.names})
        )

    def _of_texts(self, texts: Sequence[str], use: ParameterUse) -> Written | None:
        """What texts have in common, with gaps; nothing is written where they are the same."""
        if len(set(texts)) == 1:
            return ()
        if use is ParameterUse.EXPRESSION:
            return self._of_conditions(texts)
        if use is not ParameterUse.NAMES and all(map(_WORD.fullmatch, texts)):
            kind = GapKind.ENUMERATION if use is ParameterUse.TYPE else GapKind.VALUE
            return self._with_gaps([[each] for each in texts], lambda _: kind)
        return self._with_gaps([_IN_NAMES.findall(each) for each in texts], lambda _: GapKind.IN_BRACES)

    def _of_conditions(self, texts: Sequence[str]) -> Written | None:
        """The same of conditions; in how they are spaced the first one counts."""
        parts = [_IN_CONDITIONS.findall(each) for each in texts]
        solid = [[part for part in each if not part.isspace()] for each in parts]

        def _kind_at(index: int) -> GapKind | None:
            before, behind = (solid[0][at] if 0 <= at < len(solid[0]) else "" for at in (index - 1, index + 1))
            if before.endswith(".") or behind[:1] in ("(", "["):
                return None
            return GapKind.RESOURCE if behind.startswith(".") else GapKind.WORD

        written = self._with_gaps(solid, _kind_at)
        if written is None:
            return None
        rest = iter(written)
        return tuple(part if part.isspace() else next(rest) for part in parts[0])

    def _with_gaps(self, parts: Sequence[list[str]], kind_at: Callable[[int], GapKind | None]) -> Written | None:
        if len(set(map(len, parts))) > 1:
            return None
        written: list[str | Gap] = []
        for index, words in enumerate(zip(*parts, strict=True)):
            if len(set(words)) == 1:
                written.append(words[0])
                continue
            kind = kind_at(index)
            if kind is None or not all(map(_WORD.fullmatch, words)) or not self.may_be(gap := Gap(words, kind)):
                return None
            written.append(gap)
        return tuple(written)


def _in_one_order(entries: Sequence[Likeness], orders: Sequence[list[str]]) -> list[Likeness]:
    """The entries that stand in the same order everywhere; of those that do not, as much as can be."""
    best: list[tuple[int, list[Likeness]]] = []
    for each in entries:
        before = [found for found in best if _stands_above(found[1][-1], each, orders)]
        size, chain = max(before, key=lambda found: found[0], default=(0, []))
        best.append((size + 1 + sum(1 for _ in each.all_within()), [*chain, each]))
    return max(best, key=lambda found: found[0])[1] if best else []


def _stands_above(one: Likeness, other: Likeness, orders: Sequence[list[str]]) -> bool:
    names = zip(orders, one.names, other.names, strict=True)
    return all(order.index(str(first)) < order.index(str(second)) for order, first, second in names)
