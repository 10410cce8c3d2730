"""A static order of variables for decision diagrams: those that are read and written together stand close together.

FORCE (Aloul et al. 2003) moves each variable to the centre of gravity of what it occurs in; then all orders within a
window that slides over the result are tried. What is made small is the sum over all groups of the distance between
their first and last variable (Siminiceanu & Ciardo 2006), as long as that helps.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import permutations

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
    """How far the groups `near` are stretched with a window from `begin` on arranged so; `place` is changed."""
    for position, member in enumerate(arranged, begin):
        place[member] = position
    total = 0
    for members, weight in near.items():
        places = [place[member] for member in members]
        total += weight * (max(places) - min(places))
    return total
