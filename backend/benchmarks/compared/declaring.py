"""Stations of any size, declared piece by piece in the model's own language."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Flag,
    Kind,
    Specification,
    State,
    VariableDeclaration,
)
from sequence_planner.automaton.dependencies import ordered_flags
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment
from sequence_planner.language.resolver import resolve_assignment, resolve_predicate
from sequence_planner.language.syntax import Assignment, Expression
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value
from sequence_planner.planning.problem import Goal

FLAGS = ("enabled", "executing", "finished")
UNSUPERVISED = Supervisor(StateSet((), ()), {})


@dataclass(frozen=True)
class Problem:
    """A state of an automaton, and questions to a planner: goals to reach together, by the name of the question."""

    name: str
    automaton: Automaton
    supervisor: Supervisor
    state: State
    questions: Mapping[str, tuple[Goal, ...]]

    @property
    def size(self) -> str:
        """How many variables and transitions there are."""
        abilities = self.automaton.abilities.values()
        finishes = sum(ability.finish_guard is not None for ability in abilities)
        transitions = len(abilities) + finishes + len(self.automaton.effects)
        return f"{len(self.automaton.variables)} variables, {transitions} transitions"


@dataclass(frozen=True)
class Does:
    """An ability as an engineer writes it; `finish` is None for one that is done at its start."""

    start: tuple[str, ...]
    enabled: str
    executing: str = "false"
    finish: str | None = None
    finally_: tuple[str, ...] = ()


class Declared:
    """Collects variables, abilities, effects and specifications; texts may name what is declared later."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._variables: dict[str, VariableDeclaration] = {}
        self._abilities: dict[str, tuple[str, Does]] = {}
        self._effects: dict[str, tuple[str, str, tuple[str, ...]]] = {}
        self._forbidden: dict[str, str] = {}

    def variable(self, resource: str, name: str, kind: Kind, type_: Type | int | Iterable[str], initial: Value) -> str:
        """A variable of a resource; an integer means a range from 0 on, words mean an enumeration."""
        if isinstance(type_, int):
            type_ = IntegerRange(0, type_)
        elif not isinstance(type_, Type):
            type_ = EnumerationType(tuple(type_))
        full = f"{resource}.{name}"
        self._variables[full] = VariableDeclaration(full, type_, kind, initial, resource)
        return full

    def ability(self, resource: str, name: str, does: Does) -> None:
        """An ability of a resource."""
        self._abilities[f"{resource}.{name}"] = (resource, does)

    def effect(self, resource: str, name: str, guard: str, *actions: str) -> None:
        """How measured variables of a resource are expected to react."""
        self._effects[f"{resource}.{name}"] = (resource, guard, actions)

    def forbid(self, name: str, predicate: str) -> None:
        """A specification."""
        self._forbidden[name] = predicate

    @property
    def _scope(self) -> NameScope:
        types = {name: variable.type for name, variable in self._variables.items()}
        return NameScope(types | {f"{name}.{flag}": BOOLEAN for name in self._abilities for flag in FLAGS})

    def automaton(self) -> Automaton:
        """All that has been declared."""
        scope = self._scope
        abilities = {name: _ability(name, *declared, scope) for name, declared in self._abilities.items()}
        flags, circle = ordered_flags(
            [Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in FLAGS]
        )
        assert not circle
        resources = dict.fromkeys(v.resource for v in self._variables.values() if v.resource is not None)
        return Automaton(
            name=self._name,
            title=self._name,
            description="",
            resources={resource: resource for resource in resources},
            variables=self._variables,
            abilities=abilities,
            flags=flags,
            effects=tuple(
                Effect(name, resource, "executing", _predicate(guard, scope), _actions(actions, scope))
                for name, (resource, guard, actions) in self._effects.items()
            ),
            specifications={
                name: Specification(name, name, _predicate(text, scope)) for name, text in self._forbidden.items()
            },
        )

    def problem(self, questions: Mapping[str, Mapping[str, str]], supervisor: Supervisor | None = None) -> Problem:
        """The questions have predicates by the names of their goals; they are asked in the declared initial state."""
        automaton, scope = self.automaton(), self._scope
        goals = {
            question: tuple(Goal(name, _predicate(text, scope)) for name, text in asked.items())
            for question, asked in questions.items()
        }
        return Problem(self._name, automaton, supervisor or UNSUPERVISED, initial_state(automaton), goals)


def _ability(name: str, resource: str, does: Does, scope: NameScope) -> Ability:
    own = NameScope(scope.variables, (f"{name}.",))
    return Ability(
        name=name,
        resource=resource,
        title=name,
        enabled=_predicate(does.enabled, own),
        start_guard=_predicate("true", own),
        start_actions=_actions(does.start, own),
        executing=_predicate(does.executing, own),
        finished=_predicate("false", own),
        finish_guard=None if does.finish is None else _predicate(does.finish, own),
        finish_actions=_actions(does.finally_, own),
    )


def _predicate(text: str, scope: NameScope) -> Expression:
    return resolve_predicate(parse(text), scope)


def _actions(texts: Iterable[str], scope: NameScope) -> tuple[Assignment, ...]:
    return tuple(resolve_assignment(parse_assignment(text), scope) for text in texts)
