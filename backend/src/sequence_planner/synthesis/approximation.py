"""More than what is reached, where all of it would take too long: by parts, each of what a few variables can be.

The parts are found together: what one of them may be bears on what becomes of the others ("machine by machine": Cho,
Hachtel, Macii, Plessier and Somenzi 1996). Their composition has the initial states, and no step leads out of it, so it
has everything that is reached.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from sequence_planner.synthesis.diagrams import Diagrams, Function
from sequence_planner.synthesis.steps import Step


def composed(
    diagrams: Diagrams, initial: Function, steps: Sequence[Step], groups: Iterable[Collection[str]], within: Function
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
