"""Binary decision diagrams of state sets (Bryant 1986), and their static variable order."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cached_property
from itertools import permutations

from oxidd.bcdd import BCDDFunction, BCDDManager, BCDDSubstitution

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.state_set import EVERYTHING, NOTHING, Builder, StateSet
from sequence_planner.language.types import Value

# Sets of states as binary decision diagrams (Bryant 1986).
#
# A variable is a group of bits that number the values of its domain, most significant first. Beside the bits of its
# value now it can have bits for its value afterwards. Bits that number no value are kept out by whoever makes a set:
# `valid` says which states exist, and is not part of any guard, which would spread it over all levels.

Function = BCDDFunction
Substitution = BCDDSubstitution
Values = Mapping[Value, Function]  # for each value, where it is the one
Lookup = Callable[[str], Values]

# Room for nodes and for results already computed; memory is taken as they are filled.
_MOST_NODES = 1 << 25
_CACHE = 1 << 16


# Diagrams are walked from level to level, some calls deep for each of them.
_CALLS = 4
_ROOM = 1000


class Diagrams:
    """The bits of `domains`, in the order given; those of `afterwards` have bits for a value afterwards as well.

    `cache` is how many results are kept; a small one is quicker to make. More than `most_nodes` are a `MemoryError`.
    """

    def __init__(
        self,
        domains: Mapping[str, Sequence[Value]],
        afterwards: Collection[str] = (),
        cache: int = _CACHE,
        most_nodes: int = _MOST_NODES,
    ) -> None:
        self.domains = {name: tuple(domain) for name, domain in domains.items()}
        self.names = tuple(self.domains)
        self._manager = BCDDManager(most_nodes, cache, 1)
        self.bits: dict[str, tuple[int, ...]] = {}
        self.bits_after: dict[str, tuple[int, ...]] = {}
        self.marks: dict[str, int] = {}
        self._name_of: dict[int, str] = {}
        count = 0
        for name, domain in self.domains.items():
            width = (len(domain) - 1).bit_length()
            step = 2 if name in afterwards else 1
            first = count + (step - 1)
            self.bits[name] = tuple(range(first, first + step * width, step))
            if name in afterwards:
                self.marks[name] = count
                self.bits_after[name] = tuple(bit + 1 for bit in self.bits[name])
            count = first + step * width
            self._name_of |= dict.fromkeys(self.bits[name], name)
        self._manager.add_vars(count)
        sys.setrecursionlimit(max(sys.getrecursionlimit(), _ROOM + _CALLS * count))
        self._count = count
        self._values: dict[tuple[str, bool], Values] = {}

    @property
    def true(self) -> Function:
        """Every state."""
        return self._manager.true()

    @property
    def false(self) -> Function:
        """No state."""
        return self._manager.false()

    @property
    def nodes(self) -> int:
        """The number of nodes that there are now."""
        return self._manager.approx_num_inner_nodes()

    def bit(self, number: int) -> Function:
        """Return where a bit is set."""
        return self._manager.var(number)

    def values(self, name: str) -> Values:
        """Return where the variable has each of its values."""
        return self._numbered(name, after=False)

    def values_after(self, name: str) -> Values:
        """The same of its value afterwards."""
        return self._numbered(name, after=True)

    def _numbered(self, name: str, after: bool) -> Values:
        if (name, after) not in self._values:
            bits = (self.bits_after if after else self.bits)[name]
            self._values[name, after] = {
                value: self.conjunction(
                    self._manager.var(bit) if self.digit(bits, bit, position) else self._manager.not_var(bit)
                    for bit in bits
                )
                for position, value in enumerate(self.domains[name])
            }
        return self._values[name, after]

    @staticmethod
    def digit(bits: Sequence[int], bit: int, position: int) -> bool:
        """Return whether `bit` of `bits` is set in the number `position`."""
        return bool(position >> (len(bits) - 1 - bits.index(bit)) & 1)

    def conjunction(self, functions: Iterable[Function]) -> Function:
        """Return where all of them hold."""
        together = self.true
        for function in functions:
            together &= function
        return together

    def disjunction(self, functions: Iterable[Function]) -> Function:
        """Return where one of them holds."""
        together = self.false
        for function in functions:
            together |= function
        return together

    def substitution(self, pairs: Iterable[tuple[int, Function]]) -> Substitution:
        """Functions in place of bits, all at once."""
        return BCDDSubstitution(pairs)

    def cube(self, bits: Iterable[int]) -> Function:
        """The set of bits, as quantification wants it."""
        return self.conjunction(map(self._manager.var, sorted(bits, reverse=True)))

    def bits_of(self, names: Iterable[str]) -> Function:
        """The bits of these variables."""
        return self.cube(bit for name in names for bit in self.bits[name])

    def exists(self, function: Function, names: Iterable[str]) -> Function:
        """Return where `function` holds for some values of these variables."""
        quantified = self.bits_of(names)
        return function.exists(quantified) if quantified != self.true else function

    @cached_property
    def valid(self) -> Function:
        """The states where every variable has one of its values."""
        return self.valid_of(reversed(self.names))

    def valid_of(self, names: Iterable[str]) -> Function:
        """Return where these have one of their values."""
        return self.conjunction(self.disjunction(self.values(name).values()) for name in names)

    def count(self, states: Function) -> int:
        """The exact number of states, of which all must be valid."""
        held = sum(map(len, self.bits.values()))
        return states.sat_count(self._count) >> (self._count - held)

    def states(self, state: State) -> Function:
        """The states that agree with `state`; what is unknown can have any value."""
        known = ((name, value) for name in reversed(self.names) if (value := state[name]) is not None)
        return self.conjunction(self.values(name)[value] for name, value in known) & self.valid

    def pick(self, states: Function) -> dict[str, Value] | None:
        """One of the states; None if there is none."""
        cube = (states & self.valid).pick_cube()
        return None if cube is None else self._read(cube, self.bits)

    def pick_step(self, steps: Function) -> tuple[dict[str, Value], dict[str, Value]] | None:
        """One of the steps: a state, and the values afterwards of what has bits for them; None if there is none.

        What `steps` leaves open afterwards must have a value of its own already.
        """
        cube = (steps & self.valid).pick_cube()
        return None if cube is None else (self._read(cube, self.bits), self._read(cube, self.bits_after))

    def _read(self, cube: Sequence[bool | None], numbers: Mapping[str, Sequence[int]]) -> dict[str, Value]:
        found: dict[str, Value] = {}
        for name, bits in numbers.items():
            position = 0
            for bit in bits:
                position = 2 * position + (cube[bit] is True)
            found[name] = self.domains[name][position]
        return found

    def support(self, function: Function) -> frozenset[str]:
        """The variables that `function`, which is about values now only, depends on."""
        return frozenset(self._name_of[bit] for bit in self.support_bits(function))

    def support_bits(self, function: Function) -> frozenset[int]:
        """The bits that `function` depends on."""
        found: set[int] = set()
        seen: set[Function] = set()
        pending = [function]
        while pending:
            node = pending.pop()
            if node in seen or (cofactors := node.cofactors()) is None:
                continue
            seen.add(node)
            bit = node.node_var()
            assert bit is not None
            found.add(bit)
            pending.extend(cofactors)
        return frozenset(found)

    def top(self, functions: Iterable[Function], bits: Iterable[int] = ()) -> int:
        """The first level that any of `functions` or `bits` stands on; the number of levels if there is none."""
        levels = [level for function in functions if (level := function.node_level()) is not None]
        return min([*levels, *bits, self._count])

    # Sets of states for others, and from them.

    def exported(self, states: Function, names: Iterable[str] | None = None) -> StateSet:
        """The set over `names`, or else over what it depends on; in the order of the bits."""
        wanted = set(self.support(states) if names is None else names)
        over = tuple(name for name in self.names if name in wanted)
        axis = {name: position for position, name in enumerate(over)}
        builder = Builder()
        memo: dict[Function, int] = {}

        def reference(node: Function) -> int:
            bit = node.node_var()
            if bit is None:
                return EVERYTHING if node.valid() else NOTHING
            if node not in memo:
                name = self._name_of[bit]
                memo[node] = builder.node(axis[name], tuple(map(reference, self._by_value(node, name))))
            return memo[node]

        return builder.whole(over, tuple(self.domains[name] for name in over), reference(states))

    def imported(self, states: StateSet) -> Function:
        """The set that `states` says, not only of valid states. Variables and values that are not among these are left
        out, whatever they are.
        """
        functions = [self.false, self.true]
        places: dict[
            tuple[int, tuple[int, ...]], Function
        ] = {}  # where a variable has a value at one of these positions
        for axis, children in states.nodes:
            if (name := states.names[axis]) not in self.bits:
                functions.append(self.disjunction(functions[child] for child in set(children)))
                continue
            at: dict[int, list[int]] = {}
            for position, child in enumerate(children):
                if child != NOTHING:
                    at.setdefault(child, []).append(position)
            found = self.false
            for child, positions in at.items():
                key = axis, tuple(positions)
                if key not in places:
                    values = self.values(name)
                    has = (states.domains[axis][position] for position in positions)
                    places[key] = self.disjunction(values[value] for value in has if value in values)
                found |= places[key] & functions[child]
            functions.append(found)
        return functions[states.root]

    def _by_value(self, node: Function, name: str) -> list[Function]:
        """Return what is left of `node`, which tests no variable before this one, at each of its values."""
        left = [node]
        for bit in self.bits[name]:
            split: list[Function] = []
            for each in left:
                cofactors = each.cofactors() if each.node_var() == bit else None
                split += (each, each) if cofactors is None else reversed(cofactors)
            left = split
        return left[: len(self.domains[name])]


# A static order of variables for decision diagrams: those that are read and written together stand close together.
#
# FORCE (Aloul et al. 2003) moves each variable to the centre of gravity of what it occurs in; then all orders within a
# window that slides over the result are tried. What is made small is the sum over all groups of the distance between
# their first and last variable (Siminiceanu & Ciardo 2006), as long as that helps.

_MOST_ROUNDS = 50
_WINDOW = 4
_MOST_PASSES = 10
_FAR_MORE = 2  # times as often as the median

Groups = Mapping[tuple[int, ...], int]  # positions of variables in order of declaration, and how often they occur


def ordered(names: Sequence[str], groups: Iterable[Collection[str]]) -> tuple[str, ...]:
    """`names` in an order in which the members of each of `groups` are close together.

    Names in groups that are not among `names` are ignored.
    """
    number = {name: position for position, name in enumerate(names)}
    counted: Counter[tuple[int, ...]] = Counter()
    for group in groups:
        members = tuple(sorted(number[name] for name in set(group) if name in number))
        if len(members) > 1:
            counted[members] += 1
    order = _force(list(range(len(names))), counted)
    return tuple(names[position] for position in _slid(order, counted))


def hubs_first(order: Sequence[str], groups: Iterable[Collection[str]]) -> tuple[str, ...]:
    """`order` with the variables that occur in far more groups than most do before all others that they occur with.

    They say which of many others something is about: a pose, of the bolts there. Below all of these, they would have to
    be told apart by every combination of their values.
    """
    distinct = set(map(frozenset, groups))
    occurs = Counter(name for group in distinct for name in group)
    usual = sorted(occurs[name] for name in order)[len(order) // 2] if order else 0
    hubs = [name for name in order if occurs[name] > _FAR_MORE * usual]
    place = {name: (position, 1, 0) for position, name in enumerate(order) if name not in hubs}
    first = {
        hub: min((place[name][0] for group in distinct if hub in group for name in group if name in place), default=0)
        for hub in hubs
    }
    place |= {hub: (first[hub], 0, number) for number, hub in enumerate(hubs)}
    return tuple(sorted(order, key=place.__getitem__))


def _span(order: Sequence[int], groups: Groups) -> int:
    return _cost(order, 0, [0] * len(order), groups)


def _places(order: Sequence[int]) -> list[int]:
    place = [0] * len(order)
    for position, member in enumerate(order):
        place[member] = position
    return place


def _force(order: list[int], groups: Groups) -> list[int]:
    """The best order that is met while the variables are drawn together."""
    best, least = order, _span(order, groups)
    for _ in range(_MOST_ROUNDS):
        place = _places(order)
        pulled: list[float] = [0.0] * len(order)
        weights: list[int] = [0] * len(order)
        for members, weight in groups.items():
            centre = sum(place[member] for member in members) / len(members)
            for member in members:
                pulled[member] += weight * centre
                weights[member] += weight
        following = sorted(order, key=lambda m: (pulled[m] / weights[m] if weights[m] else float(place[m]), place[m]))
        if following == order:
            break
        order = following
        if (span := _span(order, groups)) < least:
            best, least = order, span
    return best


def _slid(order: list[int], groups: Groups) -> list[int]:
    """`order` with the variables within each window exchanged as long as that makes it better."""
    touching: list[list[tuple[tuple[int, ...], int]]] = [[] for _ in order]
    for members, weight in groups.items():
        for member in members:
            touching[member].append((members, weight))
    for _ in range(_MOST_PASSES):
        improved = False
        for begin in range(len(order) - 1):
            window = order[begin : begin + _WINDOW]
            near = dict(each for member in window for each in touching[member])
            place = _places(order)
            costs = {each: _cost(each, begin, place, near) for each in permutations(window)}
            chosen = min(costs, key=costs.__getitem__)
            if costs[chosen] < costs[tuple(window)]:
                order[begin : begin + _WINDOW] = chosen
                improved = True
        if not improved:
            break
    return order


def _cost(arranged: Sequence[int], begin: int, place: list[int], near: Groups) -> int:
    """Return how far the groups `near` are stretched with a window from `begin` on arranged so; `place` is changed."""
    for position, member in enumerate(arranged, begin):
        place[member] = position
    total = 0
    for members, weight in near.items():
        places = [place[member] for member in members]
        total += weight * (max(places) - min(places))
    return total
