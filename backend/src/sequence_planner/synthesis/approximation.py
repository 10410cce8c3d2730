"""Over-approximation of the reachable states by variable groups, and separation of two state sets."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import cached_property

from sequence_planner.synthesis.bdd import Diagrams, Function
from sequence_planner.synthesis.hitting import least_hitting
from sequence_planner.synthesis.transition_relation import NodeLimit, Plant, TooMuchError, TransitionStep

# More than what is reached, where all of it would take too long: by parts, each of what a few variables can be.
#
# The parts are found together: what one of them may be bears on what becomes of the others ("machine by machine": Cho,
# Hachtel, Macii, Plessier and Somenzi 1996). Their composition has the initial states, and no step leads out of it, so
# it has everything that is reached.


def composed(
    diagrams: Diagrams,
    initial: Function,
    steps: Sequence[TransitionStep],
    groups: Iterable[Collection[str]],
    within: Function,
) -> Function:
    """All that `steps` lead to from `initial` without leaving `within`, and perhaps more of it.

    Each of `groups` is a part of its own: the variables whose values are not told apart from each other.
    """
    others = [set(diagrams.names) - part for part in parts(diagrams.names, groups)]
    reached = [diagrams.exists(initial, names) for names in others]
    together = initial & within
    new = together
    while True:
        after = new
        for step in steps:
            after |= step.after(after) & within
        more = [known | diagrams.exists(after, names) for known, names in zip(reached, others, strict=True)]
        if more == reached:
            return together
        reached, before = more, together
        together = within
        for part in sorted(reached, key=lambda part: part.node_count()):
            together &= part
        new = together & ~before


def parts(names: Iterable[str], groups: Iterable[Collection[str]]) -> list[frozenset[str]]:
    """The groups, as far as they are among `names`, that are not within others; each of `names` is in one."""
    known = frozenset(names)
    distinct = {frozenset({name}) for name in known} | {known.intersection(group) for group in groups}
    largest: list[frozenset[str]] = []
    for each in sorted(distinct, key=lambda part: (-len(part), sorted(part))):
        if not any(each <= other for other in largest):
            largest.append(each)
    return largest


def around(diagrams: Diagrams, groups: Iterable[Collection[str]], most_bits: int) -> list[frozenset[str]]:
    """For each variable what it is grouped with, the smallest groups first, as far as that has so many bits at most."""
    known = parts(diagrams.names, groups)
    return [_joined(diagrams, name, [part for part in known if name in part], most_bits) for name in diagrams.names]


def _joined(diagrams: Diagrams, name: str, groups: Sequence[frozenset[str]], most_bits: int) -> frozenset[str]:
    joined = frozenset({name})
    for group in sorted(groups, key=lambda group: (_bits(diagrams, group), sorted(group))):
        if _bits(diagrams, joined | group) <= most_bits:
            joined |= group
    return joined


def _bits(diagrams: Diagrams, names: Iterable[str]) -> int:
    return sum(len(diagrams.bits[name]) for name in names)


# Over which variables and flags two sets of states can be told apart, and what the sets are over them alone.

# Variables that tell two sets apart without any flag; beyond them, flags would cut the sets into too many parts.
_MOST_VARIABLES = 12


class Separation:
    """Two sets of states of a plant, apart from one another and neither of them empty.

    No more than `effort` is spent on the search for fewer variables than those that are found at once.
    """

    def __init__(self, plant: Plant, on: Function, off: Function, effort: NodeLimit) -> None:
        self._plant = plant
        self._diagrams = plant.diagrams
        self._on = on
        self._off = off
        self._effort = effort

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The fewest variables and flags that tell the sets apart: few flags, and the earliest declared.

        Where it takes too much to find out, there may be more of them, but none that could be left out.
        """
        known = self._without_needless()
        try:
            return self._fewest(known)
        except TooMuchError:
            return tuple(known)

    def _fewest(self, known: Sequence[str]) -> tuple[str, ...]:
        bits = self._diagrams.bits
        candidates = self._variables if len(known) > _MOST_VARIABLES else (*self._variables, *self._flags)
        number = {name: position for position, name in enumerate(candidates)}

        def missed(chosen: frozenset[int]) -> list[int] | None:
            differing = self._differing([candidates[each] for each in sorted(chosen)], candidates)
            return None if differing is None else [number[name] for name in differing]

        start = frozenset(number[name] for name in known)
        met = {each: frozenset(missed(start - {each}) or ()) for each in start}
        # Each of them has to be met, and where no two have something in common, one member does not meet two.
        apart = len(frozenset().union(*met.values())) == sum(map(len, met.values()))
        if apart and all(each == min(others) for each, others in met.items()):
            return tuple(known)
        flags = [int(name not in bits) for name in candidates]
        chosen = least_hitting(start, ([1] * len(candidates), flags), missed, met.values(), earliest=True)
        return tuple(candidates[each] for each in sorted(chosen))

    def over(self, diagrams: Diagrams, states: Function) -> Function:
        """Return which values the variables and flags of `diagrams` have in `states`."""
        bits = self._diagrams.bits.keys()
        flags = [name for name in diagrams.names if name not in bits]
        kept = [name for name in diagrams.names if name in bits]
        found = diagrams.false
        for values, part in self._by_flags(states, flags):
            projected = self._diagrams.exported(self._projected(part, kept))
            held = diagrams.conjunction(diagrams.values(flag)[value] for flag, value in zip(flags, values, strict=True))
            found |= diagrams.imported(projected) & diagrams.valid_of(kept) & held
        return found

    @cached_property
    def _variables(self) -> tuple[str, ...]:
        """The variables that can tell states apart, in order of declaration."""
        support = self._diagrams.support(self._on) | self._diagrams.support(self._off)
        return tuple(name for name in self._plant.automaton.variables if name in support)

    @cached_property
    def _flags(self) -> tuple[str, ...]:
        """The flags that are not the same in all states, in order of declaration."""
        either = self._on | self._off

        def differs(name: str) -> bool:
            self._effort.spend(either)
            values = self._plant.reader.lookup(name)
            return all((either & values[value]).satisfiable() for value in (False, True))

        return tuple(filter(differs, self._plant.flags))

    def _without_needless(self) -> list[str]:
        """The variables but what is not needed, left out greedily from the last."""
        kept = list(self._variables)
        on, off = self._on, self._off
        for name in reversed(self._variables):
            some_on, some_off = (self._diagrams.exists(states, (name,)) for states in (on, off))
            if not (some_on & some_off).satisfiable():
                on, off = some_on, some_off
                kept.remove(name)
        return kept

    def _confused(self, names: Sequence[str]) -> Function | None:
        """States of the first set with which some of the second agree in `names`; None if there are none."""
        bits = self._diagrams.bits.keys()
        variables, flags = [name for name in names if name in bits], [name for name in names if name not in bits]
        on_parts = dict(self._by_flags(self._on, flags))
        for values, off in self._by_flags(self._off, flags):
            if values in on_parts:
                common = self._projected(on_parts[values], variables) & self._projected(off, variables)
                if common.satisfiable():
                    return on_parts[values] & common
        return None

    def _differing(self, names: Sequence[str], candidates: Sequence[str]) -> list[str] | None:
        """The candidates in which two states, one of each set, differ that agree in `names`; None if no two do."""
        self._effort.spend(self._on)
        confused = self._confused(names)
        if confused is None:
            return None
        state = self._diagrams.pick(confused)
        assert state is not None
        one = self._diagrams.states(state)
        others = self._off
        differing: list[str] = []
        for name in (*names, *(each for each in reversed(candidates) if each not in names)):
            self._effort.spend(others)
            values = self._plant.reader.lookup(name)
            value = state[name] if name in state else (values[True] & one).satisfiable()
            agreeing = others & values[value]
            if agreeing.satisfiable():
                others = agreeing
            else:
                differing.append(name)
        return differing

    def _by_flags(self, states: Function, flags: Sequence[str]) -> Iterator[tuple[tuple[bool, ...], Function]]:
        """The parts of `states` in which the flags have the same values, with these."""
        if not states.satisfiable():
            return
        if not flags:
            yield (), states
            return
        holds = self._plant.reader.lookup(flags[0])[True]
        for value, part in ((False, states & ~holds), (True, states & holds)):
            for values, inner in self._by_flags(part, flags[1:]):
                yield (value, *values), inner

    def _projected(self, states: Function, names: Collection[str]) -> Function:
        return self._diagrams.exists(states, [name for name in self._diagrams.names if name not in names])
