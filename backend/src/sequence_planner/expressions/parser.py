"""Recursive descent from words to the tree, loosest binding first.

expression = disjunction ["implies" expression]
disjunction = conjunction {"or" conjunction}
conjunction = negation {"and" negation}
negation = "not" negation | relation
relation = sum [("==" | "!=" | "<" | "<=" | ">" | ">=") sum | "in" "{" sum {"," sum} "}"]
sum = atom {("+" | "-") atom}
atom = "true" | "false" | ["-"] number | name | "(" expression ")"
name = part {"." part};  part = word ["(" word {"," word} ")" | "[" word {"," word} "]"]
assignment = name ":=" expression ["if" expression]
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from sequence_planner.expressions.lexer import Token, tokens
from sequence_planner.expressions.syntax import (
    And,
    Arithmetic,
    Assignment,
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
    Span,
)

T = TypeVar("T")

# What reads a tree descends into it: deeper ones than any person writes would exhaust the stack.
MOST_NESTED = 30
MOST_SUMS = 50

_RELATIONS = ("==", "!=", "<", "<=", ">", ">=")


def parse(text: str) -> Expression:
    """The tree of one expression. Raises `ExpressionError` with the place of the first word that does not fit."""
    return _Parser(text).whole(_Parser.expression)


def parse_assignment(text: str) -> Assignment:
    """The tree of one action such as `bolts := tightened if pose == home`."""
    return _Parser(text).whole(_Parser.assignment)


class _Parser:
    def __init__(self, text: str) -> None:
        self._tokens = tokens(text)
        self._next = 0
        self._depth = 0
        self._sums = 0

    def whole(self, rule: Callable[[_Parser], T]) -> T:
        result = rule(self)
        self._expect("end", "an operator or the end")
        return result

    @property
    def _token(self) -> Token:
        return self._tokens[self._next]

    def _accept(self, *kinds: str) -> Token | None:
        token = self._token
        if token.kind not in kinds:
            return None
        self._next += token.kind != "end"
        return token

    def _expect(self, kind: str, what: str) -> Token:
        if (token := self._accept(kind)) is None:
            raise ExpressionError(f"expected {what}, found {self._token}", self._token.span)
        return token

    def _since(self, start: int) -> Span:
        return Span(start, self._tokens[max(self._next - 1, 0)].span.end)

    def _nested(self, rule: Callable[[], Expression], opening: Token) -> Expression:
        self._depth += 1
        if self._depth > MOST_NESTED:
            raise ExpressionError(f"nested more than {MOST_NESTED} deep: split it up", opening.span)
        result = rule()
        self._depth -= 1
        return result

    def assignment(self) -> Assignment:
        start = self._token.span.start
        target = self.name()
        self._expect(":=", "`:=`")
        value = self.expression()
        condition = self.expression() if self._accept("if") else None
        return Assignment(target, value, condition, self._since(start))

    def expression(self) -> Expression:
        start = self._token.span.start
        left = self.disjunction()
        if implies := self._accept("implies"):
            return Implies(left, self._nested(self.expression, implies), self._since(start))
        return left

    def disjunction(self) -> Expression:
        start = self._token.span.start
        parts = [self.conjunction()]
        while self._accept("or"):
            parts.append(self.conjunction())
        return parts[0] if len(parts) == 1 else Or(tuple(parts), self._since(start))

    def conjunction(self) -> Expression:
        start = self._token.span.start
        parts = [self.negation()]
        while self._accept("and"):
            parts.append(self.negation())
        return parts[0] if len(parts) == 1 else And(tuple(parts), self._since(start))

    def negation(self) -> Expression:
        start = self._token.span.start
        if not_ := self._accept("not"):
            return Not(self._nested(self.negation, not_), self._since(start))
        return self.relation()

    def relation(self) -> Expression:
        start = self._token.span.start
        left = self.sum()
        if operator := self._accept(*_RELATIONS):
            return Comparison(operator.text, left, self.sum(), self._since(start))
        if self._accept("in"):
            self._expect("{", "`{`, as in `pose in {home, above}`")
            options = [self.sum()]
            while self._accept(","):
                options.append(self.sum())
            self._expect("}", "`,` or `}`")
            return Membership(left, tuple(options), self._since(start))
        return left

    def sum(self) -> Expression:
        start = self._token.span.start
        left = self.atom()
        while operator := self._accept("+", "-"):
            self._sums += 1
            if self._sums > MOST_SUMS:
                raise ExpressionError(f"more than {MOST_SUMS} sums in one expression", operator.span)
            left = Arithmetic(operator.text, left, self.atom(), self._since(start))
        return left

    def atom(self) -> Expression:
        token = self._token
        if self._accept("true", "false"):
            return Constant(token.kind == "true", token.span)
        if self._accept("-"):
            number = self._expect("number", "a number")
            return Constant(-int(number.text), self._since(token.span.start))
        if self._accept("number"):
            return Constant(int(token.text), token.span)
        if self._accept("("):
            inner = self._nested(self.expression, token)
            self._expect(")", "`)`")
            return inner
        if token.kind == "name":
            return self.name()
        raise ExpressionError(f"expected a name, a value or `(`, found {token}", token.span)

    def name(self) -> Name:
        start = self._token.span.start
        parts = [self.component()]
        while self._accept("."):
            parts.append(self.component())
        return Name(tuple(parts), self._since(start))

    def component(self) -> Component:
        word = self._expect("name", "a name").text
        opening = self._accept("(", "[")
        if opening is None:
            return Component(word)
        arguments = [self._expect("name", "a value or parameter").text]
        while self._accept(","):
            arguments.append(self._expect("name", "a value or parameter").text)
        closing = {"(": ")", "[": "]"}[opening.kind]
        self._expect(closing, f"`,` or `{closing}`")
        return Component(word, tuple(arguments), opening.kind == "[")
