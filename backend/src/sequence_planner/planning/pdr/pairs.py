"""Invariants of pairs: what is never so together, found by taking away what a tick makes so (Rintanen 1998).

To begin with no two values are together but those of the beginning. A tick from where that is so may bring others
together; what is left when none does is the strongest invariant whose clauses have two literals. Many a goal cannot be
reached for such a reason alone: two users of one thing, a place that is taken, a state that a specification forbids.
The number of pairs grows with the square of what is seen, and the number of questions much slower: one answer brings
all values of a state together.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from sequence_planner.planning.budget import Budget
from sequence_planner.planning.pdr.inquiry import Inquiry
from sequence_planner.planning.pdr.relation import Cube, Relation

# Values beyond which there are too many pairs of them.
_MOST_FACTS = 120

# Questions after which the search goes on elsewhere.
_MOST_QUESTIONS = 400

# Questions between two looks at whether the goals can still be excluded.
_LOOK = 4


def excluded_pairs(relation: Relation, beginning: Cube, budget: Budget) -> tuple[Cube, ...] | None:
    """Cubes of one or two literals, an invariant that excludes the goals; None if no such cubes do, or too many.

    Raises `SpentError`.
    """
    facts = _facts(relation)
    return _Pairs(relation, facts, beginning, budget).invariant() if len(facts) <= _MOST_FACTS else None


def never_paired(relation: Relation, beginning: Cube, budget: Budget) -> tuple[Cube, ...]:
    """All pairs of values, each of which occurs, that are never together: the strongest invariant of that kind.

    Raises `SpentError`.
    """
    return _Pairs(relation, _facts(relation), beginning, budget).strongest()


def _facts(relation: Relation) -> list[int]:
    """A literal for each value of each variable."""
    bits = Counter(literal.name for literal in relation.meanings.values())
    facts: list[int] = []
    for bit, literal in relation.meanings.items():
        facts += (bit,) if bits[literal.name] > 1 else (bit, -bit)
    return facts


class _Pairs:
    """Facts become possible one by one; only of those that are, pairs are looked at."""

    def __init__(self, relation: Relation, facts: Sequence[int], beginning: Cube, budget: Budget) -> None:
        self._relation = relation
        self._inquiry = Inquiry(relation, budget)
        self._inquiry.demand(list(relation.unfinished))
        self._inquiry.prefer([relation.reached, *relation.choices])
        self._impossible = list(facts)
        self._possible: list[int] = []
        self._apart: dict[Cube, int] = {}  # what has not come together yet, with the literals that say it does not ...
        self._meeting: dict[Cube, int] = {}  # ... before the tick, and that it does after it
        self._more = self._inquiry.fresh()  # that anything comes together of which the clauses so far do not speak
        self._inquiry.demand([relation.reached, self._more])
        self._part([(fact,) for fact in facts])
        excluded = {-literal for literal in beginning}
        self._together({fact for fact in facts if fact not in excluded})

    def invariant(self) -> tuple[Cube, ...] | None:
        """What is never together, as far as the goals are excluded by it."""
        relation, inquiry = self._relation, self._inquiry
        for question in range(_MOST_QUESTIONS):
            apart = self._apart.values()
            if question % _LOOK == 0 and inquiry.solves([relation.valid, relation.reached, *apart]):
                return None
            if not inquiry.solves([relation.valid, -self._more, *apart]):
                return self._needed()
            true = set(inquiry.model())
            if relation.reached in true:
                return None
            facts = (*self._impossible, *self._possible)
            self._together({fact for fact in facts if relation.after(fact) in true})
        return None

    def strongest(self) -> tuple[Cube, ...]:
        """The pairs that are never together, whatever the goals are."""
        relation, inquiry = self._relation, self._inquiry
        while inquiry.solves([relation.valid, -self._more, *self._apart.values()]):
            true = set(inquiry.model())
            self._together({fact for fact in (*self._impossible, *self._possible) if relation.after(fact) in true})
        return tuple(cube for cube in self._apart if len(cube) > 1)

    def _together(self, facts: set[int]) -> None:
        """All of `facts` may be so together."""
        new = [fact for fact in self._impossible if fact in facts]
        if new:
            self._impossible = [fact for fact in self._impossible if fact not in facts]
            pairs: list[Cube] = []
            for fact in new:
                name = self._relation.meanings[abs(fact)].name
                pairs += [(other, fact) for other in self._possible if self._relation.meanings[abs(other)].name != name]
                self._possible.append(fact)
            self._part(pairs)
        for cube in [cube for cube in self._apart if facts.issuperset(cube)]:
            del self._apart[cube]
            self._inquiry.demand([-self._meeting.pop(cube)])

    def _part(self, cubes: list[Cube]) -> None:
        """Take it that none of `cubes` is ever so, until one is."""
        inquiry, after = self._inquiry, self._relation.after
        for cube in cubes:
            apart, meeting = inquiry.fresh(), inquiry.fresh()
            inquiry.demand([-apart, *(-fact for fact in cube)])
            for fact in cube:
                inquiry.demand([-meeting, after(fact)])
            self._apart[cube], self._meeting[cube] = apart, meeting
        more = inquiry.fresh()
        inquiry.demand([-self._more, *(self._meeting[cube] for cube in cubes), more])
        self._more = more

    def _needed(self) -> tuple[Cube, ...]:
        """Those of the cubes that it takes to exclude the goals, and to stay excluded themselves."""
        relation, inquiry = self._relation, self._inquiry
        cubes = {apart: cube for cube, apart in self._apart.items()}
        needed: dict[Cube, None] = {}
        target = relation.reached
        while True:
            assert not inquiry.solves([relation.valid, target, *self._apart.values()])
            core = inquiry.core()
            new = [cube for apart, cube in cubes.items() if apart in core and cube not in needed]
            if not new:
                return tuple(sorted(needed))
            needed |= dict.fromkeys(new)
            target = inquiry.passing([self._meeting[cube] for cube in new])
