"""What a text of a document means at its place: predicates, formulas and actions, resolved and checked."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from sequence_planner.automaton.grounding.declarations import OPERATION, Declarations
from sequence_planner.automaton.grounding.findings import Binding, Findings, without_arguments
from sequence_planner.automaton.structure import Kind, VariableDeclaration, target
from sequence_planner.expressions.fitting import misfit
from sequence_planner.expressions.parser import parse, parse_assignment, parse_formula
from sequence_planner.expressions.resolution import Scope, resolve_assignment, resolve_formula, resolve_predicate
from sequence_planner.expressions.simplification import simplify, simplify_assignment
from sequence_planner.expressions.syntax import (
    FALSE,
    TRUE,
    Assignment,
    Constant,
    Expression,
    ExpressionError,
    occurrences,
)
from sequence_planner.expressions.types import BOOLEAN
from sequence_planner.model.documents import Predicate
from sequence_planner.model.source import Finding, SourceText

_KINDS = {
    Kind.MEASURED: "a measured variable",
    Kind.OUTPUT: "an output variable",
    Kind.ESTIMATED: "an estimated variable",
}


def _not_a_variable(name: str) -> str:
    return "the activity of an operation" if name.startswith(f"{OPERATION}.") else "a flag of an ability"


class Writing(NamedTuple):
    """What writes, in words, and the kinds of variables that it may write."""

    what: str
    kinds: tuple[Kind, ...]


class Meaning:
    """Texts in the light of what is declared. What is wrong with one is noted, and it then means nothing (`false`)."""

    def __init__(self, declarations: Declarations, findings: Findings) -> None:
        self.declarations = declarations
        self.findings = findings
        self._activities: dict[str, None] = {}  # in order

    def scope(self, binding: Binding, *prefixes: str) -> Scope:
        """What names mean for a part with these parameters, in these surroundings."""
        return Scope(self.declarations.types, prefixes, binding)

    def predicate(self, text: Predicate, scope: Scope) -> Expression:
        """A condition."""
        return self._condition(text, scope, lambda written: resolve_predicate(parse(written), scope))

    def formula(self, text: Predicate, scope: Scope) -> Expression:
        """A formula of linear temporal logic over finite traces."""
        return self._condition(text, scope, lambda written: resolve_formula(parse_formula(written), scope))

    def actions(
        self, texts: Iterable[SourceText], scope: Scope, guard: Expression, writing: Writing
    ) -> tuple[Assignment, ...]:
        """The actions of one transition, taken under `guard`."""
        actions: dict[str, Assignment] = {}
        for text in texts:
            action = self._action(text, scope)
            if action is None:
                continue
            name = target(action)
            variable = self.declarations.variables.get(name)
            if variable is None or variable.kind not in writing.kinds:
                kind = _KINDS[variable.kind] if variable else _not_a_variable(name)
                permitted = " or ".join(writing.kinds)
                written = text[action.target.span.start : action.target.span.end]
                self.findings.add(text, f"{writing.what} writes {permitted} variables, and `{written}` is {kind}")
            elif name in actions:
                self.findings.add(text, f"`{name}` is written twice by one transition")
            elif action.condition != FALSE:
                actions[name] = action
                self._check_fits(text, action, guard)
                if Kind.MEASURED in writing.kinds:
                    self.check_observable(text, action.value, action.condition or TRUE)
        return tuple(actions.values())

    def check_observable(self, text: SourceText, *read: Expression) -> None:
        """A device knows nothing of what we believe, and an emulated one only hears messages."""
        for seen in (each for expression in read for each in occurrences(expression)):
            variable = self.declarations.variables.get(seen.name)
            if variable is None or variable.kind is Kind.ESTIMATED:
                written = text[seen.span.start : seen.span.end]
                message = f"an effect depends on measured and output variables only, and `{written}` is neither"
                self.findings.add_within(text, seen.span, message)

    @property
    def activities(self) -> dict[str, VariableDeclaration]:
        """The activities of operations that some text reads."""
        return {name: VariableDeclaration(name, BOOLEAN, Kind.ACTIVITY, False, None) for name in self._activities}

    def take(self, findings: Iterable[Finding], activities: Iterable[str]) -> None:
        """Take over what was noted of a part that was read by itself."""
        self.findings.all.extend(findings)
        self._activities |= dict.fromkeys(activities)

    def _condition(self, text: Predicate, scope: Scope, read: Callable[[SourceText], Expression]) -> Expression:
        if not isinstance(text, SourceText):
            return Constant(bool(text))
        try:
            return self._noted(text, simplify(read(text)))
        except ExpressionError as error:
            self._misread(text, error, scope)
            return FALSE

    def _action(self, text: SourceText, scope: Scope) -> Assignment | None:
        try:
            action = simplify_assignment(resolve_assignment(parse_assignment(text), scope))
        except ExpressionError as error:
            self._misread(text, error, scope)
            return None
        self._noted(text, action.value)
        self._noted(text, action.condition or TRUE)
        return action

    def _noted(self, text: SourceText, expression: Expression) -> Expression:
        """The meaning of `text`, whose readings of operations are kept in mind."""
        if OPERATION in text:
            read = (variable.name for variable in occurrences(expression))
            self._activities |= dict.fromkeys(name for name in read if name.startswith(f"{OPERATION}."))
        return expression

    def _check_fits(self, text: SourceText, action: Assignment, guard: Expression) -> None:
        if (found := misfit(action, guard)) is not None:
            advice = "add a condition to the guard, or with `if` to the action, under which it fits"
            self.findings.add_within(text, action.value.span, f"{found}: {advice}")

    def _misread(self, text: SourceText, error: ExpressionError, scope: Scope) -> None:
        name = without_arguments(text[error.span.start : error.span.end])
        owner = name.rpartition(".")[0]  # of a flag
        broken = self.declarations.broken
        if not any(prefix + one in broken for prefix in (*scope.prefixes, "") for one in (name, owner)):
            self.findings.add_within(text, error.span, error.message)
