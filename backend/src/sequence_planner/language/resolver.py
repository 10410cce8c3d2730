"""From names to variables and values, with types checked.

A name is looked up in this order: a parameter of the construct, then relative to its ability and its resource, then in
the whole station. A name beside a value of an enumeration may also be one of that enumeration's values.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from operator import itemgetter

from sequence_planner.core.immutable import Immutable
from sequence_planner.language.lexer import KEYWORDS, PREFIX_LETTERS
from sequence_planner.language.parser import temporal_refused
from sequence_planner.language.suggestions import beginning_with, nearest, nearest_of
from sequence_planner.language.syntax import (
    And,
    Arithmetic,
    Assignment,
    BinaryTemporal,
    Comparison,
    Component,
    Constant,
    Expression,
    ExpressionError,
    Implies,
    Membership,
    Name,
    Not,
    Or,
    RecordConstant,
    Selection,
    Span,
    UnaryTemporal,
    Variable,
    first_temporal,
)
from sequence_planner.language.types import (
    BOOLEAN,
    BooleanType,
    EnumerationType,
    IntegerRange,
    Type,
    contains,
)


class NameScope(Immutable):
    """The meaning of names at one place of a model.

    `variables` maps full names to types; `prefixes` are tried in order before the bare name (such as
    `nutrunner.run_nut.` and `nutrunner.`); `parameters` maps a parameter to its value and the enumeration it is of.
    """

    variables: Mapping[str, Type]
    prefixes: tuple[str, ...] = ()
    parameters: Mapping[str, tuple[str, EnumerationType]] = {}

    def substitute(self, name: Name) -> Name:
        """`name` with the parameters among its arguments replaced by their values."""
        if not self.parameters or name.is_word:
            return name
        parts = tuple(
            Component(part.name, tuple(self._argument(word) for word in part.arguments), part.indexed)
            for part in name.path
        )
        return Name(parts, name.span)

    def find(self, name: Name) -> Variable | None:
        """The variable of that name, or None."""
        text = str(self.substitute(name))
        for prefix in self.prefixes:
            if (found := self.variables.get(prefix + text)) is not None:
                return Variable(prefix + text, found, name.span)
        found = self.variables.get(text)
        return None if found is None else Variable(text, found, name.span)

    def _argument(self, word: str) -> str:
        return self.parameters[word][0] if word in self.parameters else word

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The full names of all variables."""
        return tuple(self.variables)

    def short(self, beginning: str = "") -> list[str]:
        """Return what names that begin so are here without a prefix."""
        found = ((prefix, beginning_with(prefix + beginning, self.names)) for prefix in self.prefixes)
        return [name.removeprefix(prefix) for prefix, names in found for name in names]


def resolve_predicate(expression: Expression, scope: NameScope) -> Expression:
    """`expression` with all names resolved, checked to be a truth value. Raises `ExpressionError`."""
    return _truth(expression, scope)


def resolve_formula(formula: Expression, scope: NameScope) -> Expression:
    """A formula of LTL over finite traces with all names resolved. Raises `ExpressionError`."""

    def part(inner: Expression) -> Expression:
        return resolve_formula(inner, scope)

    span = formula.span
    match formula:
        case Not(operand):
            return Not(part(operand), span)
        case And(operands):
            return And(tuple(map(part, operands)), span)
        case Or(operands):
            return Or(tuple(map(part, operands)), span)
        case Implies(left, right):
            return Implies(part(left), part(right), span)
        case UnaryTemporal(operator, operand):
            return UnaryTemporal(operator, part(operand), span)
        case BinaryTemporal(operator, left, right):
            return BinaryTemporal(operator, part(left), part(right), span)
    if (inside := first_temporal(formula)) is not None:
        what = "a temporal formula is no part of a comparison, a sum or `in {...}`"
        raise ExpressionError(f"`{inside.operator}` is a temporal operator here: {what}", inside.span)
    return resolve_predicate(formula, scope)


def resolve_assignment(action: Assignment, scope: NameScope) -> Assignment:
    """An action with all names resolved. Raises `ExpressionError`, also when no value it can have is in the target's
    domain; whether each it has where it is taken is, `fitting` says.
    """
    if not isinstance(action.target, Name):
        raise TypeError("the action is resolved already")
    if str(action.target) in scope.parameters:
        raise ExpressionError(f"`{action.target}` is a parameter: only variables are written", action.target.span)
    target = scope.find(action.target)
    if target is None:
        raise _unknown(action.target, scope, ())
    value = _written(action.value, scope, target.type)
    condition = None if action.condition is None else resolve_predicate(action.condition, scope)
    return Assignment(target, value, condition, action.span)


def type_of(expression: Expression, scope: NameScope) -> Type:
    """The type of an expression with names. Raises `ExpressionError`."""
    return _typed(expression, scope, None)[1]


def suggestion(word: str, candidates: Iterable[str], likeness: float = 0.5) -> str:
    """`; did you mean ...?` with the nearest of `candidates`, or nothing."""
    return _said(nearest(word, candidates, likeness))


def _said(*near: tuple[float, str] | None) -> str:
    """The one that is most like it, the first of those that are equally."""
    found = [each for each in near if each is not None]
    return f"; did you mean `{max(found, key=itemgetter(0))[1]}`?" if found else ""


def _truth(expression: Expression, scope: NameScope) -> Expression:
    resolved, found = _typed(expression, scope, BOOLEAN)
    if not isinstance(found, BooleanType):
        raise _expected(BOOLEAN, found, expression)
    return resolved


def _written(expression: Expression, scope: NameScope, expected: Type) -> Expression:
    resolved, found = _typed(expression, scope, expected)
    fits = contains(expected, resolved.value) if isinstance(resolved, Constant) else _overlap(found, expected)
    if not fits:
        raise _expected(expected, found, expression)
    return resolved


def _expected(expected: Type, found: Type, expression: Expression) -> ExpressionError:
    message = f"expected {_describe(expected)}, found {_describe(found)}{_truth_value(expected, found)}"
    return ExpressionError(message, expression.span)


def _truth_value(expected: Type, found: Type) -> str:
    """Say what to write for 0 and 1 where a truth value is meant."""
    if expected != BOOLEAN or found not in (IntegerRange(0, 0), IntegerRange(1, 1)):
        return ""
    return "; write true" if found == IntegerRange(1, 1) else "; write false"


def _overlap(one: Type, other: Type) -> bool:
    """Return whether the two have a value in common."""
    if isinstance(one, IntegerRange) and isinstance(other, IntegerRange):
        return one.minimum <= other.maximum and other.minimum <= one.maximum
    if isinstance(one, EnumerationType) and isinstance(other, EnumerationType):
        return not set(one.values).isdisjoint(other.values)
    return type(one) is type(other)


def _describe(type_: Type) -> str:
    match type_:
        case BooleanType():
            return "a truth value"
        case IntegerRange(minimum, maximum):
            return f"the integer {minimum}" if minimum == maximum else f"an integer in {type_}"
        case EnumerationType((single,)):
            return f"the value `{single}`"
        case EnumerationType():
            return f"one of {type_}"


def _typed(expression: Expression, scope: NameScope, expected: Type | None) -> tuple[Expression, Type]:
    span = expression.span
    match expression:
        case Constant(value):
            if isinstance(value, bool):
                return expression, BOOLEAN
            if isinstance(value, int):
                return expression, IntegerRange(value, value)
            return expression, EnumerationType((value,))
        case Name():
            return _named(expression, scope, expected)
        case Variable(_, type_):
            return expression, type_
        case Not(operand):
            return Not(_truth(operand, scope), span), BOOLEAN
        case And(operands):
            return And(tuple(_truth(o, scope) for o in operands), span), BOOLEAN
        case Or(operands):
            return Or(tuple(_truth(o, scope) for o in operands), span), BOOLEAN
        case Implies(left, right):
            return Implies(_truth(left, scope), _truth(right, scope), span), BOOLEAN
        case Comparison(operator, left, right):
            return _comparison(operator, left, right, span, scope), BOOLEAN
        case Membership(left, options):
            subject, type_ = _typed(left, scope, None)
            members = tuple(_comparable(option, type_, scope) for option in options)
            return Membership(subject, members, span), BOOLEAN
        case Arithmetic("+" | "-" as operator, left, right):
            return _arithmetic(operator, left, right, span, scope)
        case Arithmetic() | RecordConstant() | Selection():
            raise ExpressionError(
                "products, real numbers, texts and items stand only in expressions over records", span
            )
        case UnaryTemporal(operator) | BinaryTemporal(operator):
            raise temporal_refused(operator, span)


def _named(name: Name, scope: NameScope, expected: Type | None) -> tuple[Expression, Type]:
    word = str(name)
    if word in scope.parameters:
        value, type_ = scope.parameters[word]
        return Constant(value, name.span), type_
    variable = scope.find(name)
    values = _names(expected) if expected is not None else ()
    if word in values:
        if variable is not None and isinstance(variable.type, EnumerationType):
            raise ExpressionError(f"`{word}` is both a value and a variable here: rename one of them", name.span)
        return Constant(word, name.span), EnumerationType((word,))
    if variable is None:
        raise _unknown(name, scope, values)
    return variable, variable.type


def _unknown(name: Name, scope: NameScope, values: Iterable[str]) -> ExpressionError:
    first = name.path[0]
    if len(name.path) == 1 and first.name in PREFIX_LETTERS and first.arguments and not first.indexed:
        return temporal_refused(first.name, name.span)
    what = "variable or value" if values else "variable"
    return ExpressionError(f"unknown {what} `{name}`{_meant(name, scope, values)}", name.span)


def _meant(name: Name, scope: NameScope, values: Iterable[str]) -> str:
    """Say what to write in place of an unknown name, as far as that can be guessed."""
    word = str(name)
    if word.lower() in KEYWORDS:
        return f"; write {word.lower()}"
    if (last := name.path[-1].name) in values:
        return f"; did you mean `{last}`?"
    begun = dict.fromkeys((*scope.short(word + "."), *beginning_with(word + ".", scope.names)))
    flags = [other for other in begun if "." not in other[len(word) + 1 :]]
    if 0 < len(flags) < 4:  # an ability or operation, and no resource
        return f"; write {' or '.join(flags)}"
    own = [*values, *scope.short(), *scope.parameters]
    if near := _suggestion_of(word, own, scope.names, 0.7):
        return near
    if values:
        return _suggestion_of(word, own, scope.names, 0.5) or f"; write one of {', '.join(values)}"
    owners = [other for other, type_ in scope.variables.items() if word in _names(type_)]
    for prefix in (*scope.prefixes, ""):
        if (owner := next((other for other in owners if other.startswith(prefix)), None)) is not None:
            return f"; a value stands beside its variable, as in `{owner.removeprefix(prefix)} == {word}`"
    return _suggestion_of(word, own, scope.names, 0.5)


def _suggestion_of(word: str, own: Iterable[str], names: tuple[str, ...], likeness: float) -> str:
    return _said(nearest(word, own, likeness), nearest_of(word, names, likeness))


def _names(type_: Type) -> tuple[str, ...]:
    return type_.values if isinstance(type_, EnumerationType) else ()


def _comparison(operator: str, left: Expression, right: Expression, span: Span, scope: NameScope) -> Expression:
    # A bare word may be a value whose enumeration only the other side tells, so the side that stands alone goes first.
    swapped = _needs_enumeration(left, scope, right)
    first, second = (right, left) if swapped else (left, right)
    subject, type_ = _typed(first, scope, None)
    other = _comparable(second, type_, scope)
    if operator not in ("==", "!=") and not isinstance(type_, IntegerRange):
        raise ExpressionError(f"`{operator}` compares integers, not {_describe(type_)}", span)
    return Comparison(operator, *((other, subject) if swapped else (subject, other)), span)


def _needs_enumeration(word: Expression, scope: NameScope, other: Expression) -> bool:
    """Return whether `word`, left of a comparison, is to be read as a value of what stands on the `other` side."""
    if not isinstance(word, Name) or str(word) in scope.parameters:
        return False
    if scope.find(word) is None:
        unknown = isinstance(other, Name) and str(other) not in scope.parameters and scope.find(other) is None
        # With two unknown words, the one to complain about is the one that is nobody's value.
        return not unknown or (_is_a_value(word, scope) and not _is_a_value(other, scope))
    variable = scope.find(other) if isinstance(other, Name) else None
    return variable is not None and isinstance(variable.type, EnumerationType) and str(word) in variable.type.values


def _is_a_value(word: Expression, scope: NameScope) -> bool:
    return any(str(word) in _names(type_) for type_ in scope.variables.values())


def _comparable(expression: Expression, type_: Type, scope: NameScope) -> Expression:
    """`expression` resolved beside something of `type_`, with which it must have a value in common."""
    resolved, found = _typed(expression, scope, type_)
    # A parameter counts with all its values, so that an ability means the same for each of them.
    if not _overlap(found, type_):
        hint = _truth_value(type_, found)
        raise ExpressionError(f"cannot compare {_describe(type_)} with {_describe(found)}{hint}", expression.span)
    return resolved


def _arithmetic(
    operator: str, left: Expression, right: Expression, span: Span, scope: NameScope
) -> tuple[Expression, Type]:
    parts = [_typed(side, scope, None) for side in (left, right)]
    for side, (_, type_) in zip((left, right), parts, strict=True):
        if not isinstance(type_, IntegerRange):
            raise ExpressionError(f"`{operator}` needs integers, found {_describe(type_)}", side.span)
    (a, range_a), (b, range_b) = parts
    assert isinstance(range_a, IntegerRange)
    assert isinstance(range_b, IntegerRange)
    if operator == "+":
        result = IntegerRange(range_a.minimum + range_b.minimum, range_a.maximum + range_b.maximum)
    else:
        result = IntegerRange(range_a.minimum - range_b.maximum, range_a.maximum - range_b.minimum)
    return Arithmetic(operator, a, b, span), result
