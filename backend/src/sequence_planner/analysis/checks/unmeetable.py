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
from sequence_planner.texts.message import Message, message

CANNOT_BE_MET = "specification-cannot-be-met"


def unmeetable(automaton: Automaton, reason: Unmeetable, where: Place) -> ModelWarning:
    """The warning for an automaton without supervisor: `where` is the place of the specifications."""
    conflict = minimal_conflict(automaton, reason.trace)
    said = message("found.unmet", why=reason.message, conflict=_in_conflict(automaton, conflict))
    return ModelWarning(where, CANNOT_BE_MET, said, reason.trace)


def _in_conflict(automaton: Automaton, conflict: Conflict) -> Message:
    """Say what would already be enough, as a sentence."""
    rest = "marked" if automaton.one_at_a_time else "rest"
    folded = specifications_folded(wording_of(automaton), conflict.specifications)
    specifications = listed(folded or (rest,), most=None)
    said = message("found.conflict", specifications=specifications)
    if conflict.uncontrollable:
        uncontrollable = listed(conflict.uncontrollable, most=None)
        said = message("found.conflict.uncontrollable", specifications=specifications, uncontrollable=uncontrollable)
    return said if conflict.minimal else message("found.conflict.perhaps-fewer", conflict=said)


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
            why = message("found.never-brought.unsafe")
            if breaks:
                why = message("found.never-brought.forbidden", specifications=listed(breaks))
            brings = described(values, values)
            said = message("found.never-brought", work_master=master.name, values=brings, why=why)
            yield ModelWarning(place(automaton, f"work_master.{master.name}.brings"), "never-allowed", said)
