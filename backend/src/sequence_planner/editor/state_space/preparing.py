"""A draft whose state space can be asked for: with its safe states, also where no supervisor can keep to them."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from sequence_planner.analysis.kept import with_supervisor
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.editor.usable import station_of
from sequence_planner.model.files import Files
from sequence_planner.synthesis.supervisor import Supervision, relevant
from sequence_planner.synthesis.transition_relation import Plant
from sequence_planner.texts.message import Message, joined, message


class SafeStates(NamedTuple):
    """What a station does, and what is safe; where not even its beginning is, `why` there is no supervisor."""

    automaton: Automaton
    supervisor: Supervisor
    why: Message | None


def with_safe_states(which: str, files: Files, stages: Path | None, folder: Path) -> SafeStates:
    """Return a model, called as with `prepared`, with its safe states. Raises `UnusableModelError`."""
    automaton = station_of(which, files, stages, folder).automaton
    found = with_supervisor(automaton)
    if found.supervisor is not None:
        return SafeStates(automaton, found.supervisor, None)
    plant = Plant(automaton, relevant(automaton))
    safe = plant.diagrams.exported(Supervision(plant).safe)
    told = [warning.message for warning in found.warnings or ()]
    model = message(f"obstacle.model.{which}")
    why = message("obstacle.unsupervised", model=model, why=joined(told) if told else "")
    return SafeStates(automaton, Supervisor(safe, {}), why)
