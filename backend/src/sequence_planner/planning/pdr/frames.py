"""The search for an invariant, in the form of Een, Mishchenko and Brayton (2011) of IC3 (Bradley 2011).

Frame k is a set of states that holds all that k ticks can reach. A state in the last frame from which one tick reaches
the goals is traced back; where nothing leads to it from the frame before, it is excluded, together with as many states
like it as that argument covers. When a frame excludes no more than the next one, it is an invariant.
"""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Iterable
from itertools import count
from math import inf

from sequence_planner.planning.budget import Budget
from sequence_planner.planning.pdr.inquiry import Inquiry
from sequence_planner.planning.pdr.relation import Cube, Relation
from sequence_planner.planning.pdr.steps import Step

# Values of one variable that are tried in vain before the others are left as they are.
_PATIENCE = 3

# Cubes that may be excluded so that a literal can be left out of another one.
_HINDRANCES = 1


class DepthError(Exception):
    """More frames would have to be looked at."""


class Frames:
    """Decides whether the goals of `relation` can be reached from the states of `beginning`.

    It looks at no more than `depth` frames.
    """

    def __init__(self, relation: Relation, beginning: Cube, budget: Budget, depth: float = inf) -> None:
        self._relation = relation
        self._budget = budget
        self._depth = depth
        self._beginning = beginning
        self._outside = frozenset(-literal for literal in beginning)
        self._frames: list[set[Cube]] = []  # the cubes that each frame, and all before it, exclude
        self._levels: list[int] = []
        self._seen: Counter[str] = Counter()
        self._witnesses: dict[Cube, Cube] = {}  # for cubes, states from which a tick led there when last asked
        self._turn = count()
        self._renew()

    def decide(self) -> Step | tuple[Cube, ...]:
        """A way to the goals, or the cubes that an invariant excludes. Raises `SpentError` and `DepthError`."""
        self._extend()
        if (step := self._last_step()) is not None:
            return step
        while True:
            if len(self._frames) > self._depth:
                raise DepthError
            self._extend()
            while (step := self._last_step()) is not None:
                if (first := self._traced_back(step)) is not None:
                    return first
            if (invariant := self._pushed()) is not None:
                return invariant

    def member(self, cube: Cube) -> list[int] | None:
        """A model with a state of `cube` to begin in."""
        return self._inquiry.model() if self._inquiry.solves([*self._beginning, *cube]) else None

    def _extend(self) -> None:
        self._frames.append(set())
        self._levels.append(self._inquiry.fresh())

    def _last_step(self) -> Step | None:
        """A step from the last frame to the goals."""
        relation = self._relation
        if not self._inquiry.solves([relation.valid, relation.reached, *self._inside(len(self._frames) - 1)]):
            return None
        return self._lifted([relation.reached], None)

    def _traced_back(self, last: Step) -> Step | None:
        """Excludes the cube of `last` from the last frame; if that cannot be done, the first step of a way."""
        if self._begins(last.cube):
            return last
        top = len(self._frames) - 1
        pending = [(top, next(self._turn), last)]
        while pending:
            level, _, step = pending[0]
            if self._excluded(step.cube, level):
                heapq.heappop(pending)
                continue
            smaller = self._unreached(step.cube, level)
            if smaller is None:
                before = self._lifted([self._relation.after(literal) for literal in step.cube], step)
                if level == 1 or self._begins(before.cube):
                    return before
                heapq.heappush(pending, (level - 1, next(self._turn), before))
                continue
            heapq.heappop(pending)
            level = self._exclude(self._generalised(smaller, level), level)
            if level < top:
                heapq.heappush(pending, (level + 1, next(self._turn), step))
        return None

    def _exclude(self, cube: Cube, level: int) -> int:
        """Exclude `cube` from the latest frame possible, and all before it."""
        while level < len(self._frames) - 1 and self._unreached(cube, level + 1) is not None:
            level += 1
        literals = set(cube)
        for frame in self._frames[1 : level + 1]:
            frame.difference_update([other for other in frame if literals.issubset(other)])
        self._frames[level].add(cube)
        self._inquiry.demand([-self._levels[level], *(-literal for literal in cube)])
        self._seen.update({self._relation.meanings[abs(literal)].name for literal in cube})
        return level

    def _unreached(self, cube: Cube, level: int) -> Cube | None:
        """A part of `cube` none of whose states is reached from another state in the frame before, if there is one.

        With None, the solver has a model of a tick into `cube`.
        """
        relation = self._relation
        passing = self._passing([-literal for literal in cube])
        into = {literal: relation.after(literal) for literal in cube}
        assumptions = [relation.valid, passing, *self._inside(level - 1), *into.values()]
        if self._inquiry.solves(assumptions):
            return None
        core = self._inquiry.core()
        found: dict[int, int] = {}
        for literal, after in into.items():
            if after in core:
                found.setdefault(after, literal)
        smaller = tuple(found.values())
        if not self._begins(smaller):
            return smaller
        apart = next((literal for literal in cube if literal in self._outside), None)
        return cube if apart is None else (*smaller, apart)

    def _generalised(self, cube: Cube, level: int, hindrances: int = _HINDRANCES) -> Cube:
        """A part of `cube` from which nothing more can be left out; what others speak of is kept for longer."""
        subjects = {literal: self._relation.meanings[abs(literal)].name for literal in cube}
        several = Counter(subjects.values())
        for subject in sorted(several, key=lambda subject: self._seen[subject]):
            whole = {literal for literal in cube if subjects[literal] == subject}
            shorter = self._without(cube, whole, level, hindrances)
            if shorter is cube and several[subject] > 1:
                failures = 0
                for literal in sorted(whole, reverse=True):
                    before = len(cube)
                    cube = self._without(cube, {literal}, level, hindrances)
                    failures = failures + 1 if len(cube) == before else 0
                    if failures == _PATIENCE:
                        break
            cube = shorter if len(shorter) < len(cube) else cube
        return cube

    def _without(self, cube: Cube, literals: set[int], level: int, hindrances: int) -> Cube:
        """A part of `cube` without `literals`, or all of it.

        Up to so many `hindrances`, cubes from which the part is reached, are excluded first if nothing leads to them
        (Hassan, Bradley and Somenzi 2013).
        """
        shorter = tuple(other for other in cube if other not in literals)
        if len(shorter) == len(cube) or not shorter or self._begins(shorter):
            return cube
        while (smaller := self._unreached(shorter, level)) is None:
            if level == 1 or hindrances == 0:
                return cube
            hindrances -= 1
            hindrance = self._lifted([self._relation.after(literal) for literal in shorter], None).cube
            unreached = None if self._begins(hindrance) else self._unreached(hindrance, level - 1)
            if unreached is None:
                return cube
            self._exclude(self._generalised(unreached, level - 1, hindrances=0), level - 1)
        return smaller

    def _pushed(self) -> tuple[Cube, ...] | None:
        """Exclude from each frame what the one before it cannot reach; the invariant, if two have become equal."""
        relation = self._relation
        for level in range(1, len(self._frames) - 1):
            for cube in sorted(self._frames[level]):
                witness = self._witnesses.get(cube)
                if witness is not None and not self._excluded(witness, level):
                    continue
                after = [relation.after(literal) for literal in cube]
                if self._inquiry.solves([relation.valid, *self._inside(level), *after]):
                    self._witnesses[cube] = self._state()
                else:
                    self._frames[level].discard(cube)
                    self._frames[level + 1].add(cube)
                    self._inquiry.demand([-self._levels[level + 1], *(-literal for literal in cube)])
            if not self._frames[level]:
                return tuple(sorted(set().union(*self._frames[level + 1 :])))
        return None

    def _lifted(self, targets: list[int], following: Step | None) -> Step:
        """The step of the solver's model, from all states whose likeness to its first state is what it takes."""
        relation = self._relation
        model = self._inquiry.model()
        state = relation.state(model)
        oracles = {bit if model[bit - 1] > 0 else -bit: name for name, bit in relation.oracles}
        effects = [name for name, choice in relation.effects.items() if model[choice - 1] > 0]
        starts = [name for name, choice in relation.starts if model[choice - 1] > 0]
        choices = [choice if model[choice - 1] > 0 else -choice for choice in relation.choices]
        passing = self._passing([-relation.valid, *(-target for target in targets)])
        assert not self._inquiry.solves([passing, *choices, *state])
        core = self._inquiry.core()
        cube = tuple(literal for literal in state if literal in core)
        needed = frozenset(name for literal, name in oracles.items() if literal in core)
        return Step(cube, tuple(effects), tuple(starts), needed, following)

    def _begins(self, cube: Cube) -> bool:
        """Whether a run can begin in `cube`, which is not empty."""
        if not self._outside.isdisjoint(cube):
            return False
        return not self._relation.free_flags or self._inquiry.solves([*self._beginning, *cube])

    def _state(self) -> Cube:
        """The state before the tick in the solver's model."""
        return tuple(self._relation.state(self._inquiry.model()))

    def _excluded(self, cube: Cube, level: int) -> bool:
        literals = set(cube)
        return any(literals.issuperset(other) for frame in self._frames[level:] for other in frame)

    def _inside(self, level: int) -> Iterable[int]:
        return self._levels[level:] if level else self._beginning

    def _passing(self, clause: list[int]) -> int:
        if self._inquiry.worn:
            self._renew()
        return self._inquiry.passing(clause)

    def _renew(self) -> None:
        self._inquiry = Inquiry(self._relation, self._budget)
        self._levels = [self._inquiry.fresh() for _ in self._frames]
        for level, frame in zip(self._levels, self._frames, strict=True):
            for cube in frame:
                self._inquiry.demand([-level, *(-literal for literal in cube)])
