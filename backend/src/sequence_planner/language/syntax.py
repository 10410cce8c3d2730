"""The syntax tree of expressions and actions.

Parsing yields `Name` nodes; resolution replaces each by a `Variable` or a `Constant`. Spans are offsets into the
source text and take no part in comparison, so that equal expressions written at different places are equal.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple, Self

from sequence_planner.core.immutable import Immutable, uncompared
from sequence_planner.language.types import Type, Value


class Span(NamedTuple):
    """Half-open range of characters in the source text."""

    start: int
    end: int


NOWHERE = Span(0, 0)


class ExpressionError(Exception):
    """A text that is no expression, or one that means nothing here; `span` is the place within the text."""

    def __init__(self, message: str, span: Span) -> None:
        super().__init__(message)
        self.message = message
        self.span = span


class UnusableError(ExpressionError):
    """Something is used that is wrong where it is declared."""


class CircleError(ExpressionError):
    """A predicate needs itself, over those of `circle`, which begins and ends with it."""

    def __init__(self, circle: tuple[str, ...], span: Span) -> None:
        super().__init__(f"predicates need each other in a circle: {' → '.join(circle)}", span)
        self.circle = circle


class Constant(Immutable):
    """A truth value, an integer, or the name of an enumeration's value."""

    value: Value
    span: Span = uncompared(default=NOWHERE)


class ArgumentWord(str):
    """A word of a text, which knows where it stands there."""

    __slots__ = ("span",)
    span: Span

    def __new__(cls, text: str, span: Span) -> Self:
        """`text` stands at `span`."""
        self = super().__new__(cls, text)
        self.span = span
        return self

    def __reduce__(self) -> tuple[type[ArgumentWord], tuple[str, Span]]:
        return ArgumentWord, (str(self), self.span)


class Component(NamedTuple):
    """One part of a dotted name: `run_nut`, `move_to_position(above)`, `bolts[bolt_pair_1]`.

    An argument is a word, or a name that has a value itself, as in `bolts[previous(pair)]`.
    """

    name: str
    arguments: tuple[str | Name, ...] = ()
    indexed: bool = False

    def __str__(self) -> str:
        if not self.arguments:
            return self.name
        opening, closing = "[]" if self.indexed else "()"
        return f"{self.name}{opening}{', '.join(map(str, self.arguments))}{closing}"


class Name(Immutable):
    """A name not yet resolved: a variable, a flag, a parameter or a value."""

    path: tuple[Component, ...]
    span: Span = uncompared(default=NOWHERE)

    def __str__(self) -> str:
        return self._text

    @cached_property
    def _text(self) -> str:
        return self.path[0].name if self.is_word else ".".join(map(str, self.path))

    def argument(self, index: int) -> Name:
        """An argument of its last part."""
        written = self.path[-1].arguments[index]
        if isinstance(written, Name):
            return written
        return Name((Component(written),), written.span if isinstance(written, ArgumentWord) else self.span)

    @property
    def is_word(self) -> bool:
        """True if the name is a single word, without dots and arguments."""
        return len(self.path) == 1 and not self.path[0].arguments


class Variable(Immutable):
    """A variable by its full name, with its type."""

    name: str
    type: Type
    span: Span = uncompared(default=NOWHERE)


class Not(Immutable):
    """Negation."""

    operand: Expression
    span: Span = uncompared(default=NOWHERE)


class And(Immutable):
    """Conjunction of two or more."""

    operands: tuple[Expression, ...]
    span: Span = uncompared(default=NOWHERE)


class Or(Immutable):
    """Disjunction of two or more."""

    operands: tuple[Expression, ...]
    span: Span = uncompared(default=NOWHERE)


class Implies(Immutable):
    """`left implies right`."""

    left: Expression
    right: Expression
    span: Span = uncompared(default=NOWHERE)


class Comparison(Immutable):
    """`==`, `!=`, and on integers `<`, `<=`, `>`, `>=`."""

    operator: str
    left: Expression
    right: Expression
    span: Span = uncompared(default=NOWHERE)


class Membership(Immutable):
    """`left in {a, b}`."""

    left: Expression
    options: tuple[Expression, ...]
    span: Span = uncompared(default=NOWHERE)


class NamedMembership(Immutable):
    """`left in poses`: one of the values of a named set or enumeration. Resolution makes a `Membership` of it."""

    left: Expression
    domain: Name
    span: Span = uncompared(default=NOWHERE)


class Binder(Immutable):
    """`pair in bolt_pair`: a word that stands for each value of a named set or enumeration, or of those written."""

    word: str
    domain: Name | tuple[Name, ...]
    span: Span = uncompared(default=NOWHERE)


class Quantified(Immutable):
    """`all p in poses where p != home: is_free[p]`, and the like. Resolution writes it out.

    `quantifier` is `all`, `any`, `none`, `count`, or with a `number` `exactly`, `at least`, `at most`. `where` chooses
    among the values.
    """

    quantifier: str
    number: int | None
    binders: tuple[Binder, ...]
    where: Expression | None
    body: Expression
    span: Span = uncompared(default=NOWHERE)


class Arithmetic(Immutable):
    """`+` and `-` on integers; over records `+ - * /` on numbers."""

    operator: str
    left: Expression
    right: Expression
    span: Span = uncompared(default=NOWHERE)


class RecordConstant(Immutable):
    """A real number, or a text in single quotes; over records only."""

    value: float | str
    span: Span = uncompared(default=NOWHERE)


class Selection(Immutable):
    """`whole.x`, `whole[0]` or, if `called`, `whole(a, b)`: what stands behind a name is a name itself, or what is in
    its brackets; over records only, where the fields decide whether all of it is one name.
    """

    whole: Expression
    at: str | tuple[Expression, ...]
    span: Span = uncompared(default=NOWHERE)
    called: bool = False


class UnaryTemporal(Immutable):
    """`X` (next), `N` (next, if there is one), `F` (eventually) and `G` (always) before a formula."""

    operator: str
    operand: Expression
    span: Span = uncompared(default=NOWHERE)


class BinaryTemporal(Immutable):
    """`U` (until), `R` (release) and `W` (weak until) between two formulas."""

    operator: str
    left: Expression
    right: Expression
    span: Span = uncompared(default=NOWHERE)


Expression = (
    Constant
    | Name
    | Variable
    | Not
    | And
    | Or
    | Implies
    | Comparison
    | Membership
    | NamedMembership
    | Quantified
    | Arithmetic
    | RecordConstant
    | Selection
    | UnaryTemporal
    | BinaryTemporal
)


class Assignment(Immutable):
    """An action `target := value`, taken only where `condition` holds.

    With `binders`, as in `all pair in bolt_pair: bolts[pair] := empty`, one for each choice of their values; resolution
    writes these out.
    """

    target: Name | Variable
    value: Expression
    condition: Expression | None = None
    span: Span = uncompared(default=NOWHERE)
    binders: tuple[Binder, ...] = ()


TRUE = Constant(True)
FALSE = Constant(False)


def children(expression: Expression) -> tuple[Expression, ...]:
    """The direct parts of an expression, left to right."""
    match expression:
        case Not(operand) | UnaryTemporal(_, operand) | NamedMembership(operand):
            return (operand,)
        case Quantified(where=where, body=body):
            return (body,) if where is None else (where, body)
        case And(operands) | Or(operands):
            return operands
        case Implies(left, right):
            return (left, right)
        case Comparison(_, left, right) | Arithmetic(_, left, right) | BinaryTemporal(_, left, right):
            return (left, right)
        case Membership(left, options):
            return (left, *options)
        case Selection(whole, at):
            return (whole,) if isinstance(at, str) else (whole, *at)
        case Constant() | RecordConstant() | Name() | Variable():
            return ()


_JUNCTIONS = (And, Or)


def occurrences(expression: Expression) -> list[Variable]:
    """Each place where a resolved expression reads a variable, left to right."""
    found: list[Variable] = []
    pending = [expression]
    while pending:
        part = pending.pop()
        if isinstance(part, Variable):
            found.append(part)
        elif isinstance(part, Comparison):  # most are comparisons, or these
            pending += (part.right, part.left)
        elif isinstance(part, _JUNCTIONS):
            pending += reversed(part.operands)
        elif not isinstance(part, Constant):
            pending += reversed(children(part))
    return found


def variables(expression: Expression) -> list[str]:
    """Full names of the variables a resolved expression reads, with repetitions."""
    return [variable.name for variable in occurrences(expression)]


def first_temporal(expression: Expression) -> UnaryTemporal | BinaryTemporal | None:
    """The leftmost outermost temporal formula within `expression`, or None if it is an ordinary predicate."""
    if isinstance(expression, UnaryTemporal | BinaryTemporal):
        return expression
    found = (first_temporal(child) for child in children(expression))
    return next((formula for formula in found if formula is not None), None)


def conjuncts(expression: Expression) -> tuple[Expression, ...]:
    """The parts that must all hold."""
    if isinstance(expression, And):
        return tuple(part for operand in expression.operands for part in conjuncts(operand))
    return (expression,)


def conjunction(*parts: Expression) -> Expression:
    """All of `parts`; true when there is none."""
    needed = tuple(part for part in parts if part != TRUE)
    if not needed:
        return TRUE
    return needed[0] if len(needed) == 1 else And(needed)
