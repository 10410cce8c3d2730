"""What a text of a document means at its place: predicates, formulas and actions, resolved and checked."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from sequence_planner.automaton.automaton import Kind, VariableDeclaration, target
from sequence_planner.automaton.declarations import OPERATION, Declarations
from sequence_planner.automaton.findings import Binding, Findings, UseOfRemoved, without_arguments
from sequence_planner.language.fitting import misfit
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.resolver import resolve_assignments, resolve_formula, resolve_predicate
from sequence_planner.language.simplifier import simplify, simplify_assignment
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    Assignment,
    CircleError,
    Constant,
    Expression,
    ExpressionError,
    UnusableError,
    occurrences,
)
from sequence_planner.language.types import BOOLEAN, BooleanType, Place
from sequence_planner.model.fields import Predicate
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.texts.message import Message, message


def _what_it_is(name: str, variable: VariableDeclaration | None) -> Message:
    if variable is not None:
        return message(f"written.is.{variable.kind}")
    return message("written.is.activity" if name.startswith(f"{OPERATION}.") else "written.is.flag")


def _written_twice(variable: VariableDeclaration, one: Assignment, other: Assignment) -> Message:
    if one.condition is None and other.condition is None:
        return message("wrong.written-twice", name=variable.name)
    if isinstance(variable.type, BooleanType):
        return message("wrong.written-twice.truth", name=variable.name)
    return message("wrong.written-twice.cases", name=variable.name)


class Writing(NamedTuple):
    """A writer, as texts are named for it, and the kinds of variables that it may write."""

    what: str
    kinds: tuple[Kind, ...]


class Meaning:
    """Texts in the light of what is declared. What is wrong with one is noted, and it then means nothing (`false`)."""

    def __init__(self, declarations: Declarations, findings: Findings) -> None:
        self.declarations = declarations
        self.findings = findings
        self.circle: frozenset[str] = frozenset()  # of predicates that need each other, to which a text led
        self._activities: dict[str, None] = {}  # in order

    def scope(self, binding: Binding, *prefixes: str) -> NameScope:
        """Return what names mean for a part with these parameters, in these surroundings."""
        return NameScope(self.declarations.types, prefixes, binding, self.declarations.vocabulary)

    def predicate(self, text: Predicate, scope: NameScope) -> Expression:
        """A condition."""
        return self._condition(text, scope, lambda written: resolve_predicate(parse(written), scope))

    def formula(self, text: Predicate, scope: NameScope) -> Expression:
        """A formula of linear temporal logic over finite traces."""
        return self._condition(text, scope, lambda written: resolve_formula(parse_formula(written), scope))

    def actions(
        self, texts: Iterable[SourceText], scope: NameScope, guard: Expression, writing: Writing
    ) -> tuple[Assignment, ...]:
        """The actions of one transition, taken under `guard`."""
        actions: dict[str, Assignment] = {}
        for text, action in ((each, action) for each in texts for action in self._actions(each, scope)):
            name = target(action)
            variable = self.declarations.variables.get(name)
            if variable is None or variable.kind not in writing.kinds:
                written = text[action.target.span.start : action.target.span.end]
                kind = _what_it_is(name, variable)
                self.findings.add(text, message(f"wrong.writes.{writing.what}", name=written, kind=kind))
            elif name in actions:
                self.findings.add(text, _written_twice(variable, actions[name], action))
            elif action.condition != FALSE:
                actions[name] = action
                self._check_fits(text, action, guard)
                if Kind.MEASURED in writing.kinds:
                    self.check_observable(text, action.value, action.condition or TRUE)
        return tuple(actions.values())

    def check_observable(self, text: SourceText, *read: Expression) -> None:
        """A device knows nothing of what we believe, and an emulated one only hears messages."""
        for seen in (each for expression in read for each in occurrences(expression)):
            if not self.is_observable(seen.name):
                written = text[seen.span.start : seen.span.end]
                self.findings.add_within(text, seen.span, message("wrong.unobservable", name=written))

    def is_observable(self, name: str) -> bool:
        """Return whether a device, or what emulates one, can know of a variable."""
        variable = self.declarations.variables.get(name)
        return variable is not None and variable.kind is not Kind.ESTIMATED

    @property
    def activities(self) -> dict[str, VariableDeclaration]:
        """The activities of operations that some text reads."""
        return {name: VariableDeclaration(name, BOOLEAN, Kind.ACTIVITY, False, None) for name in self._activities}

    def take(self, findings: Iterable[Finding], activities: Iterable[str]) -> None:
        """Take over what was noted of a part that was read by itself."""
        self.findings.all.extend(findings)
        self._activities |= dict.fromkeys(activities)

    def _condition(self, text: Predicate, scope: NameScope, read: Callable[[SourceText], Expression]) -> Expression:
        if not isinstance(text, SourceText):
            return Constant(bool(text))
        try:
            return self._noted(text, simplify(read(text)))
        except ExpressionError as error:
            self._misread(text, error, scope)
            return FALSE

    def _actions(self, text: SourceText, scope: NameScope) -> tuple[Assignment, ...]:
        try:
            actions = tuple(map(simplify_assignment, resolve_assignments(parse_assignment(text), scope)))
        except ExpressionError as error:
            self._misread(text, error, scope)
            return ()
        for action in actions:
            self._noted(text, action.value)
            self._noted(text, action.condition or TRUE)
        return actions

    def _noted(self, text: SourceText, expression: Expression) -> Expression:
        """The meaning of `text`, whose readings of operations are kept in mind."""
        if OPERATION in text or self.declarations.vocabulary.predicates:
            read = (variable.name for variable in occurrences(expression))
            self._activities |= dict.fromkeys(name for name in read if name.startswith(f"{OPERATION}."))
        return expression

    def _check_fits(self, text: SourceText, action: Assignment, guard: Expression) -> None:
        if (found := misfit(action, guard)) is not None:
            self.findings.add_within(text, action.value.span, message("wrong.misfit", what=found.in_words()))

    def _misread(self, text: SourceText, error: ExpressionError, scope: NameScope) -> None:
        if isinstance(error, UnusableError):
            return  # what is wrong is told where the predicate is declared
        if isinstance(error, CircleError):
            self.circle = frozenset(error.circle)
        name = without_arguments(text[error.span.start : error.span.end])
        owner = name.rpartition(".")[0]  # of a flag
        known = [prefix + one for prefix in (*scope.prefixes, "") for one in (name, owner)]
        if any(each in self.declarations.broken for each in known):
            return
        removed = next((each for each in known if each in self.declarations.removed), None)
        if removed is None or removed in self.declarations.variables:
            self.findings.add_within(text, error.span, error.message)
        else:
            self._uses_removed(text.at(error.span), removed)

    def _uses_removed(self, place: Place, full: str) -> None:
        word, entry = full.rpartition(".")[2], self.declarations.removed[full]
        said = message("wrong.removed", name=word, place=str(entry))
        in_type = bool(place.instance)
        self.findings.all.append(UseOfRemoved(place, said, word, entry) if in_type else Finding(place, said))


# Conditions that may read less than all.


def observable_condition(meaning: Meaning, text: Predicate, scope: NameScope) -> Expression:
    """The condition of an effect."""
    guard = meaning.predicate(text, scope)
    if isinstance(text, SourceText):
        meaning.check_observable(text, guard)
    return guard


def alarm_condition(meaning: Meaning, text: Predicate, scope: NameScope) -> Expression:
    """The condition of an alarm. What it read of an operation would become a variable, and no alarm makes any."""
    apart = Meaning(meaning.declarations, meaning.findings)
    when = apart.predicate(text, scope.not_suggesting(f"{OPERATION}."))
    if isinstance(text, SourceText):
        for seen in occurrences(when):
            if seen.name in apart.activities:
                meaning.findings.add_within(text, seen.span, message("wrong.alarm-reads"))
    return when


# Predicates, which are written out where they are used.


def check_predicates(meaning: Meaning) -> None:
    """Note what is wrong with a predicate, once and where it is declared, for all values of its parameters; a circle at
    the first predicate that is in it.
    """
    declarations = meaning.declarations
    told: set[frozenset[str]] = set()  # circles
    for full, prefixes, parameters, condition in declarations.written_predicates():
        apart = Meaning(declarations, Findings())
        for binding in declarations.bindings(parameters):
            apart.predicate(condition, apart.scope(binding, *prefixes))
            if found := apart.findings.all:
                if not apart.circle or (full in apart.circle and apart.circle not in told):
                    meaning.take(found, ())
                    told.add(apart.circle)
                declarations.broken.add(full)
                break
