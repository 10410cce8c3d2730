"""Operations of which there are none, and local specifications that say nothing about the run."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.structure import Automaton
from sequence_planner.checking.warning import ModelWarning, families, place
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import Constant, variables

_FILE = "operations.yaml"  # has a place where it is there and holds nothing


def check_operations(automaton: Automaton) -> Iterator[ModelWarning]:
    """A file of operations without any, and operations whose local specification reads nothing at all."""
    if not automaton.operations and _FILE in automaton.places:
        message = (
            "there is no operation here, so the station never does anything by itself: write one, or delete the file"
        )
        yield ModelWarning(automaton.places[_FILE], "no-operation", message)
    for family, names in families(automaton.operations).items():
        local = automaton.operations[names[0]].local
        if local is None:
            continue
        where = place(automaton, f"operation.{names[0]}.local")
        if not isinstance(local, Constant) and not any(variables(local)):
            message = (
                f"the local specification `{print_expression(local)}` of `{family}` reads no variable, so it only says "
                "how long the run is: write what must hold on the way, or leave it out"
            )
            yield ModelWarning(where, "empty-local-specification", message)
