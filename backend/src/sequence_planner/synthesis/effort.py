"""A limit to how much is computed with diagrams, counted in nodes and not in seconds, so that answers stay the same."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from sequence_planner.synthesis.diagrams import Function
from sequence_planner.synthesis.steps import Step

MOST_BITS = 300  # beyond them closures are not even begun
_SAMPLED = 64  # the nodes of every so many sets are counted


class TooMuchError(Exception):
    """The limit is reached before there is an answer."""


class Effort:
    """What may still be spent: the nodes of all sets from which steps are taken or that are compared, by samples.

    What is spent is spent of the `whole` as well, if it is a part of one.
    """

    def __init__(self, most: int, least: int = 0, whole: Effort | None = None) -> None:
        """`most` nodes are left. Whatever is done counts as `least` nodes at least."""
        self._left = most
        self._least = least
        self._whole = whole
        self._taken = 0

    def limited(self, steps: Iterable[Step]) -> list[Step]:
        """The same steps, which raise `TooMuchError` when all is spent."""
        return [_Limited(step, self) for step in steps]

    def spend(self, states: Function) -> None:
        """Count something that is done with `states`."""
        if self._taken % _SAMPLED == 0:
            self.use(max(states.node_count(), self._least) * _SAMPLED)
        self._taken += 1
        if self._whole is not None:
            self._whole.spend(states)

    def use(self, nodes: int) -> None:
        """Count what takes about as long as something is done with so many nodes."""
        self._left -= nodes
        if self._left < 0:
            raise TooMuchError


@dataclass(frozen=True)
class _Limited:
    step: Step
    effort: Effort

    @property
    def top(self) -> int:
        """The first level that it reads or writes."""
        return self.step.top

    def after(self, states: Function) -> Function:
        """Where it can lead from `states`."""
        self.effort.spend(states)
        return self.step.after(states)

    def before(self, states: Function) -> Function:
        """From where it can lead to `states`."""
        self.effort.spend(states)
        return self.step.before(states)
