"""What waits for a second person, as it is shown."""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.control.approval_commands import Act
from sequence_planner.control.view_part import View


class ApprovalState(StrEnum):
    """How far a request has come."""

    WAITING = "waiting"
    APPROVED = "approved"  # and done
    DECLINED = "declined"
    WITHDRAWN = "withdrawn"  # by who has asked for it
    EXPIRED = "expired"  # nobody has answered in time
    OVERTAKEN = "overtaken"  # the state has moved, or control has


class ApprovalView(View):
    """A request of `person`, called `by`, for an act that needs a second person; it waits `until` then at most.

    It was looked at in the state of `revision`, and can be approved in no other. `answered_by` has approved or declined
    it. One that is over is shown for a minute more.
    """

    act: Act
    revision: int
    person: str
    by: str
    why: str
    since: float
    until: float
    state: ApprovalState
    answered_by: str | None
    answer: str | None  # why, in the words of who has answered
