"""Relaxed plans (FF): extraction, relevant transitions, and the automaton part that a relaxed plan uses."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property, partial
from itertools import chain, product

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, State, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.transitions import Phase, Transition, finishing, sensing, starting
from sequence_planner.core.immutable import replace
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import (
    TRUE,
    And,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
    conjunction,
    variables,
)
from sequence_planner.language.types import Value
from sequence_planner.planning.partial_states import PartialState
from sequence_planner.planning.problem import Circumstances

# Which transitions a plan could be made of, were nothing ever undone (Hoffmann and Nebel 2001).
#
# Values are gathered layer by layer until the goals may hold; then, backwards, for each value that is needed the
# transitions that first wrote it, and what these need. It is a guess, made quickly, of what matters.

Fact = tuple[str, Value]
_Support = tuple[int, tuple[Fact, ...]]  # what it takes in transitions, and the values that are enough
_Way = tuple[int, Transition, tuple[Fact, ...]]  # a support with the transition that is taken on it

_DEARER = 2  # what a transition may take more than the best to be another way to the same value
_MOST_COMPARED = 256  # of values, in one comparison; no more are tried


class RelaxedPlan:
    """From one state, by `moves`."""

    def __init__(self, automaton: Automaton, state: State, moves: Iterable[Transition]) -> None:
        self._automaton = automaton
        self._moves = tuple(moves)
        self._costs: dict[str, dict[Value, int]] = {
            name: {} if (value := state[name]) is None else {value: 0} for name in automaton.variables
        }
        self.layers = 0  # gathered so far
        self._achievers: dict[Fact, list[_Way]] = {}

    def towards(self, goals: Sequence[Expression]) -> tuple[Transition, ...] | None:
        """The transitions of a relaxed plan; None when even so not every one of `goals` may hold."""
        readers: dict[str, list[int]] = defaultdict(list)
        waiting: Iterable[int] = range(len(self._moves))
        blocked = False
        while not blocked:
            needed = [self._support(goal, True) for goal in goals]
            found = [each for each in needed if each is not None]
            if len(found) == len(needed):
                return self._extracted([fact for _, facts in found for fact in facts])
            gathered: dict[Fact, list[_Way]] = defaultdict(list)
            for number in waiting:
                for fact, way in self._taken(self._moves[number]):
                    gathered[fact].append(way)
            if not readers:
                readers = self._readers()
            for (name, value), ways in gathered.items():
                least = min(cost for cost, _, _ in ways)
                self._costs[name][value] = least
                self._achievers[name, value] = [way for way in ways if way[0] <= least + _DEARER]
            waiting = sorted({number for name, _ in gathered for number in readers[name]})
            self.layers += 1
            blocked = not gathered
        return None

    def _readers(self) -> dict[str, list[int]]:
        readers: dict[str, list[int]] = defaultdict(list)
        known: dict[str, frozenset[str]] = {}

        def behind(name: str) -> frozenset[str]:
            """The variables that decide a variable or flag."""
            if name not in known:
                predicate = self._automaton.flag_predicates.get(name)
                inner = () if predicate is None else tuple(map(behind, variables(predicate)))
                known[name] = frozenset({name} if predicate is None else ()).union(*inner)
            return known[name]

        for number, move in enumerate(self._moves):
            for name in frozenset[str]().union(*map(behind, move.reads)):
                readers[name].append(number)
        return readers

    def _taken(self, move: Transition) -> list[tuple[Fact, _Way]]:
        """The values that are new by `move`, if it may be taken."""
        new: list[tuple[Fact, _Way]] = []
        guard: _Support | None = None
        for action in move.actions:
            name, written = target(action), action.value
            costs = self._costs[name]
            if not costs or len(costs) == len(self._automaton.variables[name].type.domain):
                continue  # what is unknown stays so
            if isinstance(written, Constant) and written.value in costs:
                continue
            guard = guard or self._support(move.guard, True)
            if guard is None:
                return []
            for value, (cost, facts) in self._written(action):
                if value not in costs:
                    new.append(((name, value), (1 + guard[0] + cost, move, guard[1] + facts)))
        return new

    def _written(self, action: Assignment) -> list[tuple[Value, _Support]]:
        condition = (0, ()) if action.condition is None else self._support(action.condition, True)
        if condition is None:
            return []
        values = self._values(action.value)
        return [(value, (condition[0] + cost, condition[1] + facts)) for value, (cost, facts) in values]

    def _extracted(self, needed: list[Fact]) -> tuple[Transition, ...]:
        chosen: dict[str, Transition] = {}
        seen: set[Fact] = set()
        while needed:
            fact = needed.pop()
            if fact not in seen:
                for _, move, facts in self._achievers.get(fact, ()):
                    chosen[move.name] = move
                    needed.extend(facts)
            seen.add(fact)
        return tuple(chosen.values())

    def _support(self, predicate: Expression, truth: bool) -> _Support | None:
        """The cheapest values that give `predicate` the value `truth`; None when none of those gathered do."""
        # What is most frequent comes first, and without patterns, as in `language.evaluator.evaluate`.
        if isinstance(predicate, Comparison):
            return self._compared(predicate, truth)
        if isinstance(predicate, And):
            return self._every(predicate.operands, True) if truth else self._cheapest(predicate.operands, False)
        if isinstance(predicate, Or):
            return self._cheapest(predicate.operands, True) if truth else self._every(predicate.operands, False)
        if isinstance(predicate, Variable):
            name = predicate.name
            if name in self._automaton.flag_predicates:
                return self._support(self._automaton.flag_predicates[name], truth)
            cost = self._costs[name].get(truth)
            return None if cost is None else (cost, ((name, truth),))
        if isinstance(predicate, Not):
            return self._support(predicate.operand, not truth)
        match predicate:
            case Constant(value):
                return (0, ()) if value is truth else None
            case Implies(left, right):
                return self._support(Or((Not(left), right)), truth)
            case Membership():
                return self._among(predicate, truth)
            case _:
                return None

    def _compared(self, predicate: Comparison, truth: bool) -> _Support | None:
        left, right = predicate.left, predicate.right
        if not (isinstance(left, Variable) and isinstance(right, Constant) and predicate.operator in ("==", "!=")):
            return self._among(predicate, truth)
        costs = self._costs.get(left.name)
        if costs is None:
            return self._among(predicate, truth)
        equal = truth is (predicate.operator == "==")
        if equal:
            cost = costs.get(right.value)
            return None if cost is None else (cost, ((left.name, right.value),))
        options = [(cost, ((left.name, value),)) for value, cost in costs.items() if value != right.value]
        return min(options, default=None, key=_cost)

    def _among(self, predicate: Expression, truth: bool) -> _Support | None:
        values = self._values(predicate)
        return min((support for value, support in values if value is truth), default=None, key=_cost)

    def _every(self, parts: Iterable[Expression], truth: bool) -> _Support | None:
        cost, facts = 0, list[Fact]()
        for part in parts:
            support = self._support(part, truth)
            if support is None:
                return None
            cost += support[0]
            facts += support[1]
        return cost, tuple(facts)

    def _cheapest(self, parts: Iterable[Expression], truth: bool) -> _Support | None:
        options = (self._support(part, truth) for part in parts)
        return min((option for option in options if option is not None), default=None, key=_cost)

    def _values(self, expression: Expression) -> list[tuple[Value, _Support]]:
        """Return what `expression` may be, each with what it takes."""
        match expression:
            case Constant(value):
                return [(value, (0, ()))]
            case Variable(name) if name in self._costs:
                return [(value, (cost, ((name, value),))) for value, cost in self._costs[name].items()]
        names = tuple(dict.fromkeys(variables(expression)))
        supports = [self._named(name) for name in names]
        found: dict[Value, _Support] = {}
        for _, combination in zip(range(_MOST_COMPARED), product(*supports), strict=False):
            result = evaluate(expression, dict(zip(names, (value for value, _ in combination), strict=True)))
            cost = sum(support[0] for _, support in combination)
            if result is not None and (result not in found or cost < found[result][0]):
                found[result] = (cost, tuple(fact for _, support in combination for fact in support[1]))
        return list(found.items())

    def _named(self, name: str) -> list[tuple[Value, _Support]]:
        if name in self._costs:
            return self._values(Variable(name, self._automaton.types[name]))
        both = ((truth, self._support(self._automaton.flag_predicates[name], truth)) for truth in (False, True))
        return [(truth, support) for truth, support in both if support is not None]


def _cost(support: _Support) -> int:
    return support[0]


# The transitions that could matter to a question, found backwards from its goals, however large the station is.
#
# What holds already is never looked for: only values that are missing lead on, to the transitions that write them and
# to what these miss in turn. Of alternatives those that miss the least are followed, and what an ability's start
# brings is not looked for elsewhere when it finishes. It is a guess; where it leaves too little, all transitions are
# left.

MissingFact = tuple[str, Value | None]  # a value that a variable does not have; with None, whichever
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
        seen: set[MissingFact] = set()
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

    def _bringing(self, fact: MissingFact) -> Iterator[_Write]:
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


def _brought(actions: Iterable[Assignment]) -> Iterator[MissingFact]:
    """The values that are written in any case."""
    for action in actions:
        if action.condition is None and isinstance(action.value, Constant):
            yield target(action), action.value.value


class _Missing:
    """The facts that expressions miss in one state."""

    def __init__(self, automaton: Automaton, state: State) -> None:
        self._automaton = automaton
        self._state = state

    def of_action(self, action: Assignment, guard: Expression) -> list[MissingFact]:
        """Return what an action misses, and the guard of its transition besides."""
        facts = [(name, None) for name in variables(action.value)]
        if action.condition is None:
            return facts + self.of(guard, True)
        met = self.of(action.condition, True)
        there = _Missing(self._automaton, {**self._state, **dict(met)})
        return facts + met + [(name, value) for name, value in there.of(guard, True) if self._state[name] != value]

    def of(self, predicate: Expression, truth: bool) -> list[MissingFact]:
        """Values of which some give `predicate` the value `truth`, unless it has that."""
        flags = self._automaton.flag_predicates
        if evaluate(predicate, self._state) is truth:
            return []
        # What is most frequent comes first, and without patterns, as in `language.evaluator.evaluate`.
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


# What of a part of the automaton serves a relaxed plan, what brings back that which the plan takes away included.


def useful(automaton: Automaton, taken: Iterable[str], goals: Iterable[Expression]) -> Automaton:
    """`automaton` with no other abilities and effects than those `taken`, by name, and those that bring values which
    these or the goals ask for, whether or not the values are there already; and so on.
    """
    units: dict[str, Ability | Effect] = {
        **automaton.abilities,
        **{effect.name: effect for effect in automaton.effects},
    }
    writers: dict[Fact, list[str]] = defaultdict(list)
    for name, unit in units.items():
        for action in _actions(unit):
            for value in _values(automaton, action):
                writers[target(action), value].append(name)
    found: set[str] = set()
    facts: set[Fact] = set()
    waiting = [name for name in taken if name in units]
    asked: Iterable[Fact] = chain.from_iterable(_asked(automaton, goal, True) for goal in goals)
    while True:
        for fact in asked:
            if fact not in facts:
                facts.add(fact)
                waiting += writers[fact]
        if not waiting:
            break
        name = waiting.pop()
        asked = () if name in found else _asked_by(automaton, units[name])
        found.add(name)
    return replace(
        automaton,
        abilities={name: ability for name, ability in automaton.abilities.items() if name in found},
        effects=tuple(effect for effect in automaton.effects if effect.name in found),
    )


def written_by(part: Automaton) -> dict[str, set[Value]]:
    """The variables that abilities and effects write, with all that they can write."""
    written: dict[str, set[Value]] = defaultdict(set)
    units: list[Ability | Effect] = [*part.abilities.values(), *part.effects]
    for action in (action for unit in units for action in _actions(unit)):
        written[target(action)].update(_values(part, action))
    return written


def _actions(unit: Ability | Effect) -> tuple[Assignment, ...]:
    return unit.actions if isinstance(unit, Effect) else (*unit.start_actions, *unit.finish_actions)


def _values(automaton: Automaton, action: Assignment) -> Iterable[Value]:
    if isinstance(action.value, Constant):
        return (action.value.value,)
    return automaton.variables[target(action)].type.domain


def _asked_by(automaton: Automaton, unit: Ability | Effect) -> Iterator[Fact]:
    conditions = (action.condition for action in _actions(unit) if action.condition is not None)
    guards = (unit.guard,) if isinstance(unit, Effect) else (unit.enabled, unit.start_guard, unit.finish_guard or TRUE)
    for predicate in (*guards, *conditions):
        yield from _asked(automaton, predicate, True)


def _asked(automaton: Automaton, predicate: Expression, truth: bool) -> Iterator[Fact]:
    """The values by which `predicate` can get the value `truth`; a difference asks for none."""
    # What is most frequent comes first, and without patterns, as in `language.evaluator.evaluate`.
    if isinstance(predicate, _JUNCTIONS):
        for part in predicate.operands:
            yield from _asked(automaton, part, truth)
        return
    if isinstance(predicate, Variable):
        flag = automaton.flag_predicates.get(predicate.name)
        yield from ((predicate.name, truth),) if flag is None else _asked(automaton, flag, truth)
        return
    match predicate:
        case Comparison("==" | "!=" as relation, Variable(name), Constant(value)):
            if truth is (relation == "=="):
                yield name, value
        case Not(operand):
            yield from _asked(automaton, operand, not truth)
        case Implies(left, right):
            yield from _asked(automaton, left, not truth)
            yield from _asked(automaton, right, truth)
        case Comparison(_, Variable(name) as variable, Constant()) | Membership(Variable(name) as variable, _):
            for value in variable.type.domain:
                if evaluate(predicate, PartialState({name: value})) is truth:
                    yield name, value
