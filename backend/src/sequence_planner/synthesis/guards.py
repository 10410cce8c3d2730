"""Readable supervisor guards: cube covers of state sets, printed as expressions of the language."""

from __future__ import annotations

import contextlib
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.plain.events import NUMBER_SIGN, event_of
from sequence_planner.language.syntax import (
    FALSE,
    And,
    Comparison,
    Constant,
    Expression,
    Membership,
    Not,
    Or,
    Variable,
    children,
    conjunction,
)
from sequence_planner.language.types import BooleanType, IntegerRange, Type, Value
from sequence_planner.synthesis.approximation import Separation
from sequence_planner.synthesis.bdd import Diagrams, Function
from sequence_planner.synthesis.hitting import least_hitting
from sequence_planner.synthesis.reachability import reaching
from sequence_planner.synthesis.supervisor import Supervision
from sequence_planner.synthesis.transition_relation import NodeLimit, Plant, TooMuchError

# Cubes, which say for some variables what values they may have, and the largest of those that miss a set of states.
#
# They are found by expansion, or all of them by cutting off what must be missed, as the minimisation of logic knows it
# (Brayton et al. 1984), over variables of many values (Rudell & Sangiovanni-Vincentelli 1987).

# For each variable of the diagrams, the positions in its domain of the values it may have, as bits of a number.
Cube = tuple[int, ...]

_MOST_PIECES = 4_000  # of cubes while something is cut off from them


class Primes:
    """The largest cubes that hold nothing of `off`. Raises `TooMuchError` when they take more than `effort`."""

    def __init__(self, diagrams: Diagrams, off: Function, effort: NodeLimit) -> None:
        self._diagrams = diagrams
        self._off = off
        self.effort = effort
        self._literals: dict[tuple[int, int], Function] = {}
        self.whole = tuple((1 << len(domain)) - 1 for domain in diagrams.domains.values())
        self.axes = range(len(self.whole))

    def function(self, cube: Cube) -> Function:
        """The states that a cube holds, and perhaps some that do not exist."""
        return self._diagrams.conjunction(self._literal(axis, cube[axis]) for axis in reversed(self.restricted(cube)))

    def restricted(self, cube: Cube) -> list[int]:
        """The variables that have a literal in it."""
        return [axis for axis in self.axes if cube[axis] != self.whole[axis]]

    def holding(self, states: Function, most: int, literals: int | None = None) -> dict[Cube, Function] | None:
        """Cubes that together hold `states`; None if there would be more than `most`, or more than so many literals."""
        found: dict[Cube, Function] = {}
        while states.satisfiable():
            if len(found) == most:
                return None
            cube = self.expanded(self.around(states, one=True), self.axes, states)
            if literals is not None:
                literals -= len(self.restricted(cube))
                if literals < 0:
                    return None
            found[cube] = self.function(cube)
            states &= ~found[cube]
        return found

    def around(self, states: Function, one: bool = False) -> Cube:
        """The smallest cube that holds all of the states, or else one of them."""
        if one:
            state = self._diagrams.pick(states)
            assert state is not None
            return tuple(1 << domain.index(state[name]) for name, domain in self._diagrams.domains.items())
        return tuple(
            sum(
                1 << position
                for position, where in enumerate(self._diagrams.values(name).values())
                if (states & where).satisfiable()
            )
            for name in self._diagrams.names
        )

    def expanded(self, cube: Cube, order: Iterable[int], wanted: Function | None = None, widest: bool = True) -> Cube:
        """A largest cube that holds `cube`: literals are left out in `order`, then the others widened, if `widest`.

        With `wanted`, the literal without which it holds most of that goes first.
        """
        axes = list(order)
        if wanted is None:
            for axis in axes:
                if self.fits(freed := _with(cube, axis, self.whole[axis])):
                    cube = freed
        else:
            cube = self._freed_for(wanted, cube, axes)
        return self._widened(cube, axes) if widest else cube

    def _freed_for(self, wanted: Function, cube: Cube, axes: Iterable[int]) -> Cube:
        left = list(axes)
        while True:
            freed = self._freed(cube)
            gains = {axis: self._gain(freed[axis], wanted) for axis in left}
            left = [axis for axis in left if gains[axis] >= 0]  # a literal that is needed stays so in larger cubes
            if not left:
                return cube
            best = max(left, key=gains.__getitem__)
            cube = _with(cube, best, self.whole[best])
            left.remove(best)

    def _widened(self, cube: Cube, axes: Iterable[int]) -> Cube:
        for axis in axes:
            for position in range(self.whole[axis].bit_length()):
                wider = _with(cube, axis, cube[axis] | 1 << position)
                if wider != cube and self.fits(wider):
                    cube = wider
        return cube

    def every(self, most: int) -> list[Cube] | None:
        """All of them; None if they are too many."""
        excluded = Primes(self._diagrams, self._diagrams.valid & ~self._off, self.effort).holding(self._off, most)
        return None if excluded is None else self._missing(excluded, most)

    def _missing(self, excluded: Iterable[Cube], most: int) -> list[Cube] | None:
        """The largest cubes that have nothing in common with any of `excluded`; None if they are too many.

        Each excluded cube is cut off by taking its values from one variable.
        """
        widths = [mask.bit_length() for mask in self.whole]
        found = [self.whole]
        for cut in excluded:
            met = {cube for cube in found if all(a & b for a, b in zip(cube, cut, strict=True))}
            pieces = {
                _with(cube, axis, left) for cube in met for axis, mask in enumerate(cut) if (left := cube[axis] & ~mask)
            }
            if len(pieces) > _MOST_PIECES:
                return None
            self.effort.use(len(pieces) * (len(found) + len(pieces)))
            found = _largest([cube for cube in found if cube not in met], pieces, widths)
            if len(found) > most:
                return None
        return found

    def _freed(self, cube: Cube) -> list[Function]:
        """Return what the cube holds without its literal of each variable."""
        true = self._diagrams.true
        literals = [self._literal(a, cube[a]) if cube[a] != self.whole[a] else true for a in self.axes]
        before = [true]
        for literal in literals:
            before.append(before[-1] & literal)
        freed, after = before[:-1], true
        for axis in reversed(self.axes):
            freed[axis] &= after
            after &= literals[axis]
        return freed

    def _gain(self, freed: Function, wanted: Function) -> int:
        """Return how much of `wanted` is in what is left of a cube; less than nothing if that is too large."""
        self.effort.spend(freed)
        return -1 if (freed & self._off).satisfiable() else self._diagrams.count(freed & wanted)

    def fits(self, cube: Cube) -> bool:
        """Return whether the cube holds nothing of `off`."""
        self.effort.spend(self._off)
        return not (self.function(cube) & self._off).satisfiable()

    def _literal(self, axis: int, mask: int) -> Function:
        if (axis, mask) not in self._literals:
            values = self._diagrams.values(self._diagrams.names[axis]).values()
            allowed = (where for position, where in enumerate(values) if mask >> position & 1)
            self._literals[axis, mask] = self._diagrams.disjunction(allowed)
        return self._literals[axis, mask]


def _with(cube: Cube, axis: int, mask: int) -> Cube:
    return (*cube[:axis], mask, *cube[axis + 1 :])


def _largest(apart: Sequence[Cube], pieces: Iterable[Cube], widths: Sequence[int]) -> list[Cube]:
    """`apart`, and those of `pieces` that are within no other cube."""
    kept = {cube: _packed(cube, widths) for cube in apart}
    for piece in sorted(pieces, key=lambda cube: (-sum(mask.bit_count() for mask in cube), cube)):
        values = _packed(piece, widths)
        if all(values | other != other for other in kept.values()):
            kept[piece] = values
    return list(kept)


def _packed(cube: Cube, widths: Sequence[int]) -> int:
    """The values of all variables as bits of one number."""
    packed = 0
    for mask, width in zip(cube, widths, strict=True):
        packed = packed << width | mask
    return packed


# Few words for a set of states: a cover by cubes that together hold all of it, and nothing of another set.
#
# What is in neither set does not matter. Each restricted variable of a cube is a literal, and there shall be few of
# them.

MOST_CUBES = 400  # to choose from; as long as there are no more in all, the cover has the fewest literals
_MOST_ROUNDS = 8  # of looking for better cubes, where there are more
_NEEDLESS = 2  # times as many literals as wanted are too many to go on, of which few will be left out
_ORDERS = 12  # in which a cube is expanded


def single(
    diagrams: Diagrams, on: Function, off: Function, effort: NodeLimit, most_literals: int, widest: bool = True
) -> tuple[Cube] | None:
    """A cube that alone holds all of `on` and nothing of `off`, if there is one; its values are the `widest` or least.

    No literal can be left out, and there are `most_literals` at most.
    """
    primes = Primes(diagrams, off, effort)
    try:
        around = primes.around(on)
        if not primes.fits(around):
            return None
        cube = primes.expanded(around, primes.axes, widest=widest)
    except TooMuchError:
        return None
    return (cube,) if len(primes.restricted(cube)) <= most_literals else None


def cover(
    diagrams: Diagrams, on: Function, off: Function, effort: NodeLimit, most_literals: int
) -> tuple[Cube, ...] | None:
    """Cubes that hold all of `on` and nothing of `off`, with few literals; None if that takes far more than the most.

    No literal can be widened or left out, and no cube be left out. `on` and `off` are apart, and neither is empty. No
    more than `effort` is spent: where there is a cover by then, it may not have the fewest literals.
    """
    primes = Primes(diagrams, off, effort)
    try:
        begin = primes.holding(on, MOST_CUBES, _NEEDLESS * most_literals)
    except TooMuchError:
        return None
    if begin is None:
        return None
    chosen = _Cover(diagrams, primes, on, begin)
    with contextlib.suppress(TooMuchError):
        chosen.improve(_needed(diagrams, on, off))
    return tuple(sorted(chosen.best, key=lambda cube: (len(primes.restricted(cube)), primes.restricted(cube))))


def _needed(diagrams: Diagrams, on: Function, off: Function) -> int:
    """A number of literals that no cover goes below: those of variables in which alone two states differ."""
    return sum((diagrams.exists(on, (name,)) & off).satisfiable() for name in diagrams.names)


class _Cover:
    """Chooses from the cubes found so far, which hold all of `on`; those of `best` do as well."""

    def __init__(self, diagrams: Diagrams, primes: Primes, on: Function, found: dict[Cube, Function]) -> None:
        self._diagrams = diagrams
        self._primes = primes
        self._on = on
        self._found = found
        self.best = self._irredundant(tuple(found))

    def literals(self, cubes: Iterable[Cube]) -> int:
        """Return how many literals the cubes have together."""
        return sum(len(self._primes.restricted(cube)) for cube in cubes)

    def improve(self, needed: int) -> None:
        """Find the best cover, or a good one where there are too many cubes. None has fewer than `needed` literals."""
        if len(self.best) > 1:
            self._choose()
        if needed < self.literals(self.best):
            if self._complete():
                self._choose()
            else:
                self._look_around()

    def _complete(self) -> bool:
        """Find all cubes; False if they are too many."""
        every = self._primes.every(MOST_CUBES)
        for cube in every or ():
            self._add(cube)
        return every is not None

    def _look_around(self) -> None:
        """Find cubes that are better."""
        for _ in range(_MOST_ROUNDS):
            known = len(self._found)
            self._vary(self.best)
            if len(self._found) == known:
                break
            self._choose()

    def _choose(self) -> None:
        """Of the cubes found, those of fewest literals, then fewest cubes, that hold all."""
        cubes = list(self._found)
        number = {cube: position for position, cube in enumerate(cubes)}
        weights = [self.literals((cube,)) for cube in cubes]

        def missed(chosen: frozenset[int]) -> list[int] | None:
            missing = self._on & ~self._held(cubes[each] for each in chosen)
            return self._holding(missing, cubes) if missing.satisfiable() else None

        start = frozenset(number[cube] for cube in self.best)
        chosen = least_hitting(start, (weights, [1] * len(cubes)), missed)
        self.best = self._irredundant(tuple(cubes[each] for each in sorted(chosen)))

    def _vary(self, cubes: Sequence[Cube]) -> None:
        """Find other cubes for what each of `cubes` alone holds, all of it or a part."""
        for cube in cubes:
            own = self._on & self._found[cube] & ~self._held(other for other in cubes if other != cube)
            for start in (self._primes.around(own), self._primes.around(own, one=True)):
                for order in self._orders():
                    if len(self._found) < MOST_CUBES:
                        self._add(self._primes.expanded(start, order))

    def _add(self, cube: Cube) -> None:
        if cube not in self._found:
            function = self._primes.function(cube)
            if (function & self._on).satisfiable():
                self._found[cube] = function

    def _held(self, cubes: Iterable[Cube]) -> Function:
        return self._diagrams.disjunction(self._found[cube] for cube in cubes)

    def _holding(self, states: Function, cubes: Sequence[Cube]) -> list[int]:
        """The cubes that hold one of `states`, of which few cubes do."""
        for cube in cubes:
            self._primes.effort.spend(states)
            if (rest := states & ~self._found[cube]).satisfiable():
                states = rest
        return [each for each, cube in enumerate(cubes) if (states & self._found[cube]).satisfiable()]

    def _irredundant(self, cubes: tuple[Cube, ...]) -> tuple[Cube, ...]:
        """`cubes` without those that the others make needless."""
        kept = cubes
        for cube in sorted(cubes, key=lambda each: -self.literals((each,))):
            others = tuple(other for other in kept if other != cube)
            if not (self._on & ~self._held(others)).satisfiable():
                kept = others
        return kept

    def _orders(self) -> Iterator[list[int]]:
        """Some orders of the variables, forwards and backwards."""
        axes = list(self._primes.axes)
        for first in range(0, len(axes), max(1, 2 * len(axes) // _ORDERS)):
            turned = axes[first:] + axes[:first]
            yield turned
            yield turned[::-1]


# Covers in the words of the language: `not task and (bolts != placed or run_nut.executing)`.

_MOST_LISTED = 4  # values within a range; beyond them its bounds are said


def worded(types: Mapping[str, Type], diagrams: Diagrams, cubes: Sequence[Cube], allowed: bool) -> Expression:
    """Return where one of `cubes` holds; or else, if they are not `allowed`, where none of them does."""
    parts = [tuple(_literals(types, diagrams, cube, allowed)) for cube in cubes]
    if allowed:
        return _either(*(conjunction(*part) for part in parts))
    return conjunction(*(_either(*part) for part in parts))


def count_literals(expression: Expression) -> int:
    """Return how many comparisons, memberships and truth values a person reads."""
    match expression:
        case Variable() | Comparison() | Membership():
            return 1
        case _:
            return sum(map(count_literals, children(expression)))


def _either(*parts: Expression) -> Expression:
    return parts[0] if len(parts) == 1 else Or(parts)


def _literals(types: Mapping[str, Type], diagrams: Diagrams, cube: Cube, allowed: bool) -> Iterator[Expression]:
    for (name, domain), mask in zip(diagrams.domains.items(), cube, strict=True):
        inside = tuple(value for position, value in enumerate(domain) if mask >> position & 1)
        outside = tuple(value for position, value in enumerate(domain) if not mask >> position & 1)
        if outside:
            variable = Variable(name, types[name])
            yield _literal(variable, inside, outside) if allowed else _literal(variable, outside, inside)


def _literal(variable: Variable, inside: tuple[Value, ...], outside: tuple[Value, ...]) -> Expression:
    """That the variable has one of the values `inside`."""
    if isinstance(variable.type, BooleanType):
        return variable if inside == (True,) else Not(variable)
    if len(inside) == 1:
        return Comparison("==", variable, Constant(inside[0]))
    if isinstance(variable.type, IntegerRange) and (ranged := _ranged(variable, variable.type, inside)) is not None:
        return ranged
    if len(outside) == 1:
        return Comparison("!=", variable, Constant(outside[0]))
    if len(inside) <= len(outside):
        return Membership(variable, tuple(map(Constant, inside)))
    return Not(Membership(variable, tuple(map(Constant, outside))))


def _ranged(variable: Variable, domain: IntegerRange, inside: tuple[Value, ...]) -> Expression | None:
    """The values by their bounds, if none between them is missing and they are not few."""
    least, most = int(inside[0]), int(inside[-1])
    if len(inside) != most - least + 1:
        return None
    at_least, at_most = Comparison(">=", variable, Constant(least)), Comparison("<=", variable, Constant(most))
    if most == domain.maximum:
        return at_least
    if least == domain.minimum:
        return at_most
    return And((at_least, at_most)) if len(inside) > _MOST_LISTED else None


# How a person is told which of two sets a state is in, where that can be said in few words, and where it cannot.
#
# It is said over the fewest variables, in whichever is shorter of a disjunction and a conjunction of simple terms.

MOST_LITERALS = 60  # of a guard that people can still read
MOST_CASES = 3  # of those in which a start must wait, where there is no short guard
MOST_LITERALS_OF_CASE = 12
_LEAST = 50  # nodes, as which what is done with fewer counts: it takes as long
_CACHE = 1 << 16  # for sets over the few variables that tell them apart


class Saying:
    """Two sets of states of a plant that are apart, the second not empty; either way to say it takes so much `effort`
    at most, see `NodeLimit`.
    """

    def __init__(self, plant: Plant, on: Function, off: Function, effort: int) -> None:
        self._plant = plant
        self._on = on
        self._off = off
        self._effort = effort

    def shortest(self) -> Expression | None:
        """Return where `on` holds and `off` does not; None if it is too long, or not found."""
        if not self._on.satisfiable():
            return FALSE
        needed = len(self._separation.names)  # each of them has to be read
        if needed > MOST_LITERALS:
            return None
        # What one cube says is soon found, and often all that has to be said. As wide as it can be where it is allowed,
        # and as narrow where it is not, it says the same as the two forms of a cover would.
        ways = (
            (single, True),
            (partial(single, widest=False), False),
            (cover, True),
            (cover, False),
        )
        shortest: Expression | None = None
        for find, allowed in ways:
            longest = MOST_LITERALS if shortest is None else count_literals(shortest)
            one, other = self._few if allowed else reversed(self._few)
            cubes = find(self._diagrams, one, other, self._new_effort(), longest)
            text = None if cubes is None else self._worded(cubes, allowed)
            if text is not None and count_literals(text) <= longest:
                shortest = text if shortest is None else min(shortest, text, key=_length)
                if _length(shortest) <= (needed, False):
                    break
        return shortest

    def blocked(self) -> tuple[Expression, ...]:
        """Some conditions wherever one of which holds, `off` does, the one nearest to the initial state first.

        What is as there is left out of them first; long ones are not said.
        """
        diagrams, initial = self._diagrams, self._initially
        on, off = self._few
        primes = Primes(diagrams, on, self._new_effort())
        found: list[Expression] = []
        try:
            for _ in range(MOST_CASES):
                changes = diagrams.exported(off, diagrams.names).nearest(initial)
                if changes is None:
                    break
                state = {**initial, **changes}
                cube = tuple(1 << domain.index(state[name]) for name, domain in diagrams.domains.items())
                cube = primes.expanded(cube, sorted(primes.axes, key=lambda axis: diagrams.names[axis] in changes))
                off &= ~primes.function(cube)
                if len(primes.restricted(cube)) <= MOST_LITERALS_OF_CASE:
                    found.append(self._worded((cube,), allowed=True))
        except TooMuchError:
            pass
        return tuple(found)

    def _new_effort(self) -> NodeLimit:
        return NodeLimit(self._effort, _LEAST)

    @cached_property
    def _separation(self) -> Separation:
        return Separation(self._plant, self._on, self._off, self._new_effort())

    @cached_property
    def _diagrams(self) -> Diagrams:
        types = self._plant.automaton.types
        return Diagrams({name: types[name].domain for name in self._separation.names}, cache=_CACHE)

    @cached_property
    def _few(self) -> tuple[Function, Function]:
        """Both sets over what tells them apart."""
        on, off = (self._separation.over(self._diagrams, states) for states in (self._on, self._off))
        return on, off

    @cached_property
    def _initially(self) -> dict[str, Value]:
        """The values in an initial state of what tells the sets apart."""
        plant = self._plant
        state = plant.diagrams.pick(plant.initial)
        assert state is not None
        one = plant.diagrams.states(state)
        lookups = {name: plant.reader.lookup(name) for name in self._diagrams.names}
        return {
            name: state[name] if name in state else (values[True] & one).satisfiable()
            for name, values in lookups.items()
        }

    def _worded(self, cubes: tuple[Cube, ...], allowed: bool) -> Expression:
        return worded(self._plant.automaton.types, self._diagrams, cubes, allowed)


def _length(expression: Expression) -> tuple[int, bool]:
    """Return how long it is to read; of two that are alike, a conjunction says one reason after the other."""
    mixed = isinstance(expression, Or) and any(isinstance(part, And) for part in expression.operands)
    return count_literals(expression), mixed


# What the supervisor adds to the guards of starts, for people to read.
#
# What matters of a guard are the states that can be reached under the supervisor and in which the written guard holds.

MOST_EFFORT = 20_000_000  # nodes, see `effort`, to find out which states are reached
MOST_EFFORT_PER_GUARD = 2_000_000  # nodes, for the variables it is over, and for either form that it can have
_MOST_SYNTHESES = 8  # to see for which specifications' sake rest is lost


@dataclass(frozen=True)
class SupervisorGuard:
    """A guard: where the supervisor allows some starts, as far as the station can get under it and the written guard
    holds.

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

    Where too many states are reached, which may be known, guards are `of_safe` ones: then they are longer, and right.
    """

    def __init__(self, supervision: Supervision, of_safe: bool = False) -> None:
        if not supervision.possible:
            raise ValueError("there is no supervisor, and every guard would say nothing")
        self._supervision = supervision
        automaton, reached = supervision.plant.automaton, None if of_safe else _reached(supervision)
        self.of_safe = reached is None
        self._on: dict[str, Function] = {}
        self._off: dict[str, Function] = {}
        for name in _startable(automaton):
            allowed, disallowed = supervision.guard(name)
            self._on[name] = allowed if reached is None else allowed & reached
            self._off[name] = disallowed if reached is None else disallowed & reached
        merged = _merged(automaton, self._on, self._off)
        self.starts: Mapping[str, tuple[str, ...]] = {
            name: starts for name, starts in merged.items() if any(self._off[start].satisfiable() for start in starts)
        }

    def guard(self, name: str, most: int = MOST_EFFORT_PER_GUARD) -> SupervisorGuard:
        """The guard of this name; `most` nodes is what either way to say it may take, see `NodeLimit`."""
        starts, either = self.starts[name], self._supervision.plant.diagrams.disjunction
        allowed, disallowed = (either(side[start] for start in starts) for side in (self._on, self._off))
        said = Saying(self._supervision.plant, allowed, disallowed, most)
        expression = said.shortest()
        count = None if expression is None else count_literals(expression)
        specifications, rest = self._reasons.of({start: self._off[start] for start in starts})
        return SupervisorGuard(
            starts, expression, count, specifications, rest, said.blocked() if expression is None else ()
        )

    @cached_property
    def _reasons(self) -> _Reasons:
        return _Reasons(self._supervision)


def shown_guards(supervision: Supervision, most: int = MOST_EFFORT_PER_GUARD) -> Mapping[str, SupervisorGuard]:
    """The guard of each start that the supervisor restricts, by name, see `Restrictions`."""
    restrictions = Restrictions(supervision)
    return {name: restrictions.guard(name, most) for name in restrictions.starts}


def _reached(supervision: Supervision) -> Function | None:
    """Return what is reached under the supervisor; None where that is too much."""
    with contextlib.suppress(TooMuchError):
        return supervision.reachable(supervised=True, effort=NodeLimit(MOST_EFFORT))
    return None


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
    """The reasons why starts must wait."""

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
