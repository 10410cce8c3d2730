"""What the supervisor adds to the guards of starts, for people to read.

What matters of a guard are the states that can be reached under the supervisor and in which the written guard holds. It
is said over the fewest variables, in whichever is shorter of a disjunction and a conjunction of simple terms.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

from sequence_planner.automaton.plain.meaning import NUMBER_SIGN, event_of
from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.syntax import FALSE, And, Expression, Or
from sequence_planner.synthesis.covers import cover, single
from sequence_planner.synthesis.diagrams import Diagrams, Function
from sequence_planner.synthesis.effort import Effort, TooMuchError
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.saturation import reaching
from sequence_planner.synthesis.separation import Separation
from sequence_planner.synthesis.supervision import Supervision
from sequence_planner.synthesis.wording import count_literals, worded

MOST_EFFORT = 20_000_000  # nodes, see `effort`, to find out which states are reached
MOST_EFFORT_PER_GUARD = 3_000_000  # nodes, for the variables it is over, and for either form that it can have
MOST_LITERALS = 60  # of a guard that people can still read
_MOST_SYNTHESES = 8  # to see for which specifications' sake rest is lost
_CACHE = 1 << 16  # for sets over the few variables that tell them apart


@dataclass(frozen=True)
class Guard:
    """Where the supervisor allows some starts, as far as the station can get under it and the written guard holds.

    `starts` are the abilities it is added to: several where they are transitions of one event. `expression` is None
    where no short one was found: then only the states themselves say it. `specifications` are those that could be the
    first to be broken, and nothing prevent it, after some start that must wait. With `rest`, some must wait because no
    state of rest could be reached any more; where that is all, `specifications` are those each of which would have to
    go for it to be allowed.
    """

    starts: tuple[str, ...]
    expression: Expression | None
    literals: int | None
    specifications: tuple[str, ...]
    rest: bool


def shown_guards(supervision: Supervision, most: int = MOST_EFFORT_PER_GUARD) -> Mapping[str, Guard]:
    """The guard of each start that the supervisor restricts, by ability, and in a plain automaton by event.

    Where an event has transitions of which one is allowed and another is not in one state, they have guards of their
    own, under the names `event#1`, `event#2` and so on. Each takes `most` nodes at most, see `Effort`. Raises
    `ValueError` if there is no supervisor.
    """
    if not supervision.possible:
        raise ValueError("there is no supervisor, and every guard would say nothing")
    reached = _reached(supervision)
    on: dict[str, Function] = {}
    off: dict[str, Function] = {}
    for name in _startable(supervision.plant.automaton):
        allowed, disallowed = supervision.guard(name)
        on[name], off[name] = allowed & reached, disallowed & reached
    reasons = _Reasons(supervision)
    either = supervision.plant.diagrams.disjunction
    guards: dict[str, Guard] = {}
    for name, starts in _merged(supervision.plant.automaton, on, off).items():
        allowed, disallowed = either(on[start] for start in starts), either(off[start] for start in starts)
        if disallowed.satisfiable():
            expression = _expression(supervision, allowed, disallowed, most)
            count = None if expression is None else count_literals(expression)
            specifications, rest = reasons.of({start: off[start] for start in starts})
            guards[name] = Guard(starts, expression, count, specifications, rest)
    return guards


def _reached(supervision: Supervision) -> Function:
    """What is reached under the supervisor; where that is too much, what is safe: then guards are longer, and right."""
    try:
        return supervision.reachable(supervised=True, effort=Effort(MOST_EFFORT))
    except TooMuchError:
        return supervision.safe


def _startable(automaton: Automaton) -> list[str]:
    return [name for name, ability in automaton.abilities.items() if not ability.restart]


def _merged(
    automaton: Automaton, on: Mapping[str, Function], off: Mapping[str, Function]
) -> Mapping[str, tuple[str, ...]]:
    """The starts that share a guard, by its name."""
    if not automaton.one_at_a_time:
        return {name: (name,) for name in on}
    events: dict[str, list[str]] = defaultdict(list)
    for name in on:
        events[event_of(name)].append(name)
    merged: dict[str, tuple[str, ...]] = {}
    for event, starts in events.items():
        if any((on[one] & off[other]).satisfiable() for one in starts for other in starts):
            merged |= {f"{event}{NUMBER_SIGN}{number}": (name,) for number, name in enumerate(starts, start=1)}
        else:
            merged[event] = tuple(starts)
    return merged


def _expression(supervision: Supervision, on: Function, off: Function, most: int) -> Expression | None:
    """Where `on` holds and `off` does not; None if it is too long, or not found."""
    if not on.satisfiable():
        return FALSE
    automaton = supervision.plant.automaton
    separation = Separation(supervision.plant, on, off, Effort(most))
    names = separation.names
    if len(names) > MOST_LITERALS:  # each of them has to be read
        return None
    diagrams = Diagrams({name: automaton.types[name].domain for name in names}, cache=_CACHE)
    few_on, few_off = separation.over(diagrams, on), separation.over(diagrams, off)
    # What one cube says is soon found, and often all that has to be said. As wide as it can be where it is allowed, and
    # as narrow where it is not, it says the same as the two forms of a cover would.
    ways = (
        (single, True),
        (partial(single, widest=False), False),
        (cover, True),
        (cover, False),
    )
    shortest: Expression | None = None
    for find, allowed in ways:
        longest = MOST_LITERALS if shortest is None else count_literals(shortest)
        one, other = (few_on, few_off) if allowed else (few_off, few_on)
        cubes = find(diagrams, one, other, Effort(most), longest)
        text = None if cubes is None else worded(automaton.types, diagrams, cubes, allowed)
        if text is not None and count_literals(text) <= longest:
            shortest = text if shortest is None else min(shortest, text, key=_length)
            if _length(shortest) <= (len(names), False):
                break
    return shortest


def _length(expression: Expression) -> tuple[int, bool]:
    """How long it is to read; of two that are alike, a conjunction says one reason after the other."""
    mixed = isinstance(expression, Or) and any(isinstance(part, And) for part in expression.operands)
    return count_literals(expression), mixed


class _Reasons:
    """Why starts must wait."""

    def __init__(self, supervision: Supervision) -> None:
        plant, diagrams = supervision.plant, supervision.plant.diagrams
        self._plant = plant
        # What is broken first is the reason, and not what may be broken after that.
        unbroken = diagrams.valid & ~diagrams.disjunction(supervision.forbidden.values())
        self._trouble = {
            name: reaching(diagrams, forbidden, plant.uncontrollable, forbidden | unbroken)
            for name, forbidden in supervision.forbidden.items()
        }
        self._restless = diagrams.valid & ~supervision.safe & ~diagrams.disjunction(self._trouble.values())

    def of(self, off: Mapping[str, Function]) -> tuple[tuple[str, ...], bool]:
        """The specifications for whose sake starts must wait in `off`, and whether some must for the sake of rest."""
        found = tuple(name for name, trouble in self._trouble.items() if self._leads(off, trouble))
        rest = self._leads(off, self._restless)
        if rest and not found:
            found = tuple(name for name, safe in self._without.items() if self._leads(off, safe))
        return found, rest

    def _leads(self, off: Mapping[str, Function], states: Function) -> bool:
        return any(
            (step.before(states) & where).satisfiable()
            for start, where in off.items()
            for step in self._plant.starts.get(start, ())
        )

    @cached_property
    def _without(self) -> dict[str, Function]:
        """For each specification, the states that would be safe without it; nothing if there are many of them."""
        automaton, diagrams = self._plant.automaton, self._plant.diagrams
        if len(self._trouble) > _MOST_SYNTHESES:
            return {}
        safe: dict[str, Function] = {}
        for name in self._trouble:
            others = {other: each for other, each in automaton.specifications.items() if other != name}
            plant = Plant(replace(automaton, specifications=others), diagrams.names)
            states = Supervision(plant).safe
            safe[name] = diagrams.imported(plant.diagrams.exported(states)) & diagrams.valid
        return safe
