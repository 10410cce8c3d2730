"""The parameters that stand where documents of resources differ."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.editor.folds.texts import FoldableStation
from sequence_planner.editor.folds.types.likeness import Gap, GapKind, Likeness, Written
from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.model.fields import FLAGS
from sequence_planner.model.types.expansion import resource_shape
from sequence_planner.model.yaml.reader import EntryPath

Words = tuple[str | int | float, ...]
_Meaning = tuple[str, Words, str]  # kind, words, and the name of the entries that numbers alone stand at
_NUMBER = re.compile(r"0|[1-9]\d{0,8}")
_PART = re.compile(r"[A-Za-z]+")
_FEWEST_USES = 2  # of a parameter that stands for a word in texts for people


@dataclass(frozen=True)
class FoundParameter:
    """A parameter of a type, and what it is for each of the resources; `of` is that of a value. One that stands for
    numbers alone stands at entries of one name.
    """

    name: str
    kind: str
    words: Words
    of: str | None = None
    entry: str = ""

    @property
    def declared_as(self) -> object:
        """How a type declares it."""
        return self.kind if self.of is None else {"kind": self.kind, "of": self.of}


class GapKinds:
    """The kinds of parameters that could stand in gaps, by what the names of a station mean."""

    def __init__(self, station: FoldableStation, resources: Iterable[str]) -> None:
        self._station = station
        self._resources = frozenset(resources)

    def of_gap(self, gap: Gap) -> str | None:
        """Return of which kind a parameter in a gap would be; None where none can stand there."""
        words = list(map(str, gap.words))
        match gap.kind:
            case GapKind.NUMBER:
                return "number"
            case GapKind.RESOURCE:
                return "resource" if self._resources.issuperset(words) else None
            case GapKind.ENUMERATION:
                return self._named(words)
            case GapKind.WORD:
                return self._numbers(words) or self._named(words) or self._value(words)
            case GapKind.VALUE:
                return self._numbers(words) or self._value(words) or "text"
            case GapKind.IN_BRACES:
                return self._numbers(words) or "text"

    def smallest_with(self, words: Words) -> str | None:
        """The smallest enumeration that has all of these values."""
        return self._station.smallest_with(map(str, words))

    def have(self, enumerations: Words, words: Words) -> bool:
        """Return whether each word is a value of the enumeration beside it."""
        domains = self._station.domains
        return all(str(word) in domains[str(name)].values for name, word in zip(enumerations, words, strict=True))

    def _numbers(self, words: list[str]) -> str | None:
        return "number" if all(map(_NUMBER.fullmatch, words)) else None

    def _named(self, words: list[str]) -> str | None:
        return "enumeration" if self._station.domains.keys() >= set(words) else None

    def _value(self, words: list[str]) -> str | None:
        return "value" if self._station.every_value.issuperset(words) else None


class Parameters:
    """The parameters of a type for all gaps that its documents have."""

    def __init__(self, likeness: Likeness, kinds: GapKinds, taken: Iterable[str]) -> None:
        self._kinds = kinds
        self._taken = {*taken, *FLAGS, *KEYWORDS}
        self._uses: dict[_Meaning, list[tuple[EntryPath, Gap]]] = defaultdict(list)
        in_braces: list[tuple[EntryPath, Gap]] = []
        for path, each in likeness.all_within():
            if _is_free(path):
                self._taken.add(str(path[-1]))
            for gap in each.gaps:
                if gap.kind is GapKind.IN_BRACES:
                    in_braces.append((path, gap))
                elif (kind := kinds.of_gap(gap)) is not None:
                    self._uses[_meaning(kind, gap)].append((path, gap))
        for path, gap in in_braces:
            known = next((each for each in self._uses if tuple(map(str, each[1])) == gap.words), None)
            if known is None:
                kind = kinds.of_gap(gap)
                assert kind is not None, "a text can always stand in braces"
                known = _meaning(kind, gap)
            self._uses[known].append((path, gap))
        self._found = {(each.kind, each.words, each.entry): each for each in self._all()}

    @property
    def all(self) -> list[FoundParameter]:
        """All of them, each behind those that it is declared with."""
        return list(self._found.values())

    def needless(self) -> Iterator[Gap]:
        """The gaps that are better left to each instance: what differs in one place alone, and what cannot be."""
        for meaning, uses in self._uses.items():
            if meaning not in self._found:
                yield from (gap for _, gap in uses)
                continue
            is_text = all(gap.kind is GapKind.IN_BRACES for _, gap in uses)
            (path, gap) = uses[0]
            is_in_list = any(isinstance(step, int) for step in path)
            if len(uses) < _FEWEST_USES and not is_in_list and (is_text or len(path) == 1):
                yield gap

    def written(self, text: Written) -> str:
        """What is written in the type."""
        return "".join(each if isinstance(each, str) else self._in_gap(each) for each in text)

    def _in_gap(self, gap: Gap) -> str:
        if gap.kind is not GapKind.IN_BRACES:
            kind = self._kinds.of_gap(gap)
            assert kind is not None, "a gap is looked at before it is left"
            return self._found[_meaning(kind, gap)].name
        return next(f"{{{each.name}}}" for each in self.all if tuple(map(str, each.words)) == gap.words)

    def _all(self) -> Iterator[FoundParameter]:
        """Enumerations first: values may be theirs."""
        enumerations: list[FoundParameter] = []
        for (kind, words, _), uses in self._uses.items():
            if kind == "enumeration":
                enumerations.append(FoundParameter(self._name(kind, words, uses), kind, words))
        yield from enumerations
        for (kind, words, entry), uses in self._uses.items():
            if kind == "value":
                own = (each.name for each in enumerations if self._kinds.have(each.words, words))
                of = next(own, None) or self._kinds.smallest_with(words)
                if of is not None:
                    yield FoundParameter(self._name(kind, words, uses, of), kind, words, of)
            elif kind != "enumeration":
                yield FoundParameter(self._name(kind, words, uses), kind, words, entry=entry)

    def _name(self, kind: str, words: Words, uses: list[tuple[EntryPath, Gap]], of: str = "") -> str:
        """A name that says what a parameter is for, and that nothing else has."""
        path = [step for step in uses[0][0] if isinstance(step, str)]
        own = path[-1:] if len({each for each, _ in uses}) > 1 else path[-2:]
        common = _common_words(map(str, words))
        match kind:
            case "enumeration":
                wanted = f"{common or 'value'}s"
            case "value":
                wanted = f"own_{common or of.removesuffix('s')}"
            case "resource":
                wanted = f"other_{common}" if common else "other"
            case "number":
                wanted = "_".join(own) if all(re.fullmatch(r"\w+", step) for step in own) else "number"
            case _:
                in_topics = any(each[0] in ("topics", "services", "actions") for each, _ in uses)
                wanted = "namespace" if in_topics else common or "word"
        name, number = wanted, 1
        while name in self._taken:
            number += 1
            name = f"{wanted}_{number}"
        self._taken.add(name)
        return name


def _is_free(path: EntryPath) -> bool:
    """Return whether the name of an entry is one that somebody has given it."""
    shape = resource_shape()
    for step in path[:-1]:
        shape = shape.step_into(step)
    return shape.entries is not None


def _meaning(kind: str, gap: Gap) -> _Meaning:
    """What a parameter in a gap is for: its words are as an instance gives them."""
    is_number = kind == "number"
    return kind, tuple(int(each) if is_number and isinstance(each, str) else each for each in gap.words), gap.of


def _common_words(texts: Iterable[str]) -> str:
    """The words that all names have, in small letters."""
    split = [list(map(str.lower, _PART.findall(text))) for text in texts]
    common = Counter(split[0])
    for each in split[1:]:
        common &= Counter(each)
    return "_".join(word for word in dict.fromkeys(split[0]) if common[word])


def common_name(names: Iterable[str]) -> str:
    """A name for what has these: the words that all of them have."""
    return _common_words(names)


def arguments_of(parameters: Iterable[FoundParameter], document: int) -> Mapping[str, str | int | float]:
    """Return what the parameters are for one of the resources."""
    return {each.name: each.words[document] for each in parameters}
