"""Plans held against the reference tick: none is used that does not replay, none followed that no longer does.

A plan counts on the environment's help, and two kinds of help are told apart. *Exactly*, each effect happens in the
tick in which the plan has it, however long it must tarry for that. *Eagerly*, all that can happen happens at once, as
with devices that carry on without asking; a start that reaches its goals only if some device is slow is a gamble.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from sequence_planner.automaton.automaton import Automaton, Effect, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import (
    apply_effects,
    effect_writes,
    finish,
    supervised_start,
    synchronise,
)
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.problem import ORDINARY, Circumstances, Goal, PlanTick

# Nodes an eager search may visit: what is followed is looked at in every tick, and a tick must not be held up.
LOOKAHEAD = 400


class _Node(Immutable):
    """A moment after step 3 or a start, what is left of an order, and what has been started in this tick."""

    state: State
    published: State
    goals: Goals
    order: tuple[str, ...]
    begun: frozenset[str]


class Replay(Immutable):
    """Replays plans of one automaton under one supervisor. `lookahead` does the same for what runs, and is fast."""

    automaton: Automaton
    supervisor: Supervisor
    circumstances: Circumstances = ORDINARY

    def exactly(
        self, state: State, published: State, goals: Iterable[Goal], now: Sequence[str], ticks: Sequence[PlanTick]
    ) -> bool:
        """Return whether the starts `now` in the tick under way, then `ticks` as they are written, reach `goals`.

        `state` is one after step 3 or a start; `published` has the outputs as last published.
        """
        effects = {effect.name: effect for effect in self._expected}
        current = self._started(published, state, missing(goals, state), now)
        for tick in ticks:
            if current is None or not effects.keys() >= set(tick.effects):
                return False
            sensed = apply_effects(current[0], [effects[name] for name in tick.effects])
            if sensed is None:
                return False
            after = self._settled(sensed)
            left = settled(current[1], after) if self._allowed(after) else None
            current = None if left is None else self._started(current[0], after, left, tick.starts)
        return current is not None and not current[1]

    def eagerly(self, state: State, published: State, goals: Iterable[Goal], order: Sequence[str]) -> bool:
        """Return whether `order`, each start taken now or later, reaches `goals` when all that can happen happens at
        once.

        `state` is one after step 3 or a start; `published` has the outputs as last published.
        """
        return self._reaches(_Node(state, published, missing(goals, state), tuple(order), frozenset()))

    def still_reaches(
        self, state: State, published: State, goals: Iterable[Goal], order: Sequence[str], ticks: Sequence[PlanTick]
    ) -> bool:
        """Return whether there is still a timing, of ours or of the environment, in which `order` reaches `goals`.

        `ticks` is the rest of the plan as it was made, which holds the last of `order`.
        """
        return self.eagerly(state, published, goals, order) or self.exactly(
            state, published, goals, starts_now(order, ticks), ticks
        )

    def may_go_on(
        self,
        before: State,
        after: State,
        published: State,
        goals: Iterable[Goal],
        order: Sequence[str],
        ticks: Sequence[PlanTick],
    ) -> bool:
        """Return whether a start that leads from `before` to `after` leaves `order` able to reach what then are the
        `goals`.

        As long as something can still happen by itself, a start that needs a device to be slow is not taken.
        """
        if self.eagerly(after, published, goals, order):
            return True
        return not self._everything(before) and self.exactly(after, published, goals, starts_now(order, ticks), ticks)

    def _reaches(self, root: _Node) -> bool:
        """Depth-first over starting the first of the order now, or waiting a tick."""
        reached: set[object] = set()
        pending = [root]
        outputs = sorted(self.automaton.outputs)
        for _ in range(LOOKAHEAD):
            if not pending:
                return False
            node = pending.pop()
            if not node.goals:
                return True  # what is left of the order has become needless
            published = tuple(node.published[name] for name in outputs)
            repeated = node.begun.intersection(node.order)
            key = (tuple(node.state.values()), published, node.order, node.goals, repeated)
            if key not in reached:
                reached.add(key)
                pending += [each for each in (self._waited(node), self._after_start(node)) if each is not None]
        return False

    def _waited(self, node: _Node) -> _Node | None:
        later = self._settled(apply_effects(node.state, self._everything(node.state)) or node.state)
        goals = settled(node.goals, later) if self._allowed(later) else None
        return None if goals is None else _Node(later, node.state, goals, node.order, frozenset())

    def _after_start(self, node: _Node) -> _Node | None:
        if not node.order or node.order[0] in node.begun:
            return None  # an ability starts once in a tick
        name, *rest = node.order
        after = self._started(node.published, node.state, node.goals, (name,))
        return None if after is None else _Node(after[0], node.published, after[1], tuple(rest), node.begun | {name})

    def _started(
        self, published: State, state: State, goals: Goals, names: Sequence[str]
    ) -> tuple[State, Goals] | None:
        if len(set(names)) < len(names):
            return None  # an ability starts once in a tick
        for name in names:
            ability = self.automaton.abilities[name]
            if self.circumstances.bars(ability):
                return None
            after = supervised_start(self.automaton, self.supervisor, published, state, ability)
            left = None if after is None or not self._allowed(after) else moved(goals, after)
            if after is None or left is None:
                return None
            state, goals = after, left
        return state, goals

    def _allowed(self, state: State) -> bool:
        """Return whether nothing that shall be avoided holds in `state`, or is left open by unknown values."""
        return all(evaluate(avoided, state) is False for avoided in self.circumstances.avoid)

    @property
    def _expected(self) -> list[Effect]:
        """The effects that are counted on."""
        offline = self.circumstances.offline
        return [effect for effect in self.automaton.effects if not effect.fault and effect.resource not in offline]

    def _settled(self, sensed: State) -> State:
        """Steps 2 and 3."""
        return synchronise(self.automaton, finish(self.automaton, sensed).state)

    def _everything(self, state: State) -> list[Effect]:
        """A largest set of compatible effects enabled in `state`, earlier ones first."""
        chosen: list[Effect] = []
        together: dict[str, Value] = {}
        for effect in self._expected:
            written = effect_writes(effect, state)
            if not written or all(state[name] == value for name, value in written.items()):
                continue
            if all(together.get(name, value) == value for name, value in written.items()):
                chosen.append(effect)
                together |= written
        return chosen


def missing(goals: Iterable[Goal], state: State) -> Goals:
    """The goals that are not met already; those that are need no plan.

    One with a formula is met after step 3 only: the next decides whether its formula is satisfied.
    """
    return tuple(goal for goal in goals if goal.local != TRUE or not holds(goal.predicate, state))


def starts_now(order: Sequence[str], ticks: Sequence[PlanTick]) -> Sequence[str]:
    """The starts of `order` that belong into the tick under way: all but those of `ticks`."""
    return order[: len(order) - sum(len(tick.starts) for tick in ticks)]
