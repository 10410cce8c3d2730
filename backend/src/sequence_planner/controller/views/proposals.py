"""The documents that a person is shown before taking a plan by hand: every start, every correction, and what comes of
it.
"""

from __future__ import annotations

from sequence_planner.controller.views.part import Value as ShownValue
from sequence_planner.controller.views.part import View
from sequence_planner.controller.views.station import DiagnosisView, SpecificationView
from sequence_planner.texts.message import Message


class ValueChangeView(View):
    """A variable that gets another value; `now` is null where it is unknown. `so` says in words that it has it, and
    `by_hand` what a person does at the station for that, where the model says so; of a correction only where it is not
    so before a person has done that.
    """

    name: str
    now: ShownValue | None
    then: ShownValue
    so: Message
    by_hand: Message | None


class PreviewStepView(View):
    """One start. `tick` counts from the tick in which the plan begins; `start` and `end`, in seconds after that, are
    estimated by the middle of what each effect takes.
    """

    tick: int
    start: float
    end: float
    ability: str
    title: str
    resource: str
    human: bool
    restart: bool
    moves: bool  # something moves by it, as the model says


class PlanPreviewView(View):
    """A plan that nobody follows yet. Without steps nothing has to be started."""

    ticks: int
    steps: list[PreviewStepView]
    minimal_ticks: bool
    minimal_starts: bool


class EffortView(View):
    """What it takes; offers with the lowest `cost`, which are seconds of trouble, come first."""

    cost: float
    corrections: int
    physical: int
    returns: int  # resources and abilities that a person brings back
    starts: int
    seconds: float  # that the devices are estimated to take
    time: float  # the seconds that devices and people are estimated to take


class OfferView(View):
    """One way on from the state of `revision`, replayed on the reference tick from there.

    First a person does what is `physical` at the station, brings the resources in `online` back, which are `assumed` to
    say so and so then, and puts the abilities `in_service`. Then `corrections` are made and the plan `errand` is
    carried out, until `ends` holds; `needs_restart` says that this takes restart mode. `then` is what the station does
    afterwards for the operations `goals`, in automatic mode; null where that was not looked for or not found.

    An offer `at_rest` ends where the station rests and its devices are as commanded. One `into_safe` begins outside the
    safe states, and ends once the station is inside and `ends` holds, where that says anything. One that is
    `unsupervised` starts something outside, where starts go by their written guards alone; it `breaks` these
    specifications on its way. `obstacle` says why it cannot be taken as things are now, null where it can.

    By `corrections` a person says what is true of the product. Those `only_if_checked` would have operations count as
    done, or nearer to it, although nobody has done anything: `claims` has their names. What is `physical` can be what
    an ability waits for, which then writes the estimates that it `records`.
    """

    id: str
    revision: int
    kind: str  # replan, restart, reset, correction, physical, combined, way-back, goal
    title: str
    title_message: Message
    physical: list[ValueChangeView]
    online: list[str]
    in_service: list[str]
    assumed: list[ValueChangeView]
    corrections: list[ValueChangeView]
    errand: PlanPreviewView | None
    ends: str | None  # null where nothing is carried out, or it is only a way into the safe states
    ends_message: Message | None
    into_safe: bool
    operation: str | None
    needs_restart: bool
    unsupervised: bool
    at_rest: bool
    breaks: list[SpecificationView]
    then: PlanPreviewView | None
    goals: list[str]
    left_out: list[str]
    claims: list[str]
    records: list[ValueChangeView]
    only_if_checked: bool
    effort: EffortView
    obstacle: str | None
    obstacle_message: Message | None


class AdviceView(View):
    """Ways on from the state of `revision`: what devices or people do before what is only said, then the least effort
    first. Without any, `reasons` says why as far as known.

    What may be said `if_checked`, and only then, is apart: none of it is what to do first, whatever it takes. Unless
    `complete` the time was over before all that can be offered was looked for.
    """

    revision: int
    offers: list[OfferView]
    if_checked: list[OfferView]
    reasons: DiagnosisView | None
    complete: bool
    seconds: float
