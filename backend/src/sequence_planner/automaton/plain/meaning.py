"""Plain automaton from its document: readable variable names, types and transitions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from itertools import islice
from typing import TypeVar

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Kind,
    Operation,
    Specification,
    VariableDeclaration,
)
from sequence_planner.automaton.plain.events import NUMBER_SIGN
from sequence_planner.automaton.plain.updates import enabling_guard
from sequence_planner.automaton.plain.valuations import TooEntangledError, valuations_of
from sequence_planner.automaton.plain.variables import declared_types, unknown_variable, unlimited
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_formula
from sequence_planner.language.printer import print_expression, print_value
from sequence_planner.language.resolver import resolve_assignment, resolve_formula, resolve_predicate
from sequence_planner.language.simplifier import simplify, simplify_assignment
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    Assignment,
    Component,
    Constant,
    Expression,
    ExpressionError,
    Name,
    UnaryTemporal,
    Variable,
    conjunction,
    conjuncts,
    first_temporal,
)
from sequence_planner.language.types import Place, Type, Value, contains
from sequence_planner.model.efa_document import PlainModel, TransitionDocument, UpdateDocument
from sequence_planner.model.fields import Predicate
from sequence_planner.model.source import Finding, ModelError, SourceText

# The automaton that the document of a plain automaton means: `docs/semantics.md`, "Supervisor".

T = TypeVar("T")

# What an update is read as being written to: a name that nothing in a document can have.
_WRITTEN = ":="


def plain_automaton(model: PlainModel) -> Automaton:
    """The automaton that `model` means, each transition under the name of its event. Raises `ModelError`."""
    findings: list[Finding] = []
    types = declared_types(model, findings)
    if findings:
        raise ModelError(findings)  # every use of these variables would be wrong as well
    automaton = _Meaning(model, types, findings).automaton()
    if findings:
        raise ModelError(findings)
    return automaton


class _Meaning:
    def __init__(self, model: PlainModel, types: dict[str, Type], findings: list[Finding]) -> None:
        self._model = model
        self._types = types
        self._scope = NameScope(types)
        self._findings = findings
        self._places: dict[str, Place] = {str(name): name.place for name in model.content.variables}

    def automaton(self) -> Automaton:
        content = self._model.content
        invariant = self._predicate(content.invariant)
        described, initial = self._initial(conjunction(*conjuncts(self._predicate(content.initial)), invariant))
        abilities, effects = self._transitions(invariant)
        rest = self._predicate(content.marked)
        self._places.setdefault("rest", self._model.source.place_of_value(("marked",)))
        goals = tuple(self._formula(text) for text in content.goal)
        name = str(content.name)
        return Automaton(
            name=name,
            title=name,
            description="",
            resources={name: name},
            variables={
                variable: VariableDeclaration(variable, type_, Kind.ESTIMATED, initial[variable], None)
                for variable, type_ in self._types.items()
            },
            abilities=abilities,
            flags=(),
            effects=effects,
            operations=self._operations(goals),
            specifications=self._specifications(),
            rest=None if rest == TRUE else rest,
            one_at_a_time=True,
            initial=described,
            goals=goals,
            places=self._places,
        )

    def _transitions(self, invariant: Expression) -> tuple[dict[str, Ability], tuple[Effect, ...]]:
        abilities: dict[str, Ability] = {}
        effects: list[Effect] = []
        seen: Counter[str] = Counter()
        first: dict[str, TransitionDocument] = {}
        for index, document in enumerate(self._model.content.transitions):
            event = str(document.event)
            self._check_event(document, first.setdefault(event, document))
            seen[event] += 1
            name = event if seen[event] == 1 else f"{event}{NUMBER_SIGN}{seen[event]}"
            self._places[name] = document.event.place
            updates = [self._update(index, variable, value) for variable, value in document.updates.items()]
            actions = tuple(action for action in updates if action is not None)
            guard = enabling_guard(self._predicate(document.guard), actions, invariant)
            if document.controllable:
                abilities[name] = self._ability(name, event, guard, actions)
            else:
                effects.append(Effect(name, str(self._model.content.name), "uncontrollable", guard, actions))
        return abilities, tuple(effects)

    def _ability(self, name: str, event: str, guard: Expression, actions: tuple[Assignment, ...]) -> Ability:
        """Done at its start."""
        resource = str(self._model.content.name)
        return Ability(name, resource, event, TRUE, guard, actions, FALSE, FALSE, None, ())

    def _check_event(self, document: TransitionDocument, first: TransitionDocument) -> None:
        event = document.event
        if NUMBER_SIGN in event:
            message = (
                f"`{event}` cannot be the name of an event: `{NUMBER_SIGN}` numbers the transitions of one event; "
                f"rename it, for example to `{event.replace(NUMBER_SIGN, '_')}`"
            )
            self._findings.append(Finding(event.place, message))
        if document.controllable != first.controllable:
            words = ("uncontrollable", "controllable")
            message = (
                f"the event `{event}` is {words[document.controllable]} here and {words[first.controllable]} in line "
                f"{first.event.place.line}: an event is one or the other; make it two events"
            )
            self._findings.append(Finding(event.place, message))

    def _update(self, index: int, variable: SourceText, value: UpdateDocument) -> Assignment | None:
        name = str(variable)
        if name not in self._types:
            self._findings.append(unknown_variable(variable, self._types))
            return None
        written_to = Variable(name, self._types[name])
        if not isinstance(value, SourceText):
            if not contains(unlimited(written_to.type), value):
                place = self._model.source.place_of_value(("transitions", index, "set", name))
                message = f"`{print_value(value)}` is no value of `{name}`, which ranges over {written_to.type}"
                self._findings.append(Finding(place, message))
                return None
            return Assignment(written_to, Constant(value))
        written = NameScope({**self._types, _WRITTEN: unlimited(written_to.type)})
        action = self._read(
            value, lambda: resolve_assignment(Assignment(Name((Component(_WRITTEN),)), parse(value)), written)
        )
        return None if action is None else simplify_assignment(Assignment(written_to, action.value))

    def _specifications(self) -> dict[str, Specification]:
        specifications: dict[str, Specification] = {}
        for number, text in enumerate(self._model.content.forbidden, start=1):
            name, forbidden = f"forbidden_{number}", self._predicate(text)
            specifications[name] = Specification(name, print_expression(forbidden), forbidden)
            self._places[name] = self._model.source.place(("forbidden", number - 1))
        return specifications

    def _operations(self, goals: tuple[Expression, ...]) -> dict[str, Operation]:
        """Of goals `F p`, which a plan reaches where `p` holds."""
        operations: dict[str, Operation] = {}
        for number, formula in enumerate(goals, start=1):
            if isinstance(formula, UnaryTemporal) and formula.operator == "F" and not first_temporal(formula.operand):
                name = f"goal_{number}"
                operations[name] = Operation(name, print_expression(formula), TRUE, simplify(formula.operand))
                self._places[f"operation.{name}"] = self._model.source.place(("goal", number - 1))
        return operations

    def _initial(self, described: Expression) -> tuple[Expression | None, dict[str, Value]]:
        """The description, unless it is of one state alone, and one of the initial states."""
        initial = simplify(described)
        place = self._model.source.place_of_value(("initial",))
        try:
            found = list(islice(valuations_of(initial, self._types), 2))
        except TooEntangledError:
            message = "no initial state was found in reasonable time: write more of it as `variable == value and ...`"
            self._findings.append(Finding(place, message))
            return None, {name: type_.domain[0] for name, type_ in self._types.items()}
        if not found and not self._findings:
            both = "" if self._model.content.invariant is True else " and `invariant`"
            self._findings.append(Finding(place, f"no state satisfies `initial`{both}: there is nowhere to begin"))
        if len(found) == 1:
            return None, found[0]
        return initial, found[0] if found else {name: type_.domain[0] for name, type_ in self._types.items()}

    def _predicate(self, text: Predicate) -> Expression:
        if not isinstance(text, SourceText):
            return Constant(bool(text))
        read = self._read(text, lambda: simplify(resolve_predicate(parse(text), self._scope)))
        return TRUE if read is None else read

    def _formula(self, text: SourceText) -> Expression:
        read = self._read(text, lambda: resolve_formula(parse_formula(text), self._scope))
        return TRUE if read is None else read

    def _read(self, text: SourceText, read: Callable[[], T]) -> T | None:
        try:
            return read()
        except ExpressionError as error:
            self._findings.append(Finding(text.at(error.span), error.message))
            return None
