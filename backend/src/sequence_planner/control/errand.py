"""An errand: a plan that a person has seen and taken, and that is carried out as it is and never made anew.

A way back, the reset of an operation and a goal by hand are errands. They have their abilities from one plan; what they
are for is a goal of its own beside the operations, which wait meanwhile. So is a trial: one start of one ability.
"""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.control.moment import Moment
from sequence_planner.expressions.syntax import TRUE, Expression
from sequence_planner.immutable import Immutable
from sequence_planner.planning.plan import Goal, Plan


class ErrandKind(StrEnum):
    """What an errand is for."""

    WAY_BACK = "way-back"  # into the safe states, or to where operations can go on
    RESET = "reset"  # to the precondition of an operation
    GOAL = "goal"  # to what an engineer has asked for
    TRIAL = "trial"  # one run of an ability alone, to see what it does


NAME = "errand"  # of its goal, beside those of operations


class Errand(Immutable):
    """`goal` is what its `plan` reaches. With `unsupervised` starts outside the safe states go by written guards alone,
    as a person has confirmed; from inside none leads out all the same. `operation` is the one that is reset. With
    `restart` its plan may have restart abilities, and it is carried out in restart mode only. One `into_safe` begins
    outside the safe states, and is not done before the station is inside.

    With an `ability` it is a trial of that: it starts at once or not at all, and is done when that run has ended. Then
    `goal` only says by what an end is known.
    """

    kind: ErrandKind
    title: str
    plan: Plan
    goal: Expression = TRUE
    restart: bool = False
    unsupervised: bool = False
    operation: str | None = None
    by: str = ""
    why: str = ""
    taken: Moment = Moment(0.0, 0.0)
    ability: str | None = None
    into_safe: bool = False

    @property
    def pursued(self) -> Goal:
        """Its goal, as plans are made for."""
        return Goal(NAME, self.goal)
