"""That a variable has a value, in the model's language."""

from __future__ import annotations

from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import Comparison, Constant, Expression, Not, Variable
from sequence_planner.expressions.types import Value


def value_text(automaton: Automaton, name: str, value: Value) -> str:
    """As in `robot.pose == home`, `tool_is_idle` or `not tool_is_idle`."""
    variable: Expression = Variable(name, automaton.types[name])
    if isinstance(value, bool):
        return print_expression(variable if value else Not(variable))
    return print_expression(Comparison("==", variable, Constant(value)))
