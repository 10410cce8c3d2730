"""A text as the printer writes it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from sequence_planner.expressions.parser import parse, parse_assignment, parse_formula
from sequence_planner.expressions.printing import print_assignment, print_expression
from sequence_planner.expressions.syntax import ExpressionError
from sequence_planner.workshop.language.field import Field, FieldKind

_FORMS: dict[FieldKind, tuple[Callable[[str], Any], Callable[[Any], str]]] = {
    FieldKind.CONDITION: (parse, print_expression),
    FieldKind.FORMULA: (parse_formula, print_expression),
    FieldKind.ACTION: (parse_assignment, print_assignment),
    FieldKind.ABILITY: (parse, print_expression),
}


def formatted(field: Field, text: str) -> str:
    """`text` with one space between words and no bracket too many; it means the same, in the same names.

    What does not parse stays as it is, and so does what is no expression.
    """
    if field.kind not in _FORMS:
        return text
    read, write = _FORMS[field.kind]
    try:
        tree = read(text)
        printed = write(tree)
        return printed if read(printed) == tree else text
    except ExpressionError:
        return text
