"""Reachability with nothing ever undone: each variable gathers values, and never loses one.

Whatever the station can do, the relaxation can. A goal it cannot reach can never be reached, which is a proof that
there is no plan at all; this is the delete relaxation of planning (Bonet and Geffner 2001) over finite domains.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from itertools import product
from math import prod

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, Flag, State, target
from sequence_planner.automaton.transitions import Transition, transitions
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import (
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
    variables,
)
from sequence_planner.expressions.types import Value
from sequence_planner.planning.plan import Circumstances, Clause, Literal, Proof
from sequence_planner.planning.relaxed.permission import Permission

Possible = Mapping[str, set[Value | None]]

# An expression over more combinations than this is not evaluated: it may have any value, so the relaxation stays sound.
_MOST_COMBINATIONS = 4096


def reachable(
    automaton: Automaton,
    state: State,
    circumstances: Circumstances,
    supervisor: Supervisor | None = None,
    pause: Callable[[], object] = lambda: None,
) -> Relaxation:
    """All that runs from `state` can make of variables and flags, and perhaps more.

    Operations stay as active as they are. With a `supervisor` nothing starts that it never allows, which takes longer.
    `pause` is called again and again, and may raise.
    """
    first: dict[str, set[Value | None]] = {name: {value} for name, value in state.items()}
    permission = None if supervisor is None else Permission(supervisor)
    return Relaxation(automaton, first, counted_on(automaton, circumstances), permission, pause)


def unreached(automaton: Automaton, relaxed: Relaxation) -> Proof:
    """That no run leaves the relaxation: what has never gained a value does not have it."""
    clauses: list[Clause] = []
    for name, type_ in automaton.types.items():
        never = (value for value in type_.domain if value not in relaxed.possible[name])
        clauses += [(Literal(name, value, equal=False),) for value in never]
    return Proof("relaxation", tuple(clauses))


def counted_on(automaton: Automaton, circumstances: Circumstances) -> tuple[Transition, ...]:
    """The transitions a plan may be made of: no faults, and nothing that does not happen or start."""
    offline = circumstances.offline
    idle = {effect.name for effect in automaton.effects if effect.fault or effect.resource in offline}
    idle |= {f"{name}.start" for name, ability in automaton.abilities.items() if circumstances.bars(ability)}
    return tuple(transition for transition in transitions(automaton) if transition.name not in idle)


class Relaxation:
    """What each variable and flag may become from `first`, where each has some values already, by permitted `moves`."""

    def __init__(
        self,
        automaton: Automaton,
        first: Possible,
        moves: Iterable[Transition],
        permission: Permission | None = None,
        pause: Callable[[], object] = lambda: None,
    ) -> None:
        self._automaton = automaton
        self._permission = permission
        self.possible = {name: set(values) for name, values in first.items()}
        self._true: set[tuple[int, bool]] = set()  # expressions known to have a truth value, which they never lose
        self._kept: list[Expression] = []  # so that no identity is given to another expression
        steps: list[Transition | Flag] = [*automaton.flags, *moves]
        permitted: set[int] = set()
        readers: dict[str, list[int]] = defaultdict(list)
        for number, step in enumerate(steps):
            for name in set(variables(step.predicate)) if isinstance(step, Flag) else step.reads:
                readers[name].append(number)
        waiting = dict.fromkeys(range(len(steps)))
        held: dict[int, Transition] = {}  # that only the supervisor keeps from being taken
        while waiting:
            pause()
            number = waiting.popitem()[0]
            step = steps[number]
            if (
                permission is not None
                and isinstance(step, Transition)
                and step.controllable
                and number not in permitted
            ):
                if self.may(step.guard):
                    held[number] = step
            else:
                for name in self._taken(step):
                    waiting.update(dict.fromkeys(readers[name]))
            if not waiting and held:  # once nothing else is to be done, as this takes longest
                now = [each for each, start in held.items() if self._may_start(start)]
                permitted.update(now)
                for each in now:
                    del held[each]
                waiting.update(dict.fromkeys(now))

    def may(self, predicate: Expression, truth: bool = True) -> bool:
        """Whether some choice of possible values may give `predicate` the value `truth`."""
        key = (id(predicate), truth)
        if key in self._true:
            return True
        if not self._may(predicate, truth):
            return False
        self._true.add(key)
        self._kept.append(predicate)
        return True

    def _may_start(self, start: Transition) -> bool:
        return self._permission is None or self._permission.may(start, self.possible)

    def _taken(self, step: Transition | Flag) -> list[str]:
        """Take a step if it may be; what has gained values."""
        if isinstance(step, Flag):
            values = self.possible[step.name]
            new = [t for t in (True, False) if t not in values and self.may(step.predicate, t)]
            values.update(new)
            return [step.name] if new else []
        if not self.may(step.guard):
            return []
        return [target(action) for action in step.actions if self._gather(action)]

    def _gather(self, action: Assignment) -> bool:
        """Add what `action` can write; whether anything was new."""
        if action.condition is not None and not self.may(action.condition):
            return False
        name = target(action)
        if self.possible[name] == {None}:
            return False  # the planner keeps an unknown variable unknown
        domain = set(self._automaton.variables[name].type.domain)
        values = self._values(action.value)
        # Where it is taken an action writes a value of the domain; it is looked at where it is not taken, too.
        new = (domain if values is None else domain & values) - self.possible[name]
        self.possible[name] |= new
        return bool(new)

    def _may(self, predicate: Expression, truth: bool) -> bool:
        match predicate:
            case Constant(value):
                return value is truth
            case Variable(name):
                return truth in self.possible[name]
            case Not(operand):
                return self.may(operand, not truth)
            case And(operands):
                decide = all if truth else any
                return decide(self.may(part, truth) for part in operands)
            case Or(operands):
                decide = any if truth else all
                return decide(self.may(part, truth) for part in operands)
            case Implies(left, right) if truth:
                return self.may(left, False) or self.may(right, True)
            case Implies(left, right):
                return self.may(left, True) and self.may(right, False)
            case Comparison("==" | "!=" as relation, left, Constant(value)):
                return self._may_equal(left, {value}, truth is (relation == "=="))
            case Comparison("==" | "!=" as relation, left, Variable(name)):
                return self._may_equal(left, self.possible[name], truth is (relation == "=="))
            case Membership(left, options) if all(isinstance(option, Constant) for option in options):
                return self._may_be_among(left, {o.value for o in options if isinstance(o, Constant)}, truth)
        values = self._values(predicate)
        return values is None or truth in values

    def _may_equal(self, left: Expression, right: set[Value | None], truth: bool) -> bool:
        if (values := self._values(left)) is None:
            return True
        known, other = values - {None}, right - {None}
        return bool(known & other) if truth else len(known | other) > 1 and bool(known and other)

    def _may_be_among(self, left: Expression, options: set[Value], truth: bool) -> bool:
        values = self._values(left)
        return values is None or bool(values & options if truth else values - options - {None})

    def _values(self, expression: Expression) -> set[Value | None] | None:
        """What `expression` may be; None when there are too many combinations to say."""
        match expression:
            case Constant(value):
                return {value}
            case Variable(name):
                return self.possible[name]
        names = sorted(set(variables(expression)))
        if self._combinations(names) > _MOST_COMBINATIONS:
            return None
        return {
            evaluate(expression, dict(zip(names, values, strict=True)))
            for values in product(*(self.possible[name] for name in names))
        }

    def _combinations(self, names: Iterable[str]) -> int:
        return prod(len(self.possible[name]) for name in names)
