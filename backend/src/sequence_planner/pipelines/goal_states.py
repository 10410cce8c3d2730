"""What can become of the goal of an action, as a measured variable says it."""

from __future__ import annotations

from enum import StrEnum


class GoalState(StrEnum):
    """The state of the goal of an action.

    `IDLE`: none is wanted, or the one that is wanted has not been answered yet. `LOST`: nobody knows, for the server is
    not there, does not answer or has been started anew.
    """

    IDLE = "idle"
    ACCEPTED = "accepted"
    EXECUTING = "executing"
    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"
    REJECTED = "rejected"
    LOST = "lost"


# A goal that a server has taken up and not done with is in one of these states, for however short a time.
GOAL_ON_ITS_WAY = (GoalState.ACCEPTED, GoalState.EXECUTING)

# The enumeration that a `status` has without being declared.
GOAL_STATE = "goal_state"

# The state of a goal is told as a text.
STATUS_TYPE, STATUS_FIELD = "std_msgs/msg/String", "data"
