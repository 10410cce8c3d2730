"""The digest of a station's model: what has happened to a station can be replayed with the same model alone."""

from __future__ import annotations

import hashlib
import json

from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import Expression
from sequence_planner.history.shapes import Shape, Shapes, UnreadableError


def model_digest(automaton: Automaton) -> str:
    """64 hexadecimal digits over all that the ground automaton says; where it was written does not count.

    What the program learns to read of models later has defaults, so the digest of a model that says nothing of it stays
    the same.
    """
    shapes = Shapes({Expression: Shape(print_expression, _unread)})
    orders = [list(each) for each in (automaton.variables, automaton.abilities, automaton.operations)]
    text = json.dumps([orders, shapes.of(Automaton).encode(automaton)], separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def _unread(document: object) -> object:
    raise UnreadableError("a digest is not read")
