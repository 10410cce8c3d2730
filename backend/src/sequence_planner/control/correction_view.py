"""What a person is shown before a correction is made."""

from __future__ import annotations

from sequence_planner.control.offer_view import PlanPreviewView
from sequence_planner.control.view import BeliefView
from sequence_planner.control.view_part import Value, View
from sequence_planner.control.way_back_view import SpecificationView


class CorrectedView(View):
    """An estimate and the value that it is to have. `related` is what is measured that bears on it, as it is now."""

    name: str
    now: Value
    then: Value
    belief: BeliefView
    related: list[str]


class CorrectionPreview(View):
    """What a correction made at `revision` would bring about; it is refused on any other.

    `safe` says whether the state is a safe one afterwards, `safe_now` whether it is so without it, and `violates` which
    specifications the corrected state violates. Abilities would become `startable`, or be so no longer; operations
    would be `activated` or `completed`. `plan` is what the station then does for the operations `goals`, in automatic
    mode; `reason` says why there is none. `obstacle` says why it cannot be made as things are, null where it can.
    """

    revision: int
    changes: list[CorrectedView]
    safe: bool
    safe_now: bool
    violates: list[SpecificationView]
    startable: list[str]
    no_longer_startable: list[str]
    activated: list[str]
    completed: list[str]
    contradictions_gone: list[str]
    contradictions_new: list[str]
    plan: PlanPreviewView | None
    goals: list[str]
    left_out: list[str]
    reason: str
    obstacle: str | None
