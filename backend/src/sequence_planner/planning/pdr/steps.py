"""Ways to the goals, step by step."""

from __future__ import annotations

from sequence_planner.immutable import Immutable
from sequence_planner.planning.pdr.relation import Cube


class Step(Immutable):
    """From each state of `cube` a tick with these choices leads into the cube that follows, or reaches the goals.

    `oracles` are the inputs that it takes.
    """

    cube: Cube
    effects: tuple[str, ...]
    starts: tuple[str, ...]
    oracles: frozenset[str]
    following: Step | None

    @property
    def run(self) -> list[Step]:
        """This step and those that follow."""
        steps, step = [self], self.following
        while step is not None:
            steps.append(step)
            step = step.following
        return steps
