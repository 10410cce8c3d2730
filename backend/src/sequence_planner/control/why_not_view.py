"""Why an ability does not start, an operation is not active or not done, or a goal does not hold."""

from __future__ import annotations

from sequence_planner.control.offer_view import PlanPreviewView
from sequence_planner.control.view import DiagnosisView
from sequence_planner.control.view_part import Value, View


class ChangerView(View):
    """Who could change a variable: an ability, which may be running, or a person.

    `how` is `start`, `finish` or `effect` of an ability; `correction` of an estimate, `device` where something has to
    be done at the resource `name`, `message` where its topic `name` has to speak, and `force` of an output.
    """

    how: str
    name: str
    title: str
    running: bool


class InvolvedView(View):
    """A variable that decides a condition. With one of the values `wanted`, and nothing else different, it would hold.

    `since` is when the value was seen first, `topic` where a measured one is heard. An estimate may be unconfirmed.
    """

    name: str
    kind: str  # measured, output, estimated, activity
    resource: str | None
    value: Value | None
    wanted: list[Value]
    since: float | None
    topic: str | None
    unconfirmed_since: float | None
    changers: list[ChangerView]


class ConditionView(View):
    """Something that has to be otherwise. `involved` alone keep it from being true, and none of them could be spared.

    `kind` is station (how the station executes), service (what does not take part), written (in the model),
    unpublished (a command has to leave first), supervisor (what synthesis has added), plan (nothing wants it yet) or
    order (no job asks for it yet).
    """

    kind: str
    text: str
    involved: list[InvolvedView]


class WhyNotView(View):
    """All `conditions` have to be otherwise; without any, nothing is in the way.

    For a goal, `plan` is how the station could reach it from here, or `reasons` say why it cannot at all; both are null
    where nothing was found in time. For an operation that has no plan, `reasons` are those of the plan.
    """

    of: str  # ability, operation, goal
    name: str
    title: str
    revision: int
    summary: str
    conditions: list[ConditionView]
    plan: PlanPreviewView | None
    reasons: DiagnosisView | None
