"""Export of planning problems to PDDL, and import of the resulting plans."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from math import prod

from sequence_planner.export.efa import allowed_values, different, word
from sequence_planner.export.sequential import ConditionalUpdate, ExportError, Move, Sequential
from sequence_planner.language.evaluator import holds
from sequence_planner.language.printer import print_expression
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.substitution import replaced
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    And,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
    occurrences,
)
from sequence_planner.language.types import BooleanType, Value
from sequence_planner.planning.problem import Plan, PlanTick

# The texts of PDDL, in which everything is ground.
#
# A truth value is a fact `(x)`, and another variable has the value v where `(x v)` holds. An action that changes such a
# variable is written for each value that it may have before.

# An expression that compares variables is written out for each combination of their values.
MOST_COMBINATIONS = 4096


def _lower(name: str) -> str:
    return word(name).lower()  # case tells nothing apart in PDDL


class PddlWriter:
    """Writes one question. Raises `ExportError` for an expression that takes too many cases."""

    def __init__(self, question: Sequential) -> None:
        self._question = question
        self._variables = different(question.types, _lower)
        values = {str(value) for type_ in question.types.values() for value in type_.domain}
        self._values = different(sorted(values), _value_word, frozenset(self._variables.values()))
        self._actions = different(((a.move, a.name) for a in question.actions), _action_word)
        self._name = _lower(question.title)
        self.actions = tuple(self._written())

    def domain(self) -> str:
        """The domain: predicates, constants and actions."""
        lines = [
            f"(define (domain {self._name})",
            "  (:requirements :strips :negative-preconditions :disjunctive-preconditions :conditional-effects)",
            f"  (:constants {' '.join(self._values.values())})",
            "  (:predicates",
            *(f"    {self._predicate(name)}" for name in self._question.types),
            "  )",
        ]
        lines += [text for _, _, text in self.actions]
        return "\n".join((*lines, ")", ""))

    def problem(self) -> str:
        """The problem: the state and the goal."""
        facts = (self._fact(n, value) for n, value in self._question.initial.items() if value is not False)
        lines = [
            f"(define (problem {self._name}-problem)",
            f"  (:domain {self._name})",
            "  (:init",
            *(f"    {fact}" for fact in facts),
            "  )",
            f"  (:goal {self._condition(self._question.goal)})",
            ")",
            "",
        ]
        return "\n".join(lines)

    def _written(self) -> Iterator[tuple[str, tuple[Move, str], str]]:
        """Each action with its name and what it is.

        One that changes variables of several values is written for each of the values that these may have before: so
        planners see that a variable has one value at a time.
        """
        for action in self._question.actions:
            several = dict.fromkeys(
                update.variable
                for update in action.updates
                if update.condition == TRUE and not isinstance(self._question.types[update.variable], BooleanType)
            )
            allowed = allowed_values(action.guard)
            domains = [sorted(allowed.get(n, self._question.types[n].domain), key=str) for n in several]
            for case, values in enumerate(product(*domains)):
                before = dict(zip(several, values, strict=True))
                guard = simplify(replaced(action.guard, {name: Constant(value) for name, value in before.items()}))
                if guard != FALSE:
                    name = self._actions[action.move, action.name] + (f"--{case}" if case else "")
                    yield name, (action.move, action.name), self._action(name, guard, action.updates, before)

    def _action(
        self, name: str, guard: Expression, updates: Iterable[ConditionalUpdate], before: Mapping[str, Value]
    ) -> str:
        facts = "".join(f" {self._fact(variable, value)}" for variable, value in before.items())
        changes = (line for update in updates for line in self._update(update, before))
        return "\n".join(
            (
                f"  (:action {name}",
                "    :parameters ()",
                f"    :precondition (and{facts} {self._condition(guard)})",
                "    :effect (and",
                *(f"      {line}" for line in changes),
                "    ))",
            )
        )

    def _update(self, update: ConditionalUpdate, before: Mapping[str, Value]) -> Iterator[str]:
        """The fact that comes, and the one of the value before that goes."""
        name, type_ = update.variable, self._question.types[update.variable]
        condition = simplify(replaced(update.condition, {each: Constant(value) for each, value in before.items()}))
        if condition == FALSE:
            return
        if isinstance(type_, BooleanType):
            fact = self._fact(name, True)
            yield self._where(condition, fact if update.value else f"(not {fact})")
        elif name in before:
            if before[name] != update.value:
                yield f"{self._fact(name, update.value)} (not {self._fact(name, before[name])})"
        else:
            for value in type_.domain:
                if value != update.value:
                    old, new = self._fact(name, value), self._fact(name, update.value)
                    yield f"(when (and {old} {self._condition(condition)}) (and {new} (not {old})))"

    def _where(self, condition: Expression, change: str) -> str:
        return change if condition == TRUE else f"(when {self._condition(condition)} {change})"

    def _predicate(self, name: str) -> str:
        parameter = "" if isinstance(self._question.types[name], BooleanType) else " ?value"
        return f"({self._variables[name]}{parameter})"

    def _fact(self, name: str, value: Value) -> str:
        if isinstance(value, bool):
            return f"({self._variables[name]})"
        return f"({self._variables[name]} {self._values[str(value)]})"

    def _condition(self, predicate: Expression) -> str:
        match predicate:
            case Constant(value):
                return "(and)" if value else "(or)"
            case Variable(name):
                return self._fact(name, True)
            case Not(operand):
                return f"(not {self._condition(operand)})"
            case And(operands):
                return f"(and {' '.join(map(self._condition, operands))})"
            case Or(operands):
                return f"(or {' '.join(map(self._condition, operands))})"
            case Implies(left, right):
                return f"(or (not {self._condition(left)}) {self._condition(right)})"
            case Comparison("==" | "!=" as relation, Variable(name), Constant(value)):
                fact = self._one_of(name, (value,))
                return fact if relation == "==" else f"(not {fact})"
            case Membership(Variable(name), options) if all(isinstance(option, Constant) for option in options):
                return self._one_of(name, tuple(option.value for option in options if isinstance(option, Constant)))
        return self._combinations(predicate)

    def _one_of(self, name: str, values: tuple[Value, ...]) -> str:
        type_ = self._question.types[name]
        facts = [
            f"(not {self._fact(name, True)})" if value is False else self._fact(name, value)
            for value in values
            if value in type_.domain
        ]
        return facts[0] if len(facts) == 1 else f"(or {' '.join(facts)})"

    def _combinations(self, predicate: Expression) -> str:
        """Write what no fact says directly, by the values of its variables that satisfy it."""
        concerned = {variable.name: variable.type.domain for variable in occurrences(predicate)}
        if prod(map(len, concerned.values())) > MOST_COMBINATIONS:
            raise ExportError(
                f"`{print_expression(predicate)}` takes more than {MOST_COMBINATIONS} cases to write down: "
                "compare fewer variables, or coarser ones"
            )
        ways = [
            " ".join(self._one_of(name, (value,)) for name, value in zip(concerned, values, strict=True))
            for values in product(*concerned.values())
            if holds(predicate, dict(zip(concerned, values, strict=True)))
        ]
        return f"(or {' '.join(f'(and {way})' for way in ways)})"


def _value_word(value: str) -> str:
    return f"minus-{value[1:]}" if re.fullmatch(r"-\d+", value) else f"v-{word(value).lower()}"


def _action_word(key: tuple[Move, str]) -> str:
    move, name = key
    return f"{move}-{word(name).lower()}" if name else str(move)


# Questions in PDDL, the language of classical planners, and their plans read back.
#
# The texts use STRIPS with negative and disjunctive conditions and conditional effects (Fox and Long 2003, level 1),
# and neither types nor parameters of actions.

# A line of a plan: an action in brackets, perhaps with the time before it.
_STEP = re.compile(r"^\s*(?:[\d.]+\s*:)?\s*\(\s*([^\s()]+)\s*\)")


@dataclass(frozen=True)
class PddlText:
    """A question as texts of PDDL. `moves` says what each action is in a run of ticks, by its name there."""

    domain: str
    problem: str
    moves: Mapping[str, tuple[Move, str]]

    def plan(self, text: str) -> Plan:
        """The plan that a planner has written, an action on each line, as the ticks it means.

        Where nothing else makes ticks, a goal that is reached ends one, and so does a start that comes again. Raises
        `ExportError` for an action that is none of ours.
        """
        ticks: list[PlanTick] = []
        effects: list[str] = []
        starts: list[str] = []

        def end_tick() -> None:
            ticks.append(PlanTick(tuple(effects), tuple(starts)))
            effects.clear()
            starts.clear()

        moves = [self._move(step[1]) for line in text.splitlines() if (step := _STEP.match(line))]
        for move, name in moves:
            if move is Move.BEGIN or (move is Move.REACH and starts) or (move is Move.START and name in starts):
                end_tick()
            if move is Move.EFFECT:
                effects.append(name)
            elif move is Move.START:
                starts.append(name)
        if moves:
            end_tick()
        return Plan(_without_last_starts(ticks), minimal_ticks=False, minimal_starts=False)

    @cached_property
    def timed(self) -> bool:
        """True if it goes by ticks; else each start could have one of its own."""
        return any(move is Move.SETTLED for move, _ in self.moves.values())

    def _move(self, action: str) -> tuple[Move, str]:
        found = self.moves.get(action.lower())
        if found is None:
            raise ExportError(f"the plan has the action `{action}`, which the exported domain has not")
        return found


def pddl_text(question: Sequential) -> PddlText:
    """The question in PDDL. Raises `ExportError` for an expression that takes too many cases."""
    writer = PddlWriter(question)
    return PddlText(writer.domain(), writer.problem(), {name: move for name, move, _ in writer.actions})


def _without_last_starts(ticks: list[PlanTick]) -> tuple[PlanTick, ...]:
    """The goals count after step 3, so what the last tick starts is of no use."""
    return (*ticks[:-1], PlanTick(ticks[-1].effects, ())) if ticks else ()
