"""Predicates that come with a request, in the model's language."""

from __future__ import annotations

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.command_base import CommandRefused, TextPlace
from sequence_planner.expressions.parser import parse
from sequence_planner.expressions.resolution import Scope, resolve_predicate
from sequence_planner.expressions.syntax import Expression, ExpressionError


def read_predicate(automaton: Automaton, text: str) -> Expression:
    """What `text` means, with all names in full. Raises `CommandRefused`, which names the place."""
    try:
        return resolve_predicate(parse(text), Scope(automaton.types))
    except ExpressionError as error:
        start, end = error.span
        words = f"character {start + 1}" + (f", `{text[start:end]}`" if text[start:end].strip() else "")
        detail = f"{words}: {error.message}"
        place = TextPlace(start=start, end=end, message=error.message)
        raise CommandRefused("bad-predicate", "The predicate cannot be read", detail, 422, place) from None
