"""How the names of a draft are written at a field: in their shortest form, with parameters where these can stand."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import islice, product

from sequence_planner.automaton.grounding.findings import with_arguments
from sequence_planner.expressions.likeness import beginning_with
from sequence_planner.expressions.resolution import Scope
from sequence_planner.expressions.types import EnumerationType
from sequence_planner.workshop.language.field import Field
from sequence_planner.workshop.language.lexicon import Lexicon
from sequence_planner.workshop.language.names import Family, Visible
from sequence_planner.workshop.language_view import NameKind

_MOST_FORMS = 2000  # of one family


class Sight:
    """What can be seen from one field."""

    def __init__(self, lexicon: Lexicon, field: Field) -> None:
        self._lexicon = lexicon
        self._field = field
        self._meaning = lexicon.meaning(field)

    @cached_property
    def scope(self) -> Scope:
        """What names mean, for the first choice of the parameters."""
        first = next(self._field.scopes(self._meaning), None)
        return first or self._meaning.scope({}, *self._field.prefixes({}))

    @cached_property
    def parameters(self) -> Mapping[str, EnumerationType]:
        """The parameters with what they range over."""
        enumerations = self.enumerations
        written = ((str(name), enumerations.get(each)) for name, each in self._field.parameters.items())
        return {name: type_ for name, type_ in written if type_ is not None}

    @property
    def enumerations(self) -> Mapping[str, EnumerationType]:
        """The enumerations of the draft."""
        return self._lexicon.declarations.enumerations

    def flags(self) -> Iterator[str]:
        """The flags of the field's own ability, by their bare names."""
        if self._field.ability:
            own = self.scope.prefixes[0]
            yield from (name.removeprefix(own) for name in beginning_with(own, self.scope.names))

    def values(self) -> Iterator[tuple[str, str]]:
        """Each value of each enumeration, with the enumeration."""
        for name, type_ in self.enumerations.items():
            for value in type_.values:
                yield value, name

    @property
    def families(self) -> tuple[Visible, ...]:
        """All families that have a name here."""
        return self._lexicon.seen_from(self._field.resource)

    def forms(self, seen: Visible, long: bool = False) -> Iterator[str]:
        """The names of a family as they can be written here: one for each choice of values or parameters."""
        name = seen.family.name if long or not seen.own else seen.family.name.removeprefix(f"{self._field.resource}.")
        for words in islice(self._arguments(seen.family), _MOST_FORMS):
            written = with_arguments(name, words, seen.family.indexed) + seen.family.suffix
            if written not in self.parameters and self._found(name, words, seen.family) == seen.family.instance(
                tuple(map(self._value, words))
            ):
                yield written

    def has_parameter(self, form: str) -> bool:
        """Whether a parameter is among the arguments of a name."""
        return any(word in self.parameters for word in re.findall(r"\w+", form))

    def _arguments(self, family: Family) -> Iterator[tuple[str, ...]]:
        if not family.arguments:
            return iter([()])
        choices: list[Sequence[str]] = []
        for argument in family.arguments:
            values = self.enumerations[argument].values
            fitting = [name for name, type_ in self.parameters.items() if set(type_.values) <= set(values)]
            choices.append([*fitting, *values])
        return product(*choices)

    def _value(self, word: str) -> str:
        return self.scope.parameters[word][0] if word in self.scope.parameters else word

    def _found(self, name: str, words: tuple[str, ...], family: Family) -> str | None:
        """The full name that a written one has here."""
        text = with_arguments(name, map(self._value, words), family.indexed) + family.suffix
        for prefix in (*self.scope.prefixes, ""):
            if prefix + text in self.scope.variables:
                return prefix + text
        return None


def abilities(families: Iterable[Visible]) -> Iterator[Visible]:
    """One of the families of each ability."""
    for seen in families:
        if seen.family.kind is NameKind.FLAG and seen.family.suffix == ".executing":
            yield seen
