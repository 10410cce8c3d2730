"""Names that a station gives to sets of values, relations, maps and conditions: what expressions may say for short.

None of them is in the automaton: resolution writes out what they stand for.
"""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.core.immutable import Immutable
from sequence_planner.language.syntax import Expression
from sequence_planner.language.types import EnumerationType, Type, Value


class ValueRelation(Immutable):
    """The pairs of values, one of each type, between which a relation holds."""

    types: tuple[EnumerationType, EnumerationType]
    pairs: frozenset[tuple[str, str]]


class ValueMap(Immutable):
    """The value that belongs to each value of an enumeration; `table` may leave some out."""

    source: EnumerationType
    target: Type
    table: Mapping[str, Value]


class NamedPredicate(Immutable):
    """A condition with a name. `body` is not resolved; `prefixes` are those of the place where it is declared."""

    name: str
    parameters: Mapping[str, EnumerationType]
    body: Expression
    prefixes: tuple[str, ...] = ()


class Vocabulary:
    """All such names of a station. `domains` are its enumerations and named sets, `ordered` those that are compared
    by the order of their values. `unusable` are names that are declared, but with something wrong, which is told there.
    """

    def __init__(
        self,
        domains: Mapping[str, EnumerationType] | None = None,
        ordered: tuple[EnumerationType, ...] = (),
        relations: Mapping[str, ValueRelation] | None = None,
        maps: Mapping[str, ValueMap] | None = None,
        predicates: Mapping[str, NamedPredicate] | None = None,
        unusable: frozenset[str] = frozenset(),
    ) -> None:
        self.domains: Mapping[str, EnumerationType] = domains or {}
        self.ordered = ordered
        self.relations: Mapping[str, ValueRelation] = relations or {}
        self.maps: Mapping[str, ValueMap] = maps or {}
        self.predicates: Mapping[str, NamedPredicate] = predicates or {}
        self.unusable = unusable
        self.expanded: dict[tuple[str, tuple[str, ...]], Expression] = {}
        """What each predicate means for the values of its parameters, as far as somebody has asked."""
        self.expanding: list[str] = []
        """The predicates that are being written out, the outermost first."""

    def domain_named(self, word: str, prefixes: tuple[str, ...] = ()) -> str | None:
        """The full name of the enumeration or set that is meant where names under one of `prefixes` need none."""
        return next((prefix + word for prefix in (*prefixes, "") if prefix + word in self.domains), None)

    def order_of(self, *types: Type) -> EnumerationType | None:
        """The ordered enumeration that has the values of all of `types`, the smallest of several; or None."""
        values = {value for type_ in types if isinstance(type_, EnumerationType) for value in type_.values}
        if not values or not all(isinstance(type_, EnumerationType) for type_ in types):
            return None
        found = [each for each in self.ordered if values.issubset(each.values)]
        return min(found, key=lambda each: len(each.values), default=None)

    def names_beside(self, prefixes: tuple[str, ...]) -> list[str]:
        """The names that can stand in a condition, those under one of `prefixes` without it."""
        found = [*self.predicates, *self.relations, *self.maps]
        own = [name.removeprefix(prefix) for prefix in prefixes for name in found if name.startswith(prefix)]
        return [*own, *found]

    def declared(self) -> tuple[object, ...]:
        """All that is declared: where it is equal, each text means the same."""
        return (self.domains, self.ordered, self.relations, self.maps, self.predicates, self.unusable)

    def __getstate__(self) -> dict[str, object]:
        return {**vars(self), "expanded": {}, "expanding": []}


NO_VOCABULARY = Vocabulary()
