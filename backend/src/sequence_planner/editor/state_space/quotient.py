"""A state space folded by chosen variables: a node for each combination of their values, arrows by what leads there."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from typing import Final

from sequence_planner.automaton.automaton import Effect, Kind, State, reads, target
from sequence_planner.automaton.tick import synchronise
from sequence_planner.editor.state_space.reached import Reached, before_through
from sequence_planner.language.syntax import variables
from sequence_planner.language.types import Value
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.transition_relation import Flip, Reaction, TransitionStep, same

MOST_NODES: Final = 300
MOST_ARROWS: Final = 3000  # pairs of nodes

Node = tuple[Value, ...]  # of the chosen variables, in their order


class CauseKind(StrEnum):
    """The kinds of what leads from one node to another."""

    START = "start"
    EFFECT = "effect"  # of a device or a person, or a fault
    FINISH = "finish"
    ACTIVITY = "activity"  # an operation becomes active, or is so no longer
    TOGETHER = "together"  # several effects in one tick


@dataclass(frozen=True)
class StateCause:
    """One thing that can happen: a start or finish of an ability, an effect, or what becomes of an operation."""

    kind: CauseKind
    name: str


@dataclass(frozen=True)
class Leading:
    """That a `cause` leads from a node to another, in one of its states the `example`.

    The supervisor has `allowed` a start in some of its states; in others, safe ones, it is `kept` back, as it would
    lead out of the safe ones.
    """

    source: Node
    sink: Node
    cause: StateCause
    example: State
    allowed: bool = True
    kept: bool = False


@dataclass(frozen=True)
class FoldedStates:
    """What stands behind a node: how many states, whether a run may `begin` in one of them, how many of them violate a
    specification, are not safe, are `stuck` (None where that is not known) and have a start that is kept back (`cut`).
    """

    values: Node
    states: int
    initial: bool
    present: bool
    violated: Mapping[str, int]
    forbidden: int
    unsafe: int
    stuck: int | None
    cut: int


class Quotient:
    """The states of `space` folded by the variables `chosen`."""

    def __init__(self, space: Reached, chosen: Sequence[str]) -> None:
        self._space = space
        self._plant = space.plant
        self._diagrams = space.plant.diagrams
        self.chosen = tuple(chosen)
        self._others = [name for name in self._diagrams.names if name not in self.chosen]

    @property
    def states(self) -> int:
        """The number of states."""
        return self._diagrams.count(self._space.reached)

    def number_of_nodes(self, chosen: Sequence[str] | None = None) -> int:
        """The number of nodes, or of those that there are with other variables chosen."""
        names = self.chosen if chosen is None else chosen
        others = [name for name in self._diagrams.names if name not in names]
        return self._diagrams.exported(self._diagrams.exists(self._space.reached, others), names).count

    def folded_nodes(self, present: State, cut: Sequence[str]) -> list[FoldedStates]:
        """All nodes, each after those through which it is soonest reached."""
        diagrams, space = self._diagrams, self._space
        specifications = {
            each.title: self._plant.where(each.forbidden)
            for each in self._plant.automaton.specifications.values()
            if self._plant.says((each.forbidden,))
        }
        stuck = space.stuck() if space.has_all_variables else None
        now, kept, unsafe = diagrams.states(present), space.cut(cut), space.unsafe
        forbidden = diagrams.disjunction(specifications.values())
        found: list[FoldedStates] = []
        for node in self._in_order():
            inside = self._inside(node)
            found.append(
                FoldedStates(
                    values=node,
                    states=diagrams.count(inside),
                    initial=(inside & self._plant.initial).satisfiable(),
                    present=(inside & now).satisfiable(),
                    violated={
                        title: count
                        for title, where in specifications.items()
                        if (count := diagrams.count(inside & where))
                    },
                    forbidden=diagrams.count(inside & forbidden),
                    unsafe=diagrams.count(inside & unsafe),
                    stuck=None if stuck is None else diagrams.count(inside & stuck),
                    cut=diagrams.count(inside & kept),
                )
            )
        return found

    @cached_property
    def leading(self) -> list[Leading]:
        """All single things that lead from one node to another."""
        return [*self._starting(), *self._happening()]

    @cached_property
    def pairs(self) -> frozenset[tuple[Node, Node]]:
        """Each two nodes of which one follows on the other in one step, whatever happens in it."""
        found = {(each.source, each.sink) for each in self.leading}
        for step in self._plant.uncontrollable:
            if isinstance(step, Reaction):
                for node in self._led_from(step):
                    found |= {(node, sink) for sink in self._folded(step.after(self._inside(node))) if sink != node}
        return frozenset(found)

    @cached_property
    def pairs_together(self) -> frozenset[tuple[Node, Node]]:
        """The pairs to which only several things lead that happen in one tick."""
        return self.pairs - {(each.source, each.sink) for each in self.leading}

    def node_of(self, state: State) -> Node | None:
        """The node of a state; None where one of its values is not known."""
        values = tuple(value for name in self.chosen if (value := state[name]) is not None)
        return values if len(values) == len(self.chosen) else None

    # Nodes.

    @cached_property
    def _members(self) -> list[Node]:
        return self._folded(self._space.reached)

    def _in_order(self) -> list[Node]:
        """The nodes breadth first from where a run may begin; of an overestimate without what nothing leads to."""
        following: dict[Node, list[Node]] = {}
        for source, sink in sorted(self.pairs, key=str):
            following.setdefault(source, []).append(sink)
        begin = self._folded(self._space.begin & self._space.reached)
        seen, pending = dict.fromkeys(begin), deque(begin)
        while pending:
            for sink in following.get(pending.popleft(), ()):
                if sink not in seen:
                    seen[sink] = None
                    pending.append(sink)
        return list(seen)

    def _folded(self, states: Function) -> list[Node]:
        """The nodes that some states stand behind."""
        projected = self._diagrams.exported(self._diagrams.exists(states, self._others), self.chosen)
        return [tuple(member[name] for name in self.chosen) for member in projected.members()]

    def _inside(self, node: Node) -> Function:
        """The states that are reached behind a node."""
        if node not in self._known:
            values = dict(zip(self.chosen, node, strict=True))
            here = self._diagrams.conjunction(self._diagrams.values(name)[value] for name, value in values.items())
            self._known[node] = here & self._space.reached
        return self._known[node]

    @cached_property
    def _known(self) -> dict[Node, Function]:
        return {}

    def _state(self, states: Function) -> State:
        """One of some states, with its flags; what the diagrams do not have is as in the beginning."""
        automaton = self._plant.automaton
        return synchronise(automaton, {**automaton.initial_valuation, **(self._diagrams.pick(states) or {})})

    # Arrows. Only what writes a chosen variable, or makes a finish do so, leads to another node.

    def _led_from(self, step: TransitionStep, where: Function | None = None) -> list[Node]:
        """The nodes from some states of which a step can be taken."""
        states = self._space.reached & step.before(self._diagrams.valid)
        return self._folded(states if where is None else states & where)

    def _starting(self) -> Iterator[Leading]:
        for name, steps in self._plant.starts.items():
            ability = self._plant.automaton.abilities[name]
            if not any(target(action) in self.chosen for action in ability.start_actions):
                continue
            found: dict[tuple[Node, Node], Leading] = {}
            for step in steps:
                for node in self._led_from(step):
                    for each in self._started(StateCause(CauseKind.START, name), step, node):
                        pair = each.source, each.sink
                        if (other := found.get(pair)) is not None:
                            each = Leading(
                                *pair, each.cause, each.example, each.allowed or other.allowed, each.kept or other.kept
                            )
                        found[pair] = each
            yield from found.values()

    def _started(self, cause: StateCause, step: TransitionStep, node: Node) -> Iterator[Leading]:
        safe, unsafe = self._space.safe, self._space.unsafe
        inside = self._inside(node)
        before = inside & step.before(self._space.into) & self._space.out_of
        allowed = set(self._folded(step.after(inside & safe) & safe))
        kept = set(self._folded(step.after(inside & safe) & unsafe))
        every = self._folded(step.after(inside & self._space.out_of) & self._space.into)
        for sink in every:
            if sink != node:
                yield Leading(node, sink, cause, self._state(before), sink in allowed, sink in kept)

    def _happening(self) -> Iterator[Leading]:
        """Yield what happens without us: each effect alone, with what finishes then, and finishes alone."""
        diagrams, automaton = self._diagrams, self._plant.automaton
        for effect in automaton.effects:
            if self._bears(effect):
                yield from self._reacted(effect)
        finishing = self._plant.reaction(())
        for name, finish in finishing.finishes.items():
            if writes := [where for each, (where, _) in finish.writes.items() if each in self.chosen]:
                where = diagrams.disjunction(writes)
                yield from self._moved(StateCause(CauseKind.FINISH, name), finishing, where)
        for operation in automaton.operations.values():
            if operation.activity in self.chosen:
                (bit,) = diagrams.bits[operation.activity]
                flip = Flip(diagrams.substitution([(bit, ~diagrams.bit(bit))]), bit)
                yield from self._moved(StateCause(CauseKind.ACTIVITY, operation.name), flip, diagrams.true)

    def _moved(self, cause: StateCause, step: TransitionStep, where: Function) -> Iterator[Leading]:
        for node in self._led_from(step, where):
            inside = self._inside(node) & where
            for sink in self._folded(step.after(inside)):
                if sink != node:
                    yield Leading(node, sink, cause, self._state(inside))

    def _reacted(self, effect: Effect) -> Iterator[Leading]:
        """Yield where an effect leads that alone happens, and changes something."""
        step, cause = self._plant.reaction((effect,)), StateCause(CauseKind.EFFECT, effect.name)
        taken = self._taken(effect)
        for node in self._folded(self._space.reached & before_through(self._plant, step, taken)):
            inside = self._inside(node)
            for sink in self._folded(step.after(inside & taken)):
                if sink != node:
                    led = before_through(self._plant, step, taken & self._seen(sink, step))
                    yield Leading(node, sink, cause, self._state(inside & led))

    def _taken(self, effect: Effect) -> Function:
        """Say, of values now and afterwards, that an effect has written what it writes, and changed something by it."""
        diagrams, reader = self._diagrams, self._plant.reader
        written, differing = diagrams.true, diagrams.false
        for action in effect.actions:
            name = target(action)
            if name not in diagrams.bits:
                continue
            applies = diagrams.true if action.condition is None else reader.predicate(action.condition)
            written &= applies.imp(same(diagrams, reader.values(action.value), diagrams.values_after(name)))
            differing |= applies & ~same(diagrams, diagrams.values(name), diagrams.values_after(name))
        return written & differing

    def _seen(self, node: Node, step: Reaction) -> Function:
        """Say, of values afterwards where a reaction changes them, that they are those of a node."""
        diagrams = self._diagrams
        return diagrams.conjunction(
            (diagrams.values_after(name) if name in step.changed else diagrams.values(name))[value]
            for name, value in zip(self.chosen, node, strict=True)
        )

    def _bears(self, effect: Effect) -> bool:
        """Return whether an effect writes a chosen variable, or what a finish that does looks at."""
        written = {target(action) for action in effect.actions}
        return not written.isdisjoint({*self.chosen, *self._looked_at})

    @cached_property
    def _looked_at(self) -> frozenset[str]:
        """The measured variables that decide about finishes that write chosen variables."""
        automaton = self._plant.automaton
        read: set[str] = set()
        for ability in automaton.abilities.values():
            if ability.finish_guard is None:
                continue
            if any(target(action) in self.chosen for action in ability.finish_actions):
                read.update(variables(ability.finish_guard))
                for action in ability.finish_actions:
                    read |= reads(action)
        return frozenset(name for name in automaton.names(Kind.MEASURED) if name in read)
