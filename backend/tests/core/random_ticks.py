"""Random automata with all that a tick can meet, random runs of them, and the two interpreters side by side.

Wider than `random_stations`, since nobody has to enumerate their states: operations whose activity is read, chains of
flags, predicates nested deeper than Python can compile, equalities of predicates, values that become unknown again.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from random import Random

from sequence_planner.automaton import tick as reference
from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Flag,
    Kind,
    Operation,
    State,
    VariableDeclaration,
)
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.language.syntax import TRUE, And, Comparison, Expression, Not, Variable
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value

from .choices import Choices
from .random_expressions import Scope, actions, atom, equality, guard, predicate

TYPES: tuple[Type, ...] = (
    BOOLEAN,
    EnumerationType(("p", "q")),
    IntegerRange(0, 1),
    EnumerationType(("q", "r", "s")),
    IntegerRange(-1, 1),
    IntegerRange(0, 4),
)
KINDS = (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED)
FLAGS = ("enabled", "executing", "finished")


def automaton(choices: Choices) -> Automaton:
    """Up to five abilities and three operations over up to nine variables."""
    operations = [f"o{number}" for number in range(choices.number(0, 3))]
    read = [name for name in operations if not choices.chance(3)]
    declared = {each.name: each for each in (*_declared(choices), *map(_activity, read))}
    plain = [Variable(name, each.type) for name, each in declared.items()]
    names = [f"tool.a{number}(p)" for number in range(choices.number(1, 5))]
    flags = [Variable(f"{name}.{which}", BOOLEAN) for name in names for which in FLAGS]
    written = [each for each in plain if declared[each.name].kind in (Kind.OUTPUT, Kind.ESTIMATED)]
    measured = [each for each in plain if declared[each.name].kind is Kind.MEASURED]
    abilities = {
        name: _ability(choices, name, plain, written, flags, number * len(FLAGS)) for number, name in enumerate(names)
    }
    everything = [*plain, *flags]
    return Automaton(
        name="random",
        title="random",
        description="",
        resources={"tool": "tool"},
        variables=declared,
        abilities=abilities,
        flags=tuple(Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in FLAGS),
        effects=tuple(
            Effect(
                f"react{number}",
                "tool",
                "starting",
                _any(choices, everything),
                actions(choices, measured, everything, least=1),
                fault=choices.chance(4),
            )
            for number in range(choices.number(0, 3))
        ),
        operations={
            name: Operation(name, name, _any(choices, everything), _any(choices, everything)) for name in operations
        },
    )


def _declared(choices: Choices) -> list[VariableDeclaration]:
    kinds = [Kind.MEASURED, Kind.OUTPUT, *(choices.pick(KINDS) for _ in range(choices.number(0, 4)))]
    types = [choices.pick(TYPES) for _ in kinds]
    return [
        VariableDeclaration(f"tool.{kind.value}[{number}]", type_, kind, choices.pick(type_.domain), "tool")
        for number, (kind, type_) in enumerate(zip(kinds, types, strict=True))
    ]


def _activity(operation: str) -> VariableDeclaration:
    return VariableDeclaration(f"operation.{operation}.active", BOOLEAN, Kind.ACTIVITY, False, None)


def _ability(choices: Choices, name: str, plain: Scope, written: Scope, flags: Scope, first: int) -> Ability:
    """The flags from number `first` on are its own; its flags read those before."""
    everything, before = [*plain, *flags], [*plain, *flags[:first]]
    enabled, executing, _ = flags[first : first + len(FLAGS)]
    finish: Expression | None = _any(choices, everything)
    if choices.chance(3):
        finish = And((executing, atom(choices, everything)))
    elif choices.chance(4):
        finish = None
    return Ability(
        name=name,
        resource="tool",
        title=name,
        enabled=_any(choices, before),
        start_guard=TRUE if choices.chance(2) else _any(choices, everything),
        start_actions=actions(choices, written, everything, least=0),
        executing=_any(choices, [*before, enabled]),
        finished=_any(choices, [*before, enabled, executing]),
        finish_guard=finish,
        finish_actions=actions(choices, written, everything, least=0),
    )


def _any(choices: Choices, scope: Scope) -> Expression:
    """A predicate of any shape: mostly one that engineers write, and sometimes one that they would never write."""
    shape = choices.number(0, 12)
    if shape < 5:
        return guard(choices, scope)
    if shape < 8:
        return predicate(choices, scope, 1 + choices.number(0, 3))
    if shape == 8:
        return equality(choices, scope)
    if shape == 12:
        return _reversed(atom(choices, scope))
    nested = predicate(choices, scope, 1)
    if shape == 9:
        return Comparison(choices.pick(("==", "!=")), nested, predicate(choices, scope, 1))
    for _ in range(choices.pick((2, 45)) if shape == 10 else 0):
        nested = Not(nested)
    for _ in range(choices.pick((2, 12)) if shape == 11 else 0):
        nested = Comparison(choices.pick(("==", "!=")), nested, atom(choices, scope))
    return nested


def _reversed(expression: Expression) -> Expression:
    if not isinstance(expression, Comparison):
        return expression
    return Comparison(expression.operator, expression.right, expression.left, expression.span)


class SideBySide:
    """A run of the compiled tick and of the reference, which must agree after every step.

    `seen` counts what the run has met.
    """

    def __init__(self, choices: Choices, automaton: Automaton) -> None:
        self.seen = Counter[str]()
        self._choices = choices
        self._automaton = automaton
        self._compiled = CompiledTick(automaton)
        self._active: frozenset[str] = frozenset()
        self._state: State = {}
        self.jump()

    def jump(self) -> None:
        """Go to any state whatsoever, its flags synchronised or not."""
        values: dict[str, Value | None] = {}
        for name, type_ in self._automaton.types.items():
            is_flag = name not in self._automaton.variables
            values[name] = self._value(type_, unknown=is_flag or name in self._measured)
        self._state = values
        self._run = CompiledRun(self._compiled, values)
        self._agree()

    def tick(self) -> None:
        """One tick; any abilities are asked to start, and even some that may not."""
        automaton, run = self._automaton, self._run
        measured = {
            each: self._value(automaton.types[each], unknown=True)
            for each in self._choices.different(self._measured, 0, 3)
        }
        self._state = reference.sense(self._state, measured)
        run.sense(measured)
        finishing = reference.finish(automaton, self._state)
        self._state = finishing.state
        finished = run.finish()
        assert (finished.finished, finished.conflicts) == (finishing.finished, finishing.conflicts)
        self.seen.update(ticks=1, finishes=len(finished.finished), conflicts=len(finished.conflicts))
        self._agree()
        self._state = reference.synchronise(automaton, self._state)
        run.synchronise()
        self._agree()
        self._update_operations()
        for name in self._choices.different(list(automaton.abilities), 0, 2):
            self._start(name)

    def _update_operations(self) -> None:
        if self._choices.chance(6):  # somebody else has reset or cancelled one
            self._active ^= {self._choices.pick(["gone", *self._automaton.operations])}
        active = reference.update_operations(self._automaton, self._state, self._active)
        assert self._run.update_operations(self._active) == active
        self.seen.update(activations=len(active - self._active), completions=len(self._active - active))
        self._active = active
        self._state = reference.record_activity(self._automaton, self._state, active)
        self._run.record_activity(active)
        self._agree()

    def _start(self, name: str) -> None:
        ability = self._automaton.abilities[name]
        if name not in self._run.startable() and not self._choices.chance(3):
            return
        after = reference.start(self._automaton, self._state, ability)
        fork = self._run.fork()
        assert fork.start(name) is (after is not None)
        self._same(fork, self._state if after is None else after)
        self.seen["starts" if after is not None else "undetermined starts"] += 1
        self._agree()
        if self._choices.chance(4):
            return
        assert self._run.start(name) is (after is not None)
        self._state = self._state if after is None else after
        self._agree()

    def _agree(self) -> None:
        """The states are the same, and so is what may start and happen in them; a fork changes nothing about that."""
        self.seen["undetermined flags"] += any(self._state[flag.name] is None for flag in self._automaton.flags)
        fork = self._run.fork()
        self._same(fork, self._state)
        self._same(self._run, self._state)
        self._same(fork, self._state)

    def _same(self, run: CompiledRun, state: State) -> None:
        assert run.state == state
        abilities = self._automaton.abilities.items()
        assert run.startable() == {name for name, each in abilities if reference.start_guard_holds(each, state)}
        changes: dict[str, reference.Writes] = {}
        for effect in self._automaton.effects:
            written = None if effect.fault else reference.effect_writes(effect, state)
            if changed := {name: value for name, value in (written or {}).items() if state[name] != value}:
                changes[effect.name] = changed
        assert run.effects() == changes

    @property
    def _measured(self) -> Sequence[str]:
        return self._automaton.names(Kind.MEASURED)

    def _value(self, type_: Type, unknown: bool) -> Value | None:
        return None if unknown and self._choices.chance(4) else self._choices.pick(type_.domain)


def compare(choices: Choices, ticks: int) -> Counter[str]:
    """Make an automaton and take it through so many ticks; AssertionError where the interpreters disagree."""
    sides = SideBySide(choices, automaton(choices))
    for _ in range(ticks):
        if choices.chance(12):
            sides.jump()
        sides.tick()
    return sides.seen


def compare_by_seed(seed: str, ticks: int) -> Counter[str]:
    """The same for the automaton and the run that `seed` stands for. The AssertionError names it."""
    try:
        return compare(Choices(Random(seed).randrange), ticks)
    except AssertionError as error:
        raise AssertionError(f"compiled tick and reference disagree: compare_by_seed({seed!r}, {ticks})") from error
