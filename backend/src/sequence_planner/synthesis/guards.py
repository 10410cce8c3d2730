"""What the supervisor adds to the guards of starts, for people to read.

What matters of a guard are the states that can be reached under the supervisor and in which the written guard holds.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from sequence_planner.automaton.plain.events import NUMBER_SIGN, event_of
from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.syntax import Expression
from sequence_planner.synthesis.diagrams import Function
from sequence_planner.synthesis.effort import Effort, TooMuchError
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.saturation import reaching
from sequence_planner.synthesis.saying import Saying
from sequence_planner.synthesis.supervision import Supervision
from sequence_planner.synthesis.wording import count_literals

MOST_EFFORT = 20_000_000  # nodes, see `effort`, to find out which states are reached
MOST_EFFORT_PER_GUARD = 2_000_000  # nodes, for the variables it is over, and for either form that it can have
_MOST_SYNTHESES = 8  # to see for which specifications' sake rest is lost


@dataclass(frozen=True)
class Guard:
    """Where the supervisor allows some starts, as far as the station can get under it and the written guard holds.

    `starts` are the abilities it is added to: several where they are transitions of one event. `expression` is None
    where no short one was found: then only the states themselves say it, and `blocked` are some conditions wherever one
    of which holds they must wait, the one nearest to the initial state first. `specifications` are those that could be
    the first to be broken, and nothing prevent it, after some start that must wait. With `rest`, some must wait because
    no state of rest could be reached any more; where that is all, `specifications` are those each of which would have
    to go for it to be allowed.
    """

    starts: tuple[str, ...]
    expression: Expression | None
    literals: int | None
    specifications: tuple[str, ...]
    rest: bool
    blocked: tuple[Expression, ...] = ()


class Restrictions:
    """The starts that the supervisor restricts, by the name of the guard that it adds to them: the ability, and in a
    plain automaton the event.

    Where an event has transitions of which one is allowed and another is not in one state, they have guards of their
    own, under the names `event#1`, `event#2` and so on. Raises `ValueError` if there is no supervisor.
    """

    def __init__(self, supervision: Supervision) -> None:
        if not supervision.possible:
            raise ValueError("there is no supervisor, and every guard would say nothing")
        self._supervision = supervision
        automaton, reached = supervision.plant.automaton, _reached(supervision)
        self._on: dict[str, Function] = {}
        self._off: dict[str, Function] = {}
        for name in _startable(automaton):
            allowed, disallowed = supervision.guard(name)
            self._on[name], self._off[name] = allowed & reached, disallowed & reached
        merged = _merged(automaton, self._on, self._off)
        self.starts: Mapping[str, tuple[str, ...]] = {
            name: starts for name, starts in merged.items() if any(self._off[start].satisfiable() for start in starts)
        }

    def guard(self, name: str, most: int = MOST_EFFORT_PER_GUARD) -> Guard:
        """The guard of this name; `most` nodes is what either way to say it may take, see `Effort`."""
        starts, either = self.starts[name], self._supervision.plant.diagrams.disjunction
        allowed, disallowed = (either(side[start] for start in starts) for side in (self._on, self._off))
        said = Saying(self._supervision.plant, allowed, disallowed, most)
        expression = said.shortest()
        count = None if expression is None else count_literals(expression)
        specifications, rest = self._reasons.of({start: self._off[start] for start in starts})
        return Guard(starts, expression, count, specifications, rest, said.blocked() if expression is None else ())

    @cached_property
    def _reasons(self) -> _Reasons:
        return _Reasons(self._supervision)


def shown_guards(supervision: Supervision, most: int = MOST_EFFORT_PER_GUARD) -> Mapping[str, Guard]:
    """The guard of each start that the supervisor restricts, by name, see `Restrictions`."""
    restrictions = Restrictions(supervision)
    return {name: restrictions.guard(name, most) for name in restrictions.starts}


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
