"""Specifications that cannot be met, with what is in conflict already."""

from __future__ import annotations

from sequence_planner.analysis.checks.warning import ModelWarning, listed
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.lifting.index_folding import specifications_folded
from sequence_planner.automaton.lifting.wording import wording_of
from sequence_planner.language.types import Place
from sequence_planner.synthesis.diagnosis import Unmeetable
from sequence_planner.synthesis.minimal_conflict import Conflict, minimal_conflict

CANNOT_BE_MET = "specification-cannot-be-met"


def unmeetable(automaton: Automaton, reason: Unmeetable, place: Place) -> ModelWarning:
    """The warning for an automaton without supervisor: `place` is that of the specifications."""
    conflict = minimal_conflict(automaton, reason.trace)
    message = f"{reason.message}. {_in_conflict(automaton, conflict)}"
    return ModelWarning(place, CANNOT_BE_MET, message, reason.trace)


def _in_conflict(automaton: Automaton, conflict: Conflict) -> str:
    """Say what would already be enough, as a sentence."""
    rest = "marked" if automaton.one_at_a_time else "rest"
    specifications = specifications_folded(wording_of(automaton), conflict.specifications)
    text = f"Already these conflict: {listed(specifications or (rest,), most=None)}"
    if conflict.uncontrollable:
        text += f", with what no start decides: {listed(conflict.uncontrollable, most=None)}"
    return text if conflict.minimal else f"{text} (perhaps fewer would do: not all was tried)"
