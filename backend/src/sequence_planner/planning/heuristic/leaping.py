"""Leaps: as much of a relaxed plan as can really be carried out, at once, as in YAHSP (Vidal 2004)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from sequence_planner.planning.heuristic.estimate import Step
from sequence_planner.planning.heuristic.graph import Kind
from sequence_planner.planning.heuristic.space import Move, Position, Space

_MOST_WAITS = 40  # in one leap


def leap(space: Space, position: Position, steps: Iterable[Step]) -> tuple[Position, tuple[Move, ...]]:
    """Where `position` gets when the relaxed plan's starts are taken as they can be, and what happens meanwhile."""
    moves: list[Move] = []
    starts = {step.operator[1]: step for step in steps if step.operator[0] is Kind.START}
    effects = [step.operator[1] for step in steps if step.operator[0] is Kind.EFFECT]
    waits = 0
    while position.goals:
        started = _start(space, position, list(starts.values()))
        if started is not None:
            position, name = started
            moves.append(name)
            del starts[name]
            continue
        if waits == _MOST_WAITS:
            break
        happening = space.everything(position, effects)
        later = space.wait(position, happening)
        if later is None or later.key == position.key:
            break
        position = later
        moves.append(happening)
        waits += 1
    return position, tuple(moves)


def _start(space: Space, position: Position, steps: Sequence[Step]) -> tuple[Position, str] | None:
    """The position after one of the starts, first those that keep the fewest of the others from starting now."""
    if not position.begun:
        return None
    ready = [step for step in steps if position.run.may_start(step.operator[1])]
    needed = Counter(need for step in ready for need in step.needs)
    variables = Counter(name for step in ready for name, _ in step.needs)

    def threats(step: Step) -> int:
        """How many facts that others need it takes away."""
        own = dict(step.needs)
        return sum(
            variables[name] - needed[name, value] - (name in own and own[name] != value) for name, value in step.brings
        )

    for step in sorted(ready, key=threats):
        after = space.start(position, step.operator[1])
        if after is not None:
            return after, step.operator[1]
    return None
