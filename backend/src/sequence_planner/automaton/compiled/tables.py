"""An automaton made ready for its compiled tick: its predicates as functions, and what reads what."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple, TypeVar

from sequence_planner.automaton.compiled.closures import Closures
from sequence_planner.automaton.compiled.functions import Compiler, Evaluation, Truth
from sequence_planner.automaton.structure import Ability, Automaton, State, reads, target
from sequence_planner.automaton.tick import Writes
from sequence_planner.expressions.syntax import (
    TRUE,
    Assignment,
    Constant,
    Expression,
    Variable,
    conjunction,
    variables,
)
from sequence_planner.expressions.types import BOOLEAN
from sequence_planner.immutable import Immutable

F = TypeVar("F")


class Dependants(NamedTuple):
    """What must be looked at again when a variable or a flag has changed.

    `flags` come by their level: a flag reads flags of lower levels only, and waits until these are known.
    """

    flags: tuple[tuple[int, tuple[str, ...]], ...]
    finishes: tuple[str, ...]
    operations: tuple[str, ...]
    starts: tuple[str, ...]
    effects: tuple[str, ...]


class Actions(Immutable):
    """Actions taken at once: what they always write, or else the target, condition and value of each."""

    always: Writes | None
    each: tuple[tuple[str, Truth, Evaluation], ...]

    def writes(self, state: State) -> Writes | None:
        """What they write in `state`, not to be changed; None when an unknown value leaves it undetermined."""
        if self.always is not None:
            return self.always
        written: Writes = {}
        for name, condition, evaluated in self.each:
            applies = condition(state)
            if applies is None:
                return None
            if not applies:
                continue
            value = evaluated(state)
            if value is None:
                return None
            written[name] = value
        return written


class CompiledTick:
    """The tables of one automaton, made once for all its runs, which never change them.

    `hot` ones are compiled for many runs; the others are made ten times as quickly and step half as fast. Abilities
    whose flag `enabled` the automaton does not have go by its predicate alone.
    """

    def __init__(self, automaton: Automaton, hot: bool = True) -> None:
        abilities, operations = automaton.abilities, automaton.operations
        finishing = {a.name: a.finish_guard for a in abilities.values() if a.finish_guard is not None}
        self.automaton = automaton
        self.names = tuple(map(str, automaton.initial_valuation))
        self.position = {name: number for number, name in enumerate(abilities)}
        flag_reads = {flag.name: _reads(flag.predicate) for flag in automaton.flags}
        self.level = _levels(flag_reads)
        self.dependants = _dependants(automaton, self.names, flag_reads, self.level)
        compiler: Compiler | Closures = Compiler(self.names) if hot else Closures()
        self.flags = _by_name(compiler.truths, automaton.flag_predicates)
        self.finish_guards = _by_name(compiler.predicates, finishing)
        self.finish_actions = _actions(compiler, {name: abilities[name].finish_actions for name in finishing})
        self.goals = _by_name(compiler.truths, {o.name: o.goal for o in operations.values()})
        self.preconditions = _by_name(compiler.predicates, {o.name: o.precondition for o in operations.values()})
        self.activities = tuple((o.name, o.activity) for o in operations.values() if o.activity in automaton.variables)
        start_guards = {a.name: _start_guard(automaton, a) for a in abilities.values()}
        self.start_guards = _by_name(compiler.predicates, start_guards)
        self.start_actions = _actions(compiler, {a.name: a.start_actions for a in abilities.values()})
        effects = {effect.name: effect for effect in automaton.effects if not effect.fault}
        self.effect_guards = _by_name(compiler.predicates, {name: e.guard for name, e in effects.items()})
        self.effect_actions = _actions(compiler, {name: e.actions for name, e in effects.items()})


def _start_guard(automaton: Automaton, ability: Ability) -> Expression:
    """What must hold for a start, the supervisor apart: the flag `enabled`, its predicate and the written guard."""
    enabled = ability.flag("enabled")
    flags = (Variable(enabled, BOOLEAN),) if enabled in automaton.flag_predicates else ()
    return conjunction(*flags, ability.enabled, ability.start_guard)


def _by_name(
    compiled: Callable[[Iterable[Expression]], list[F]], expressions: Mapping[str, Expression]
) -> dict[str, F]:
    return dict(zip(expressions, compiled(expressions.values()), strict=True))


def _actions(compiler: Compiler | Closures, actions: Mapping[str, Sequence[Assignment]]) -> dict[str, Actions]:
    conditions = compiler.truths(a.condition or TRUE for each in actions.values() for a in each)
    values = compiler.values(a.value for each in actions.values() for a in each)
    functions = zip(conditions, values, strict=True)
    return {
        name: Actions(_constants(each), tuple((target(action), *next(functions)) for action in each))
        for name, each in actions.items()
    }


def _constants(actions: Sequence[Assignment]) -> Writes | None:
    """What `actions` write, if it is the same in every state."""
    written: Writes = {}
    for action in actions:
        if action.condition is not None or not isinstance(action.value, Constant):
            return None
        written[target(action)] = action.value.value
    return written


def _reads(*expressions: Expression) -> frozenset[str]:
    return frozenset(name for expression in expressions for name in variables(expression))


def _levels(flag_reads: Mapping[str, frozenset[str]]) -> dict[str, int]:
    """The level of each flag: one more than the highest of the flags it reads."""
    levels: dict[str, int] = {}
    for flag, read in flag_reads.items():
        levels[flag] = 1 + max((levels[name] for name in read if name in levels), default=-1)
    return levels


def _dependants(
    automaton: Automaton, names: Iterable[str], flag_reads: Mapping[str, frozenset[str]], level: Mapping[str, int]
) -> dict[str, Dependants]:
    flags, finishes, operations, starts, effects = (defaultdict[str, list[str]](list) for _ in range(5))
    for flag, read in flag_reads.items():
        _note(flags, flag, read)
    for ability in automaton.abilities.values():
        enabled = ability.flag("enabled")
        own = {enabled} & flag_reads.keys()
        _note(starts, ability.name, _reads(ability.enabled, ability.start_guard) | own)
        if ability.finish_guard is not None:
            # What it writes as well: while its guard holds, it writes that again after anybody else has.
            touched = (each for action in ability.finish_actions for each in (target(action), *reads(action)))
            _note(finishes, ability.name, _reads(ability.finish_guard).union(touched))
    for operation in automaton.operations.values():
        _note(operations, operation.name, _reads(operation.goal, operation.precondition))
    for effect in automaton.effects:
        if not effect.fault:
            touched = (each for action in effect.actions for each in (target(action), *reads(action)))
            _note(effects, effect.name, _reads(effect.guard).union(touched))
    return {
        name: Dependants(
            _by_level(flags[name], level),
            tuple(finishes[name]),
            tuple(operations[name]),
            tuple(starts[name]),
            tuple(effects[name]),
        )
        for name in names
    }


def _note(readers: dict[str, list[str]], reader: str, names: Iterable[str]) -> None:
    for name in names:
        readers[name].append(reader)


def _by_level(flags: Iterable[str], level: Mapping[str, int]) -> tuple[tuple[int, tuple[str, ...]], ...]:
    by_level = defaultdict[int, list[str]](list)
    for flag in flags:
        by_level[level[flag]].append(flag)
    return tuple((number, tuple(members)) for number, members in by_level.items())
