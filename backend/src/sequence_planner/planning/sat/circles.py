"""Orders of names some of which must stand before others, also where these demands form circles."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, MutableMapping

Before = MutableMapping[str, dict[str, None]]  # for each name those that must stand before it


def linear(before: Mapping[str, Collection[str]]) -> Iterator[str]:
    """Every name after those that must stand before it, where each occurs once; the members of a circle are repeated.

    Without some of its members a circle is none. In an order of starts, each of which is taken once, at most all of
    these occur, one by one, and between two of them there is a part of an order of the others: so all others, in order,
    and those by turns are enough.
    """
    for circle in circles(before):
        if len(circle) == 1:
            yield circle[0]
            continue
        breaking = _breaking(before, circle)
        rest = [name for (name,) in circles(_within(before, [name for name in circle if name not in breaking]))]
        for _ in breaking:
            yield from rest
            yield from breaking
        yield from rest


def circles(before: Mapping[str, Collection[str]]) -> list[tuple[str, ...]]:
    """The sets of names that must each stand before all the others of it, in order; most are of one name.

    The strongly connected components of Tarjan (1972).
    """
    numbers: dict[str, int] = {}
    lowest: dict[str, int] = {}
    open_: dict[str, None] = {}
    found: list[tuple[str, ...]] = []
    for root in before:
        pending = [] if root in numbers else [(root, iter(before[root]))]
        while pending:
            name, earlier = pending[-1]
            if name not in numbers:
                numbers[name] = lowest[name] = len(numbers)
                open_[name] = None
            for other in earlier:
                if other not in numbers:
                    pending.append((other, iter(before[other])))
                    break
                if other in open_:
                    lowest[name] = min(lowest[name], numbers[other])
            else:
                pending.pop()
                if pending:
                    parent = pending[-1][0]
                    lowest[parent] = min(lowest[parent], lowest[name])
                if lowest[name] == numbers[name]:
                    members = [each for each in open_ if numbers[each] >= numbers[name]]
                    for each in members:
                        del open_[each]
                    found.append(tuple(members))
    return found


def _breaking(before: Mapping[str, Collection[str]], circle: Collection[str]) -> list[str]:
    """Members of a circle without which the others are in none: by turns the one with the most demands."""
    breaking: list[str] = []
    left = _within(before, circle)
    while caught := [each for each in circles(left) if len(each) > 1]:
        breaking += [_busiest(_within(left, members)) for members in caught]
        left = _within(before, [name for name in circle if name not in breaking])
    return breaking


def _busiest(before: Mapping[str, Collection[str]]) -> str:
    later = {name: sum(name in earlier for earlier in before.values()) for name in before}
    return max(before, key=lambda name: len(before[name]) * later[name])


def _within(before: Mapping[str, Collection[str]], names: Collection[str]) -> dict[str, list[str]]:
    inside = frozenset(names)
    return {name: [other for other in before[name] if other in inside] for name in names}
