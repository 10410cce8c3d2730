"""Automata for examples, written down in a few lines of the model's own language."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Flag,
    Kind,
    Operation,
    Specification,
    Timeouts,
    VariableDeclaration,
)
from sequence_planner.automaton.dependencies import ordered_flags
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.resolver import resolve_assignment, resolve_formula, resolve_predicate
from sequence_planner.language.syntax import Expression
from sequence_planner.language.types import BOOLEAN, Type, Value

NO_TIMEOUTS = Timeouts()
FLAGS = ("enabled", "executing", "finished")
Declared = Mapping[str, tuple[Type, Value]]  # name: type and initial value


@dataclass(frozen=True)
class Does:
    """An ability as an engineer writes it; `finish` is None for one that is done at its start."""

    start: tuple[str, ...]
    enabled: str = "true"
    when: str = "true"
    executing: str = "false"
    finished: str = "false"
    finish: str | None = None
    finally_: tuple[str, ...] = ()
    restart: bool = False
    cancel: tuple[str, ...] = ()
    timeouts: Timeouts = NO_TIMEOUTS


def predicate_of(automaton: Automaton, text: str) -> Expression:
    """A predicate in the model's language over the variables of an automaton."""
    return resolve_predicate(parse(text), NameScope({name: each.type for name, each in automaton.variables.items()}))


def automaton(
    abilities: Mapping[str, Does],
    *,
    measured: Declared | None = None,
    output: Declared | None = None,
    estimated: Declared | None = None,
    effects: Mapping[str, tuple[str, tuple[str, ...]]] | None = None,
    faults: Iterable[str] = (),
    goals: Mapping[str, str] | None = None,
    priorities: Mapping[str, int] | None = None,
    local: Mapping[str, str] | None = None,
    forbidden: Mapping[str, str] | None = None,
    rest: str | None = None,
) -> Automaton:
    """A station of one resource. Effects are a guard and actions; `faults` names some of them; goals have no
    precondition.
    """
    kinds = {Kind.MEASURED: measured or {}, Kind.OUTPUT: output or {}, Kind.ESTIMATED: estimated or {}}
    variables = {
        name: VariableDeclaration(name, type_, kind, initial, None)
        for kind, declared in kinds.items()
        for name, (type_, initial) in declared.items()
    }
    types = {name: variable.type for name, variable in variables.items()}
    scope = NameScope(types | {f"{name}.{flag}": BOOLEAN for name in abilities for flag in FLAGS})
    made = {name: _ability(name, does, scope) for name, does in abilities.items()}
    flags, circle = ordered_flags([Flag(a.flag(which), getattr(a, which)) for a in made.values() for which in FLAGS])
    assert not circle
    return Automaton(
        name="example",
        title="example",
        description="",
        resources={"station": "station"},
        variables=variables,
        abilities=made,
        flags=flags,
        effects=tuple(
            Effect(
                name,
                "station",
                "executing",
                resolve_predicate(parse(guard), scope),
                tuple(resolve_assignment(parse_assignment(action), scope) for action in actions),
                fault=name in faults,
            )
            for name, (guard, actions) in (effects or {}).items()
        ),
        operations={
            name: Operation(
                name,
                name,
                resolve_predicate(parse("true"), scope),
                resolve_predicate(parse(goal), scope),
                (priorities or {}).get(name, 0),
                None if name not in (local or {}) else resolve_formula(parse_formula((local or {})[name]), scope),
            )
            for name, goal in (goals or {}).items()
        },
        specifications={
            name: Specification(name, name, resolve_predicate(parse(text), scope))
            for name, text in (forbidden or {}).items()
        },
        rest=None if rest is None else resolve_predicate(parse(rest), scope),
    )


def _ability(name: str, does: Does, scope: NameScope) -> Ability:
    own = NameScope(scope.variables, (f"{name}.",))
    return Ability(
        name=name,
        resource="station",
        title=name,
        enabled=resolve_predicate(parse(does.enabled), own),
        start_guard=resolve_predicate(parse(does.when), own),
        start_actions=tuple(resolve_assignment(parse_assignment(action), own) for action in does.start),
        executing=resolve_predicate(parse(does.executing), own),
        finished=resolve_predicate(parse(does.finished), own),
        finish_guard=None if does.finish is None else resolve_predicate(parse(does.finish), own),
        finish_actions=tuple(resolve_assignment(parse_assignment(action), own) for action in does.finally_),
        restart=does.restart,
        timeouts=does.timeouts,
        cancel_actions=tuple(resolve_assignment(parse_assignment(action), own) for action in does.cancel),
    )
