"""The transitions that could matter to a question, found backwards from its goals, however large the station is.

What holds already is never looked for: only values that are missing lead on, to the transitions that write them and to
what these miss in turn. Of alternatives those that miss the least are followed, and what an ability's start brings is
not looked for elsewhere when it finishes. It is a guess; where it leaves too little, all transitions are left.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Iterator
from functools import cached_property, partial

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Automaton, State, target
from sequence_planner.automaton.transitions import Phase, Transition, finishing, sensing, starting
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import (
    And,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Implies,
    Not,
    Or,
    Variable,
    conjunction,
    variables,
)
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import replace
from sequence_planner.planning.plan import Circumstances

Fact = tuple[str, Value | None]  # a value that a variable does not have; with None, whichever
_Write = tuple[int, Assignment]  # an action, with the number of its transition

_JUNCTIONS = (And, Or)


class Relevance:
    """Finds the transitions of one automaton."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        abilities = automaton.abilities.values()
        # Of a large station few transitions matter, so that they are made as they are asked for.
        self._makers: list[Callable[[], Transition]] = []
        self._made: dict[int, Transition] = {}
        self._starts: dict[str, int] = {}  # by ability
        self._writes: dict[str, list[_Write]] = defaultdict(list)
        for effect in automaton.effects:
            self._add(partial(sensing, effect), effect.actions)
        for ability in abilities:
            if ability.finish_guard is not None:
                self._add(partial(finishing, ability), ability.finish_actions)
        for ability in abilities:
            self._starts[ability.name] = len(self._makers)
            self._add(partial(starting, ability), ability.start_actions)

    def _add(self, maker: Callable[[], Transition], actions: Iterable[Assignment]) -> None:
        for action in actions:
            self._writes[target(action)].append((len(self._makers), action))
        self._makers.append(maker)

    def _transition(self, number: int) -> Transition:
        if number not in self._made:
            self._made[number] = self._makers[number]()
        return self._made[number]

    @property
    def transitions(self) -> Iterator[Transition]:
        """All of them, as `automaton.transitions` has them."""
        return map(self._transition, range(len(self._makers)))

    def writing(self, names: Iterable[str]) -> list[Transition]:
        """All transitions that write one of these variables, in order."""
        numbers = {number for name in names for number, _ in self._writes[name]}
        return [self._transition(number) for number in sorted(numbers)]

    def counted_on(self, state: State, circumstances: Circumstances) -> list[Transition]:
        """All that a plan from `state` may be made of, in order."""
        moves = (self._counted_on(move, state, circumstances) for move in self.transitions)
        return [move for move in moves if move is not None]

    def towards(self, goals: Iterable[Expression], state: State, circumstances: Circumstances) -> list[Transition]:
        """Those of them that seem to matter to `goals`, in order."""
        here = _Missing(self._automaton, state)
        moves: dict[int, Transition | None] = {}
        pending = deque(fact for goal in goals for fact in here.of(goal, True))
        seen: set[Fact] = set()
        while pending:
            fact = pending.popleft()
            if fact in seen:
                continue
            seen.add(fact)
            for number, action in self._bringing(fact):
                if number not in moves:
                    moves[number] = self._counted_on(self._transition(number), state, circumstances)
                move = moves[number]
                if move is None:
                    continue
                pending += here.of_action(action, move.guard)
                if move.phase is Phase.FINISH:
                    # It comes after its own start, and looks for nobody else to bring what that brings.
                    number = self._starts[move.name.rpartition(".")[0]]
                    start = self._transition(number)
                    moves[number] = self._counted_on(start, state, circumstances)
                    seen.update(_brought(start.actions))
        return [move for _, move in sorted(moves.items()) if move is not None]

    @cached_property
    def _resources(self) -> dict[str, str]:
        return {effect.name: effect.resource for effect in self._automaton.effects}

    def _bringing(self, fact: Fact) -> Iterator[_Write]:
        name, value = fact
        for number, action in self._writes[name]:
            if value is None or not isinstance(action.value, Constant) or action.value.value == value:
                yield number, action

    def _counted_on(self, move: Transition, state: State, circumstances: Circumstances) -> Transition | None:
        if move.phase is Phase.SENSE:
            return None if move.fault or self._resources[move.name] in circumstances.offline else move
        ability = self._automaton.abilities[move.name.rpartition(".")[0]]
        if move.phase is Phase.START:
            return None if circumstances.bars(ability) else move
        if state[ability.flag("executing")] is True:
            return move
        # What has not started must do so before it finishes.
        return replace(move, guard=conjunction(move.guard, ability.enabled, ability.start_guard))


def _brought(actions: Iterable[Assignment]) -> Iterator[Fact]:
    """The values that are written in any case."""
    for action in actions:
        if action.condition is None and isinstance(action.value, Constant):
            yield target(action), action.value.value


class _Missing:
    """What expressions miss in one state."""

    def __init__(self, automaton: Automaton, state: State) -> None:
        self._automaton = automaton
        self._state = state

    def of_action(self, action: Assignment, guard: Expression) -> list[Fact]:
        """What an action misses, and the guard of its transition besides."""
        facts = [(name, None) for name in variables(action.value)]
        if action.condition is None:
            return facts + self.of(guard, True)
        met = self.of(action.condition, True)
        there = _Missing(self._automaton, {**self._state, **dict(met)})
        return facts + met + [(name, value) for name, value in there.of(guard, True) if self._state[name] != value]

    def of(self, predicate: Expression, truth: bool) -> list[Fact]:
        """Values of which some give `predicate` the value `truth`, unless it has that."""
        flags = self._automaton.flag_predicates
        if evaluate(predicate, self._state) is truth:
            return []
        # What is most frequent comes first, and without patterns, as in `expressions.evaluation.evaluate`.
        if isinstance(predicate, _JUNCTIONS):
            parts = [self.of(part, truth) for part in predicate.operands]
            if isinstance(predicate, Or) is truth:
                least = min(map(len, parts))
                parts = [part for part in parts if len(part) == least]
            return [fact for part in parts for fact in part]
        if isinstance(predicate, Variable):
            name = predicate.name
            return self.of(flags[name], truth) if name in flags else [(name, truth)]
        match predicate:
            case Comparison("==" | "!=" as relation, Variable(name), Constant(value)) if truth is (relation == "=="):
                return [(name, value)]
            case Not(operand):
                return self.of(operand, not truth)
            case Implies(left, right):
                return self.of(Or((Not(left), right)), truth)
        return [(name, None) for name in read_variables(self._automaton, (predicate,))]
