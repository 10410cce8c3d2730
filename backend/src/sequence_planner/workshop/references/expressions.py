"""The names in conditions, formulas and actions, with the values that stand beside what they are values of."""

from __future__ import annotations

from sequence_planner.expressions.parser import parse, parse_assignment, parse_formula
from sequence_planner.expressions.syntax import (
    Assignment,
    Comparison,
    Expression,
    ExpressionError,
    Membership,
    Name,
    children,
)
from sequence_planner.model.source import SourceText
from sequence_planner.workshop.references.naming import Named, Naming, steps_of
from sequence_planner.workshop.references.occurrences import Where
from sequence_planner.workshop.references.parts import value_of


class Expressions:
    """Reads texts of the language; what they name is noted by `naming`. With `word`, only texts that hold it."""

    def __init__(self, naming: Naming, word: str | None = None) -> None:
        self.naming = naming
        self._word = word

    def condition(self, written: object, where: Where, *, is_formula: bool = False) -> None:
        """A predicate, or a formula over runs."""
        if (text := self._wanted(written)) is None:
            return
        try:
            tree = parse_formula(text) if is_formula else parse(text)
        except ExpressionError:
            self.naming.gathered.unread.append((where, text))
            return
        _Reading(self.naming, text, where, self._word).read(tree)

    def actions(self, written: object, where: Where) -> None:
        """A list of actions."""
        for index, each in enumerate(written if isinstance(written, list) else []):
            if (text := self._wanted(each)) is None:
                continue
            try:
                action = parse_assignment(text)
            except ExpressionError:
                self.naming.gathered.unread.append((where.to(index), text))
                continue
            _Reading(self.naming, text, where.to(index), self._word).assignment(action)

    def _wanted(self, written: object) -> SourceText | None:
        is_wanted = isinstance(written, SourceText) and (self._word is None or self._word in written)
        return written if is_wanted and isinstance(written, SourceText) else None


class _Reading:
    """One text. The order in which names are looked at is that of `expressions.resolution`."""

    def __init__(self, naming: Naming, text: SourceText, where: Where, word: str | None) -> None:
        self._word = word
        self._naming = naming
        self._text = text
        self._where = where

    def assignment(self, action: Assignment) -> None:
        """What it writes, what that becomes, and when."""
        assert isinstance(action.target, Name)
        expected = self._name(action.target, None, writes=True)
        found = self.read(action.value, expected)
        self._naming.link(expected, found)
        if action.condition is not None:
            self.read(action.condition)

    def read(self, expression: Expression, expected: str | None = None) -> str | None:
        """Note all names; returns the enumeration over which the expression ranges, unless it is a value."""
        match expression:
            case Name():
                return self._name(expression, expected)
            case Comparison(_, left, right):
                self._compare(*((right, left) if self._is_value_first(left, right) else (left, right)))
            case Membership(left, options):
                enumeration = self.read(left)
                for option in options:
                    self._naming.link(enumeration, self.read(option, enumeration))
            case _:
                for part in children(expression):
                    self.read(part)
        return None

    def _compare(self, first: Expression, second: Expression) -> None:
        enumeration = self.read(first)
        self._naming.link(enumeration, self.read(second, enumeration))

    def _name(self, name: Name, expected: str | None, *, writes: bool = False) -> str | None:
        word, around = str(name), self._where.around
        named = self._naming.find(name, around)
        is_value = expected is not None and name.is_word and self._naming.has(expected, word)
        if expected is not None and is_value and word not in around.parameters:
            value = value_of(expected, word)
            self._naming.gathered.add(value, self._where, self._text, name.span)
            if named is not None and named.enumeration is not None:
                self._naming.gathered.hidden.add((named.parts[max(named.parts)], value))
            return None
        if self._word is None or self._word in word:
            steps = steps_of(name, self._text)
            named = named or self._naming.implied(steps, around)
            if named is not None:
                self._naming.note(named, steps, self._where, self._text, writes=writes)
        return None if named is None else named.enumeration

    def _is_value_first(self, left: Expression, right: Expression) -> bool:
        """Whether the left of a comparison is to be read as a value of what stands on its right."""
        if not isinstance(left, Name) or not left.is_word or self._is_parameter(left):
            return False  # values are single words
        other = self._found(right)
        if self._found(left) is None:
            unknown = isinstance(right, Name) and not self._is_parameter(right) and other is None
            return not unknown or (self._is_some_value(left) and not self._is_some_value(right))
        enumeration = None if other is None or self._is_parameter(right) else other.enumeration
        return enumeration is not None and self._naming.has(enumeration, str(left))

    def _found(self, expression: Expression) -> Named | None:
        if not isinstance(expression, Name):
            return None
        return self._naming.find(expression, self._where.around)

    def _is_parameter(self, expression: Expression) -> bool:
        return isinstance(expression, Name) and str(expression) in self._where.around.parameters

    def _is_some_value(self, expression: Expression) -> bool:
        return isinstance(expression, Name) and str(expression) in self._naming.declared.values
