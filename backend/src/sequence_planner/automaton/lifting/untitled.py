"""What of a model has no title that people meet in sentences, and what they read in its place."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.automaton.lifting.spoken_names import SpokenNames
from sequence_planner.language.shorthand.titles import in_language
from sequence_planner.language.syntax import Expression, variables
from sequence_planner.language.types import EnumerationType, Place
from sequence_planner.texts.grammar import ENGLISH


class UntitledName(NamedTuple):
    """A variable, or a value of one, that is told by its name in words."""

    place: Place
    name: str
    told: str


def untitled_names(automaton: Automaton) -> Iterator[UntitledName]:
    """Yield what conditions of abilities, operations and of rest read, in the order in which it is declared."""
    names, titles, seen = SpokenNames(automaton), automaton.titles, set[object]()
    read = set(_read(automaton))
    for name, variable in automaton.variables.items():
        family = without_arguments(name)
        if name not in read or variable.kind is Kind.ACTIVITY or family in seen:
            continue
        seen.add(family)
        place = automaton.places.get(name, Place(automaton.name, 1, 1))
        if not names.is_titled(name):
            yield UntitledName(place, family, names.subject(name, ENGLISH))
        if isinstance(variable.type, EnumerationType):
            own = names.titles(name).values
            for value in variable.type.domain:
                said = own.get(value) or titles.of_value(variable.type, value)
                if in_language(said, "en") is None and value not in seen:
                    seen.add(value)
                    yield UntitledName(place, f"{family} == {value}", names.word(value, ENGLISH))


def _read(automaton: Automaton) -> Iterator[str]:
    conditions: list[Iterable[Expression | None]] = [(automaton.rest,)]
    conditions += [(each.enabled, each.start_guard) for each in automaton.abilities.values()]
    conditions += [(each.precondition, each.goal) for each in automaton.operations.values()]
    for group in conditions:
        for condition in group:
            if condition is not None:
                yield from variables(condition)
