"""What an execution tells those who listen to it."""

from __future__ import annotations

from dataclasses import dataclass

from sequence_planner.automaton.structure import State
from sequence_planner.control.happenings import Happening


@dataclass(frozen=True)
class TickOutcome:
    """What a tick did. `outputs` are the output variables to be published now.

    `finished` are the abilities that took their finish actions, which one may do again and again while its finish guard
    holds; `ended` are those of them that had been running. `called_off` took their cancel actions because they were
    overdue, and of these `given_up` are out of service now.
    """

    finished: tuple[str, ...]
    ended: tuple[str, ...]
    started: tuple[str, ...]
    activated: frozenset[str]
    completed: frozenset[str]
    conflicts: tuple[tuple[str, str, str], ...]
    outputs: frozenset[str]
    changed: bool
    called_off: tuple[str, ...] = ()
    given_up: tuple[str, ...] = ()


@dataclass(frozen=True)
class Heard:
    """Something has happened and led from the state `before` to the one `after`; a tick has an outcome."""

    happening: Happening
    before: State
    after: State
    outcome: TickOutcome | None = None
