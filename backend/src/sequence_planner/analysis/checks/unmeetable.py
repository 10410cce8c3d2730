"""Specifications that cannot be met, with what is in conflict already, and products that they rule out."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.analysis.checks.warning import ModelWarning, described, listed, place
from sequence_planner.automaton.automaton import Automaton, target
from sequence_planner.automaton.lifting.index_folding import specifications_folded
from sequence_planner.automaton.lifting.wording import wording_of
from sequence_planner.automaton.state_set import StateSet
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.substitution import replaced
from sequence_planner.language.syntax import TRUE, Constant
from sequence_planner.language.types import Place
from sequence_planner.synthesis.diagnosis import Unmeetable
from sequence_planner.synthesis.minimal_conflict import Conflict, minimal_conflict

CANNOT_BE_MET = "specification-cannot-be-met"


def unmeetable(automaton: Automaton, reason: Unmeetable, where: Place) -> ModelWarning:
    """The warning for an automaton without supervisor: `where` is the place of the specifications."""
    conflict = minimal_conflict(automaton, reason.trace)
    message = f"{reason.message}. {_in_conflict(automaton, conflict)}"
    return ModelWarning(where, CANNOT_BE_MET, message, reason.trace)


def _in_conflict(automaton: Automaton, conflict: Conflict) -> str:
    """Say what would already be enough, as a sentence."""
    rest = "marked" if automaton.one_at_a_time else "rest"
    specifications = specifications_folded(wording_of(automaton), conflict.specifications)
    text = f"Already these conflict: {listed(specifications or (rest,), most=None)}"
    if conflict.uncontrollable:
        text += f", with what no start decides: {listed(conflict.uncontrollable, most=None)}"
    return text if conflict.minimal else f"{text} (perhaps fewer would do: not all was tried)"


# A new product, which is there from when a job begins, as soon as the supervisor allows what it brings.


def never_brought(automaton: Automaton, safe: StateSet) -> Iterator[ModelWarning]:
    """Yield the work masters whose product brings what is so in no safe state."""
    for master in automaton.work_masters.values():
        brought = {target(action): action.value for action in master.brings}
        values = {name: value.value for name, value in brought.items() if isinstance(value, Constant)}
        if safe.nearest({**dict.fromkeys(safe.names), **values}) != {}:
            breaks = [
                name
                for name, specification in automaton.specifications.items()
                if simplify(replaced(specification.forbidden, brought)) == TRUE
            ]
            why = f"{listed(breaks)} forbids it" if breaks else "it is so in no safe state"
            message = (
                f"no job of `{master.name}` ever begins: its product brings `{described(values, values)}`, and {why}. "
                "Bring what is safe, or let the specification be about less"
            )
            yield ModelWarning(place(automaton, f"work_master.{master.name}.brings"), "never-allowed", message)
