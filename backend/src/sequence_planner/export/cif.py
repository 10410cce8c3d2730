"""Export of a plain automaton to CIF 3 (Eclipse ESCET) for data-based supervisor synthesis."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.steps import plain_transitions
from sequence_planner.automaton.transitions import Transition
from sequence_planner.export.efa import different, word
from sequence_planner.language.evaluator import RELATIONS
from sequence_planner.language.syntax import (
    TRUE,
    And,
    Arithmetic,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
    conjunction,
    conjuncts,
)
from sequence_planner.language.types import BooleanType, EnumerationType, IntegerRange, Type, Value

# Expressions in the language CIF, in as few forms as its data-based synthesis has always read.
#
# Enumerations of CIF have values of their own, and its integers are not negative here: a range that is has been moved
# to begin at 0. A comparison of sums is written with sums of positive terms on both sides.

_RELATIONS = {"==": "=", "!=": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}


# Strength of binding, as far as brackets are left out; `not` before a relation always has them.
_COMPOUND, _RELATION, _ATOM = range(3)


@dataclass(frozen=True)
class Text:
    """A predicate as text, and how strongly its parts are bound."""

    text: str
    strength: int = _COMPOUND

    def part(self, place: int) -> str:
        """The text as a part of another: in brackets where its parts would be bound less than `place` needs."""
        return self.text if self.strength >= place else f"({self.text})"


_TRUE, _FALSE = Text("true", _ATOM), Text("false", _ATOM)


def offset(type_: Type) -> int:
    """Return what is added to the values of an integer range so that none is negative."""
    return max(0, -type_.minimum) if isinstance(type_, IntegerRange) else 0


@dataclass(frozen=True)
class Writer:
    """Writes resolved expressions. `variables` names each variable, `literals` the values of each enumeration."""

    variables: Mapping[str, str]
    literals: Mapping[EnumerationType, Mapping[str, str]]

    def predicate(self, expression: Expression) -> Text:
        """A truth value."""
        match expression:
            case Constant(value):
                return _TRUE if value else _FALSE
            case Variable(name):
                return Text(self.variables[name], _ATOM)
            case Not(operand):
                return self._not(self.predicate(operand))
            case And(operands):
                return _joined("and", map(self.predicate, operands), _TRUE)
            case Or(operands):
                return _joined("or", map(self.predicate, operands), _FALSE)
            case Implies(left, right):
                return Text(f"{self.predicate(left).part(_ATOM)} => {self.predicate(right).part(_ATOM)}")
            case Comparison(relation, left, right):
                return self._compared(relation, left, right)
            case Membership(left, options):
                return _joined("or", (self._compared("==", left, option) for option in options), _FALSE)
            case _:
                raise TypeError(f"{expression} is no predicate of a state")

    def literal(self, type_: Type, value: Value) -> str:
        """A value of that type."""
        if isinstance(value, bool):
            return "true" if value else "false"
        return str(value + offset(type_)) if isinstance(value, int) else self.literals[_enumeration(type_)][value]

    def value(self, expression: Expression, type_: Type) -> str:
        """Return what is written to a variable of that type: a variable of another enumeration cannot be."""
        if isinstance(type_, BooleanType):
            return self.predicate(expression).text
        if isinstance(expression, Constant):
            return self.literal(type_, expression.value)
        if isinstance(type_, EnumerationType):
            assert isinstance(expression, Variable)
            assert expression.type == type_
            return self.variables[expression.name]
        terms, constant = _sum(expression)
        constant += offset(type_)
        added = [*self._terms(terms), *([str(constant)] if constant > 0 else [])] or ["0"]
        taken = [*self._terms(-terms), *([str(-constant)] if constant < 0 else [])]
        return " - ".join([" + ".join(added), *taken])

    def _terms(self, terms: Counter[str]) -> list[str]:
        """Those that are added, each as often as it is."""
        return [self.variables[name] for name in terms.elements()]

    def _not(self, operand: Text) -> Text:
        return Text(f"not {operand.part(_ATOM)}", _RELATION)

    def _compared(self, relation: str, left: Expression, right: Expression) -> Text:
        if _is_named(left) or _is_named(right):
            return self._alike(relation, left, right)
        if _is_integer(left) or _is_integer(right):
            return self._sums(relation, left, right)
        equal = Text(f"{self.predicate(left).part(_ATOM)} <=> {self.predicate(right).part(_ATOM)}")
        return equal if relation == "==" else self._not(equal)

    def _alike(self, relation: str, left: Expression, right: Expression) -> Text:
        """Write whether two variables of enumerations, or one and a value, have the same value."""
        if isinstance(left, Constant):
            left, right = right, left
        if isinstance(left, Constant) and isinstance(right, Constant):
            return _TRUE if RELATIONS[relation](left.value, right.value) else _FALSE
        assert isinstance(left, Variable)
        name = self.variables[left.name]
        of_left = self.literals[_enumeration(left.type)]
        if isinstance(right, Constant):
            known = of_left.get(str(right.value))
            if known is None:
                return _FALSE if relation == "==" else _TRUE
            return Text(f"{name} {_RELATIONS[relation]} {known}", _RELATION)
        assert isinstance(right, Variable)
        other = self.variables[right.name]
        if left.type == right.type:
            return Text(f"{name} {_RELATIONS[relation]} {other}", _RELATION)
        of_right = self.literals[_enumeration(right.type)]
        shared = (
            Text(f"{name} = {literal} and {other} = {of_right[value]}")
            for value, literal in of_left.items()
            if value in of_right
        )
        equal = _joined("or", shared, _FALSE)
        return equal if relation == "==" else self._not(equal)

    def _sums(self, relation: str, left: Expression, right: Expression) -> Text:
        (terms, constant), (subtracted, other) = _sum(left), _sum(right)
        difference = Counter(terms)
        difference.subtract(subtracted)
        constant -= other
        if not any(difference.values()):
            return _TRUE if RELATIONS[relation](constant, 0) else _FALSE
        first = [*self._terms(difference), *([str(constant)] if constant > 0 else [])] or ["0"]
        second = [*self._terms(-difference), *([str(-constant)] if constant < 0 else [])] or ["0"]
        return Text(f"{' + '.join(first)} {_RELATIONS[relation]} {' + '.join(second)}", _RELATION)


def cases_of_copies(
    actions: Iterable[tuple[Variable, Expression]],
) -> Iterator[tuple[tuple[tuple[Variable, Value], ...], dict[str, Value]]]:
    """For actions that copy variables of other enumerations: each case in which these have values that fit.

    A case is what the copied variables have, and what is written to which variable.
    """
    cases: list[tuple[tuple[tuple[Variable, Value], ...], dict[str, Value]]] = [((), {})]
    for to, value in actions:
        if isinstance(to.type, EnumerationType) and isinstance(value, Variable) and value.type != to.type:
            shared = [each for each in value.type.domain if each in to.type.domain]
            cases = [((*has, (value, v)), {**written, to.name: v}) for has, written in cases for v in shared]
    yield from (case for case in cases if len(dict(case[0])) == len(set(case[0])))


def _joined(operator: str, parts: Iterable[Text], empty: Text) -> Text:
    texts = list(parts)
    if len(texts) < 2:
        return texts[0] if texts else empty
    return Text(f" {operator} ".join(part.part(_RELATION) for part in texts))


def _is_named(expression: Expression) -> bool:
    """Return whether it is of an enumeration."""
    match expression:
        case Constant(value):
            return isinstance(value, str)
        case Variable(_, type_):
            return isinstance(type_, EnumerationType)
        case _:
            return False


def _is_integer(expression: Expression) -> bool:
    match expression:
        case Constant(value):
            return isinstance(value, int) and not isinstance(value, bool)
        case Variable(_, type_):
            return isinstance(type_, IntegerRange)
        case _:
            return isinstance(expression, Arithmetic)


def _sum(expression: Expression) -> tuple[Counter[str], int]:
    """Return how often each variable, as it is written in CIF, is added, and the constant that is."""
    match expression:
        case Constant(value):
            return Counter(), int(value)
        case Variable(name, type_):
            return Counter((name,)), -offset(type_)
        case Arithmetic(sign, left, right):
            (terms, constant), (others, other) = _sum(left), _sum(right)
            total = Counter(terms)
            (total.update if sign == "+" else total.subtract)(others)
            return total, constant + other if sign == "+" else constant - other
        case _:
            raise TypeError(f"{expression} is no sum")


def _enumeration(type_: Type) -> EnumerationType:
    assert isinstance(type_, EnumerationType)
    return type_


# Identifiers of the language CIF: its words, which need a `$` in front to be names.

CIF_WORDS = frozenset(
    re.findall(
        r"\w+",
        """
        alg alphabet annotation any attr automaton bool break case const cont continue controllable def der dict
        disables disc dist do edge elif else end enum equation event external false file final for func goto group
        id if import initial input int invariant list location marked monitor namespace needs now plant post pre
        print printfile real requirement return self set string supervisor svgcopy svgfile svgin svgmove svgout
        switch tau text time to true tuple type uncontrollable urgent value void when while acosh acos asinh asin
        atanh atan cosh cos sinh sin tanh tan abs cbrt ceil del empty exp floor fmt ln log max min pop pow round
        scale sign size sqrt bernoulli beta binomial constant erlang exponential gamma geometric lognormal normal
        poisson random triangle uniform weibull and div in mod not or sample sub
        """,
    )
)


def identifier(name: str) -> str:
    """A word that resembles `name`, escaped if it means something in CIF: `robot.pose` becomes `robot_pose`."""
    plain = word(name)
    return f"${plain}" if plain in CIF_WORDS else plain


# A plain automaton in the language CIF 3 of Eclipse ESCET, for its data-based supervisor synthesis.
#
# One plant automaton with one location has all variables and edges; what is forbidden is a requirement. Sources: the
# language reference of CIF, "Lexical syntax", and "Specifications supported by data-based synthesis".


def cif_text(automaton: Automaton) -> str:
    """The CIF specification of a plain automaton, in ASCII. Goals are left out: CIF has none."""
    return "\n".join(_Specification(automaton).lines()) + "\n"


class _Specification:
    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._transitions = plain_transitions(automaton)
        types = list(dict.fromkeys(v.type for v in automaton.variables.values() if isinstance(v.type, EnumerationType)))
        owners = {type_: n for n, v in reversed(list(automaton.variables.items())) if (type_ := v.type) in types}
        # All names are in one scope, so that none hides another. A tuple says what each one names.
        parts = [("automaton", automaton.name)]
        parts += [("variable", name) for name in automaton.variables]
        parts += [("event", event_of(name)) for name in self._transitions]
        parts += [("enumeration", f"{word(owners[type_])}_values") for type_ in types]
        parts += [("literal", f"{word(owners[type_])}_{value}") for type_ in types for value in type_.values]
        self._names = different(parts, lambda part: identifier(part[1]))
        self._types = {type_: self._names["enumeration", f"{word(owners[type_])}_values"] for type_ in types}
        literals = {
            type_: {value: self._names["literal", f"{word(owners[type_])}_{value}"] for value in type_.values}
            for type_ in types
        }
        self._variables = {name: self._names["variable", name] for name in automaton.variables}
        self._writer = Writer(self._variables, literals)
        self._literals = literals

    def lines(self) -> Iterator[str]:
        """The lines of the text."""
        automaton = self._automaton
        yield f"// {_ascii(automaton.title)}"
        for (kind, name), found in self._names.items():
            if found != name and kind in ("variable", "event"):
                yield f"// {found}: {_ascii(name)}"
        yield from self._moved()
        for type_, name in self._types.items():
            yield f"enum {name} = {', '.join(self._literals[type_].values())};"
        for event, controllable in {event_of(n): t.controllable for n, t in self._transitions.items()}.items():
            yield f"{'controllable' if controllable else 'uncontrollable'} {self._names['event', event]};"
        yield ""
        yield f"plant automaton {self._names['automaton', automaton.name]}:"
        yield from (f"  {line}" for line in self._declarations())
        for specification in automaton.specifications.values():
            yield f"  // {_ascii(specification.title)}"
            yield f"  requirement invariant {self._writer.predicate(Not(specification.forbidden)).text};"
        yield "  location:"
        yield f"    initial{self._where(automaton.initial)};"
        yield f"    marked{self._where(automaton.rest)};"
        for name, transition in self._transitions.items():
            yield from (f"    {line}" for line in self._edges(self._names["event", event_of(name)], transition))
        yield "end"

    def _moved(self) -> Iterator[str]:
        for name, variable in self._automaton.variables.items():
            if by := offset(variable.type):
                yield f"// {self._variables[name]} is {by} more than the value, which can be negative"

    def _declarations(self) -> Iterator[str]:
        """The variables; with several initial states, a predicate says which values these have."""
        for name, variable in self._automaton.variables.items():
            of_one = f"= {self._writer.literal(variable.type, variable.initial)}"
            initial = of_one if self._automaton.initial is None else "in any"
            yield f"disc {self._type(variable.type)} {self._variables[name]} {initial};"

    def _type(self, type_: Type) -> str:
        if isinstance(type_, IntegerRange):
            return f"int[{type_.minimum + offset(type_)}..{type_.maximum + offset(type_)}]"
        return self._types[type_] if isinstance(type_, EnumerationType) else "bool"

    def _where(self, predicate: Expression | None) -> str:
        return "" if predicate is None else f" {self._writer.predicate(predicate).text}"

    def _edges(self, event: str, transition: Transition) -> Iterator[str]:
        """One edge, or one for each value of what is copied to a variable of another enumeration."""
        actions = [(a.target, a.value) for a in transition.actions if isinstance(a.target, Variable)]
        for has, written in cases_of_copies(actions):
            equal = (Comparison("==", variable, Constant(value)) for variable, value in has)
            guard = conjunction(*conjuncts(transition.guard), *equal)
            updates = [
                f"{self._variables[to.name]} := "
                + self._writer.value(Constant(written[to.name]) if to.name in written else value, to.type)
                for to, value in actions
            ]
            when = "" if guard == TRUE else f" when {self._writer.predicate(guard).text}"
            do = f" do {', '.join(updates)}" if updates else ""
            yield f"edge {event}{when}{do};"


def _ascii(text: str) -> str:
    """Text for a comment: one line, and no sign that a file in CIF cannot have."""
    return " ".join(text.split()).encode("ascii", "backslashreplace").decode("ascii")
