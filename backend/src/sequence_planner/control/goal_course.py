"""Decisions about the goal of an action: what to do when the output that wants it rises and falls.

Pure: it sends nothing and knows no time. A goal is sent once for each rise, and never beside one that is under way: a
rise waits until the device has ended that one, be it of this controller or of one that has gone since.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from sequence_planner.pipelines.goal_states import GoalState
from sequence_planner.ros.actions import GoalStatus


class Do(Enum):
    """What is to be done now."""

    SEND = "send"
    CANCEL = "cancel"


# How ROS 2's states of a goal are told; one that is being cancelled is still at work.
_TOLD = {
    GoalStatus.ACCEPTED: GoalState.ACCEPTED,
    GoalStatus.EXECUTING: GoalState.EXECUTING,
    GoalStatus.CANCELING: GoalState.EXECUTING,
    GoalStatus.SUCCEEDED: GoalState.SUCCEEDED,
    GoalStatus.CANCELED: GoalState.CANCELED,
    GoalStatus.ABORTED: GoalState.ABORTED,
}


@dataclass
class GoalCourse:
    """One action. `own` is the state of the goal that was wanted last.

    `others` is that of a goal the server has and that is not ours, if one is under way.
    """

    own: GoalState = GoalState.IDLE
    others: GoalState | None = None
    _wanted: bool | None = None  # the output as last seen; its first value is no rise
    _waiting: bool = False  # a rise has not been answered with a goal yet
    _at_work: bool = False  # a goal of ours has been sent and has not ended

    @property
    def state(self) -> GoalState:
        """What the variable says."""
        if self._at_work or self.others is None:
            return self.own
        return self.others

    def heed(self, wanted: bool) -> Do | None:
        """The output is so now."""
        was, self._wanted = self._wanted, wanted
        if was is None or was == wanted:
            return self._next()
        if wanted:
            self._waiting = True
            return self._next()
        self._waiting = False
        if self._at_work or self.others is not None:
            return Do.CANCEL
        self.own = GoalState.IDLE
        return None

    def heard(self, status: GoalStatus) -> Do | None:
        """The server says what has become of our goal."""
        self.own = _TOLD.get(status, GoalState.LOST)
        if status.ended:
            self._at_work = False
        return self._next()

    def ended(self, state: GoalState) -> Do | None:
        """Nothing more will be heard of our goal: it was rejected, or nobody knows."""
        self.own, self._at_work = state, False
        return self._next()

    def heard_of_others(self, statuses: list[GoalStatus]) -> Do | None:
        """The server says which goals it has beside ours."""
        at_work = [_TOLD[status] for status in statuses if status in _TOLD and not status.ended]
        if not self._wanted and not self._at_work:
            self.own = GoalState.IDLE  # what was lost is not there any more, or is among the others
        self.others = max(at_work, key=[GoalState.ACCEPTED, GoalState.EXECUTING].index, default=None)
        return self._next()

    def lose_others(self) -> Do | None:
        """The server of the goals beside ours has gone."""
        self.others = None
        action = self._next()
        if not self._at_work:
            self.own = GoalState.LOST
        return action

    def _next(self) -> Do | None:
        if not self._wanted and not self._at_work and self.own is not GoalState.LOST:
            self.own = GoalState.IDLE
        if not self._waiting or self._at_work or self.others is not None:
            return None
        self._waiting, self._at_work, self.own = False, True, GoalState.IDLE
        return Do.SEND
