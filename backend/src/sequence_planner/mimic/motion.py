"""What moves in a station, and between which places: found in the abilities that send it there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sequence_planner.automaton.automaton import Ability, Automaton, Kind
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import Comparison, Constant, Expression, Variable, children
from sequence_planner.language.types import EnumerationType, Value

FEWEST_STOPS = 2
MOST_STOPS = 80


@dataclass(frozen=True)
class Motion:
    """A resource that is sent to `stops` by its output `target`, and says in `position` where it is.

    `ways` are the pairs of stops with an ability from the one to the other, in order of the stops.
    """

    resource: str
    position: str
    target: str
    previous: str | None
    stops: tuple[str, ...]
    ways: tuple[tuple[str, str], ...]

    def neighbours(self, stop: str) -> tuple[str, ...]:
        """The stops with a way from or to this one."""
        return tuple(end if start == stop else start for start, end in self.ways if stop in (start, end))


def motions(automaton: Automaton) -> list[Motion]:
    """Everything that moves: an ability sends it to a value, and has done so when it measures that value. Of a resource
    the motion with most stops counts.
    """
    sends: dict[tuple[str, str, str], list[tuple[str, Ability]]] = {}
    for ability in automaton.abilities.values():
        for target, position, value in _sends(automaton, ability):
            sends.setdefault((ability.resource, target, position), []).append((value, ability))
    found: dict[str, Motion] = {}
    for (resource, target, position), each in sends.items():
        values = {value for value, _ in each}
        if len(values) < FEWEST_STOPS or (resource in found and len(found[resource].stops) >= len(values)):
            continue
        stops = tuple(value for value in map(str, automaton.variables[position].type.domain) if value in values)
        stops = stops[:MOST_STOPS]
        ways = _ways(each, stops, target, position)
        found[resource] = Motion(resource, position, target, _previous(automaton, resource, position), stops, ways)
    return [found[resource] for resource in automaton.resources if resource in found]


def _sends(automaton: Automaton, ability: Ability) -> Iterator[tuple[str, str, str]]:
    """The output, the measured variable and the value of a motion that an ability begins."""
    sent = {
        (action.target.name, action.value.value)
        for action in ability.start_actions
        if isinstance(action.target, Variable) and isinstance(action.value, Constant)
    }
    arrived = set(_equalities(ability.finish_guard)) if ability.finish_guard is not None else set()
    for target, value in sorted(sent, key=str):
        for position, at in sorted(arrived, key=str):
            kinds = {target: Kind.OUTPUT, position: Kind.MEASURED}
            if value == at and all(_named_by(automaton, ability.resource, *each) for each in kinds.items()):
                yield target, position, str(value)


def _named_by(automaton: Automaton, resource: str, name: str, kind: Kind) -> bool:
    """Return whether a variable of the resource is of this kind, and of an enumeration."""
    variable = automaton.variables.get(name)
    return (
        variable is not None
        and variable.resource == resource
        and variable.kind is kind
        and isinstance(variable.type, EnumerationType)
    )


def _equalities(expression: Expression) -> Iterator[tuple[str, Value]]:
    """The comparisons with a value in an expression."""
    match expression:
        case Comparison("==", Variable(name), Constant(value)) | Comparison("==", Constant(value), Variable(name)):
            yield name, value
        case _:
            for part in children(expression):
                yield from _equalities(part)


class _Nothing(dict[str, Value | None]):
    """Values of which all others are unknown."""

    def __missing__(self, name: str) -> None:
        """It is not known."""


def _ways(
    sends: list[tuple[str, Ability]], stops: tuple[str, ...], target: str, position: str
) -> tuple[tuple[str, str], ...]:
    """The pairs of stops of which an ability may lead from one to the other, as far as the stops decide."""
    order = {stop: number for number, stop in enumerate(stops)}
    ways = set()
    for end, ability in sends:
        for start in stops:
            known = _Nothing({target: start, position: start})
            guards = (ability.enabled, ability.start_guard)
            if end in order and start != end and all(evaluate(each, known) is not False for each in guards):
                ways.add(tuple(sorted((start, end), key=order.__getitem__)))
    return tuple(sorted(((a, b) for a, b in ways), key=lambda way: (order[way[0]], order[way[1]])))


def _previous(automaton: Automaton, resource: str, position: str) -> str | None:
    """The measured variable that says where it was last, by its name."""
    for name in automaton.variables:
        is_told = any(word in name.removeprefix(f"{resource}.") for word in ("prev", "last"))
        if is_told and name != position and _named_by(automaton, resource, name, Kind.MEASURED):
            return name
    return None
