"""What is said of the instances of a declaration, once for all of which the same is said."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import prod
from typing import NamedTuple

from sequence_planner.automaton.findings import with_arguments
from sequence_planner.automaton.lifting.normal_form import normal_form
from sequence_planner.automaton.lifting.wording import ModelWording, abstracted
from sequence_planner.language.parser import parse
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import Expression
from sequence_planner.language.types import EnumerationType

_MOST_SHOWN = 3  # instances of which one is told with a word in place of its value: that may stand for itself in it
_INSTANCE = re.compile(r"([^(\[]*)([(\[])([^)\]]*)[)\]](.*)", re.DOTALL)


class GroundStatement(NamedTuple):
    """Ground conditions, and names of specifications, that are said of a part of the model. What is said in another
    `way` is not told together.
    """

    conditions: tuple[Expression, ...]
    names: tuple[str, ...] = ()
    way: object = None


class FoldedStatement(NamedTuple):
    """A statement in the words of the model, about all `members`: where there are several, those that are named by
    what it is `over`, as in `all pair in bolt_pair`.
    """

    name: str
    over: str | None
    members: tuple[str, ...]
    conditions: tuple[str, ...]
    names: tuple[str, ...]

    @property
    def title(self) -> str:
        """What it is about."""
        return self.name if self.over is None else f"{self.name}, for {self.over}"


class _Instance(NamedTuple):
    name: str
    family: str
    brackets: str
    arguments: tuple[str, ...]
    rest: str


class IndexFolding:
    """Folds statements over the indices of `wording`; `prefix` is before names where indices are known by it."""

    def __init__(self, wording: ModelWording, prefix: str = "") -> None:
        self._wording = wording
        self._prefix = prefix

    def folded(self, statements: Mapping[str, GroundStatement]) -> Iterator[FoldedStatement]:
        """The statements, where the first of those stood that are told together.

        They are the same once a word is in the place of a value: each is proven to be what the text with that word
        means for its values.
        """
        left = dict(statements)
        for name in statements:
            if name in left:
                found = self._together(name, left) or self._alone(name, left[name])
                for member in found.members:
                    del left[member]
                yield found

    def folded_texts(
        self, texts: Mapping[str, tuple[str, ...]], ways: Mapping[str, object]
    ) -> Iterator[FoldedStatement]:
        """Texts about instances, where the first of those stood that are the same but for the values of indices. What
        is said in another of the `ways` is not told together.
        """
        together: dict[str, list[str]] = {}
        for name in texts:
            instance = self._instance(name)
            told = None if instance is None else self._worded(instance, texts[name])
            key = name if instance is None or told is None else repr((instance[1:3], instance.rest, told, ways[name]))
            together.setdefault(key, []).append(name)
        for members in together.values():
            first = self._instance(members[0])
            over = None
            if first is not None and len(members) > 1:
                instances = [each for name in members if (each := self._instance(name)) is not None]
                over = self._index(first.family, [each.arguments for each in instances])
            if first is None or over is None:
                yield from (FoldedStatement(name, None, (name,), texts[name], ()) for name in members)
            else:
                told = self._worded(first, texts[first.name]) or ()
                yield FoldedStatement(self._title(first), over, tuple(members), told, ())

    def _worded(self, instance: _Instance, texts: Sequence[str]) -> tuple[str, ...] | None:
        """Texts with words in the place of values; None where these would be mistaken for others."""
        words = dict(zip(instance.arguments, self._parameters(instance.family), strict=True))
        pattern = re.compile(rf"\b({'|'.join(map(re.escape, (*words, *words.values())))})\b")
        if any(found in words.values() for text in texts for found in pattern.findall(text)):
            return None
        return tuple(pattern.sub(lambda found: words[found[1]], text) for text in texts)

    def _title(self, instance: _Instance) -> str:
        words = self._parameters(instance.family)
        return with_arguments(instance.family, words, instance.brackets == "[") + instance.rest

    def folded_names(self, names: Iterable[str]) -> list[str]:
        """Names, those of all instances over an index as one."""
        instances = {name: GroundStatement(()) for name in names}
        return [each.name if each.over is None else f"{each.name} for {each.over}" for each in self.folded(instances)]

    def _alone(self, name: str, statement: GroundStatement) -> FoldedStatement:
        said = tuple(map(self._wording.in_words, statement.conditions))
        return FoldedStatement(name, None, (name,), said, tuple(specifications_folded(self._wording, statement.names)))

    def _instance(self, name: str) -> _Instance | None:
        found = _INSTANCE.fullmatch(name)
        if found is None or len(self._parameters(found[1])) != len(arguments := tuple(found[3].split(", "))):
            return None
        return _Instance(name, found[1], found[2], arguments, found[4])

    def _parameters(self, family: str) -> Mapping[str, EnumerationType]:
        domains = self._wording.scope.vocabulary.domains
        indices = self._wording.indices.get(self._prefix + family, {})
        return {word: domains[domain] for word, domain in indices.items() if domain in domains}

    def _together(self, name: str, left: Mapping[str, GroundStatement]) -> FoldedStatement | None:
        """What is said of this instance and others; None where it is of it alone."""
        first = self._instance(name)
        if first is None:
            return None
        alike = [
            each
            for other in left
            if (each := self._instance(other)) is not None
            and (each.family, each.rest) == (first.family, first.rest)
            and left[other].way == left[name].way
            and len(left[other].conditions) == len(left[name].conditions)
        ]
        told_apart = sorted(alike, key=lambda each: len(set(each.arguments)) < len(each.arguments))
        for shown in told_apart[:_MOST_SHOWN]:
            members, conditions, names = self._like(shown, alike, left)
            if first in members and len(members) > 1:
                break
        else:
            return None
        index = self._index(first.family, [each.arguments for each in members])
        if index is None:
            return None
        told = tuple(specifications_folded(self._wording, names))
        return FoldedStatement(self._title(first), index, tuple(each.name for each in members), conditions, told)

    def _like(
        self, shown: _Instance, alike: Sequence[_Instance], statements: Mapping[str, GroundStatement]
    ) -> tuple[list[_Instance], tuple[str, ...], tuple[str, ...]]:
        """The instances of which the same is said as of the one that is shown, and what that is."""
        lifted = [self._wording.lifted(each) for each in statements[shown.name].conditions]
        names = statements[shown.name].names
        for word, value in zip(self._parameters(shown.family), shown.arguments, strict=True):
            words = {value: word}
            lifted = [abstracted(each, value, word) for each in lifted]
            names = tuple(_with(each, words) for each in names)
        texts = tuple(map(print_expression, lifted))
        read = tuple(map(parse, texts))
        return [each for each in alike if self._means(read, names, each, statements[each.name])], texts, names

    def _means(
        self, told: Sequence[Expression], names: Sequence[str], instance: _Instance, statement: GroundStatement
    ) -> bool:
        types = self._parameters(instance.family)
        binding = {word: (value, type_) for (word, type_), value in zip(types.items(), instance.arguments, strict=True)}
        values = dict(zip(types, instance.arguments, strict=True))
        if {_with(each, values) for each in names} != set(statement.names):
            return False
        scope = self._wording.scope.binding(binding)
        return all(
            self._wording.meaning(text, scope) == normal_form(condition)
            for text, condition in zip(told, statement.conditions, strict=True)
        )

    def _index(self, family: str, instances: Sequence[tuple[str, ...]]) -> str | None:
        """The values that instances have, in words; None if that takes more than sets."""
        parameters = self._parameters(family)
        taken = [
            [value for value in type_.values if any(each[at] == value for each in instances)]
            for at, type_ in enumerate(parameters.values())
        ]
        bound = ", ".join(
            f"{word} in {self._set(values, self._wording.indices[self._prefix + family][word])}"
            for word, values in zip(parameters, taken, strict=True)
        )
        if prod(map(len, taken)) == len(instances):
            return f"all {bound}"
        different = [each for each in instances if len(set(each)) == len(each)]
        if len(parameters) == 2 and len(different) == len(instances):
            one, other = taken
            if len(instances) == sum(a != b for a in one for b in other):
                return f"all {bound} where {' != '.join(parameters)}"
        return None

    def _set(self, values: Sequence[str], declared: str) -> str:
        domains = self._wording.scope.vocabulary.domains
        names = (declared, *domains)
        return next((name for name in names if set(domains[name].values) == set(values)), f"{{{', '.join(values)}}}")


def specifications_folded(wording: ModelWording, names: Sequence[str]) -> list[str]:
    """The names of specifications, those of all instances over an index as one."""
    if not any("(" in name for name in names):
        return list(names)
    return IndexFolding(wording, "specification.").folded_names(names)


def _with(name: str, words: Mapping[str, str]) -> str:
    """A name with other words in the place of some arguments."""
    found = _INSTANCE.fullmatch(name)
    if found is None:
        return name
    arguments = (words.get(each, each) for each in found[3].split(", "))
    return with_arguments(found[1], arguments, found[2] == "[") + found[4]
