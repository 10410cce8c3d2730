"""All that synthesis finds of a model, as far as it was found by now."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.texts.message import Message, message

if TYPE_CHECKING:
    from sequence_planner.analysis.checks.evidence import Evidence
    from sequence_planner.analysis.checks.warning import ModelWarning
    from sequence_planner.synthesis.guards import SupervisorGuard

# What is being computed.
SAFE: Final = message("pending.safe")
WHY_NONE: Final = message("pending.why-none")
FINDINGS: Final = message("pending.findings")
FAR: Final = message("pending.far")
GUARDS: Final = message("pending.guards")
COUNTING: Final = message("pending.counting")  # the last that is computed, where it is not soon done


@dataclass(frozen=True)
class QuestionCounts:
    """How many questions about starts and operations are answered, and how: what can always be done, what cannot, with
    the reason, and what is not known.
    """

    possible: int
    impossible: int
    open: int


@dataclass(frozen=True)
class Analysis:
    """The findings so far. Of what has not been computed yet, and of what cannot be, it says None.

    `pending` is what is being computed, and None when that is all. Without a supervisor in the end, `warnings` say why
    there is none. Counts are of the states of all variables that can be reached, without and with the supervisor; where
    the latter are not counted, they are no more than `supervised_at_most`. `guarded` are the starts that it restricts,
    `guards` what it adds to them for people to read, by ability or event.
    `reached` are the states of what bears on safety that are reached with the supervisor, where they were needed for
    the guards. `evidence` is what answers from afar rest on; it is said once.
    """

    pending: Message | None
    supervisor: Supervisor | None = None
    guarded: tuple[str, ...] | None = None
    guards: Mapping[str, SupervisorGuard] | None = None
    reachable_states: int | None = None
    supervised_states: int | None = None
    supervised_at_most: int | None = None
    warnings: tuple[ModelWarning, ...] | None = None
    questions: QuestionCounts | None = None
    reached: StateSet | None = None
    evidence: Evidence | None = None
