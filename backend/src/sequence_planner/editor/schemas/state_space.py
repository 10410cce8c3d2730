"""The state space of a draft as it is told: nodes for values of chosen variables, arrows, a plan as a path on it."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

from pydantic import Field

from sequence_planner.controller.views.part import Value, View
from sequence_planner.texts.message import Message


class Extent(StrEnum):
    """How far starts are followed."""

    SUPERVISED = "supervised"  # as the supervisor allows them: from safe states to safe ones
    EDGE = "edge"  # from safe states, wherever they lead: also what lies right behind the safe ones
    ALL = "all"  # as if there were no supervisor


class StateSpaceQuestion(View):
    """How the state space is to be folded: by `variables`, or without them by a good choice; and how far starts are
    followed.

    The starts of the abilities `cut` are looked at: where the supervisor keeps them back. With `plan` the plan from the
    present is told as a path, to the goals of active operations or to where the condition `until` holds.
    """

    variables: Annotated[list[str], Field(max_length=100)] | None = None
    extent: Extent = Extent.EDGE
    cut: list[str] = Field(default=[], max_length=1000)
    plan: bool = False
    until: Annotated[str, Field(min_length=1, max_length=2000)] | None = None


class SaidValueView(View):
    """A value, and what it is called."""

    value: Value
    title: Message


class FoldingVariableView(View):
    """A variable by which the states can be folded, what it is called, and how many values it can have."""

    name: str
    title: Message
    values: int


class ChosenVariableView(View):
    """A variable by which the states are folded, with the values that are reached; without it there would be so many
    nodes.
    """

    name: str
    title: Message
    values: list[SaidValueView]
    nodes_without: int


class FoldedStateView(View):
    """A node: the `values` of the chosen variables, and how many states stand behind it.

    Of these are so many `forbidden` (by the specifications with these titles), `unsafe`, and `stuck`, which is null
    where it is not known; in so many `cut` the supervisor keeps a start that is looked at back. A run may begin in one
    of them (`initial`), and the present may be one.
    """

    values: list[Value]
    states: int
    initial: bool
    present: bool
    violated: list[str]
    forbidden: int
    unsafe: int
    stuck: int | None
    cut: int


class StateCauseView(View):
    """Something that leads from one node to another: the `start` of an ability, what a `device` or a `person` does, a
    `fault`, a `finish`, an operation that becomes active or is so no longer (`activity`), or several at once
    (`together`).

    The supervisor has it `allowed` somewhere; somewhere it is `kept` back, as it would lead out of the safe states.
    """

    kind: str
    name: str
    title: Message
    allowed: bool
    kept: bool


class StateArrowView(View):
    """An arrow from one node to another, by their places, with all that leads there."""

    source: int
    sink: int
    causes: list[StateCauseView]


class StatePathView(View):
    """A step of the plan: what happens, and the node after it; null where that is not among those that are told."""

    node: int | None
    title: Message


class StateSpaceView(View):
    """The states that the draft after its change `number` can come to, folded by the `chosen` variables.

    They are counted over all variables, or only over those that bear on the chosen ones and on what is safe (`whole`).
    Without `exact` there are so many `states` at most, some nodes may never be reached, and none is missing; then
    it is not told what lies at the edge, but what the supervisor allows (`extent`). Of more than `most` nodes none is
    told; `nodes_without` says how many there would be without each chosen variable. `arrows_left_out` are not told. The
    plan is a `path`, null where there is none; `verdict` says what is known.
    `unsupervised` says why there is no supervisor. With an `obstacle` nothing is told.
    """

    number: int
    obstacle: Message | None
    unsupervised: Message | None = None
    variables: list[FoldingVariableView] = Field(default=[])
    chosen: list[ChosenVariableView] = Field(default=[])
    extent: Extent = Extent.EDGE
    whole: bool = True
    exact: bool = True
    states: int = 0
    count: int = 0
    most: int
    nodes: list[FoldedStateView] = Field(default=[])
    arrows: list[StateArrowView] = Field(default=[])
    arrows_left_out: int = 0
    path: list[StatePathView] | None = None
    verdict: str | None = None
