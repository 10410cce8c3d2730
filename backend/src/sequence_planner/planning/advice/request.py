"""What an advisor is asked."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from sequence_planner.automaton.structure import State
from sequence_planner.expressions.syntax import Expression
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plan import LONGEST, ORDINARY, Circumstances

Pairing = tuple[str, Value, str, Value]  # a variable and a value, and another with the value it never has together


class AdviceRequest(Immutable):
    """How to get back to work on `goals`, those of the active operations, until `deadline` seconds have passed.

    The advisor decides itself where restart abilities may start. Effects that are `stalled` should have happened by
    now, and are not counted on as long as nothing changes for them; those that are `explained` would not have to, had
    the others. `last` has what unknown measured variables were
    when they were known last. The formulas of `violated` goals were, and their operations must be reset first. No
    correction or physical change makes an `impossible` pair of values, and none is one of a `fixed` variable. `waiting`
    are the goals of operations that become active as soon as their preconditions hold. Whoever asks hears `until` that
    moment on the clock of `time.monotonic`, also where work on it begins late.
    """

    state: State
    goals: Goals
    circumstances: Circumstances = ORDINARY
    stalled: frozenset[str] = frozenset()
    explained: frozenset[str] = frozenset()
    last: Mapping[str, Value] = {}
    impossible: frozenset[Pairing] = frozenset()
    fixed: frozenset[str] = frozenset()
    violated: Goals = ()
    waiting: Goals = ()
    deadline: float = 1.8
    until: float = inf
    longest: int = LONGEST


class ErrandRequest(Immutable):
    """An errand to `target`, which is the precondition of `operation` where that is to be reset.

    `circumstances` say whether restart abilities may start; the rest is as in `AdviceRequest`.
    """

    state: State
    goals: Goals
    target: Expression
    operation: str | None = None
    circumstances: Circumstances = ORDINARY
    stalled: frozenset[str] = frozenset()
    violated: Goals = ()
    deadline: float = 1.8
    longest: int = LONGEST
