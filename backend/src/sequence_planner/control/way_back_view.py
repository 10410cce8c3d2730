"""Where a station that is outside its safe states is, and how it comes back, as it is shown."""

from __future__ import annotations

from sequence_planner.control.view_part import Value, View


class SpecificationView(View):
    """A ground specification; several can have one title."""

    name: str
    title: str


class DifferenceView(View):
    """A variable that has another value in the nearest safe state."""

    name: str
    now: Value
    safe: Value


class WayBackStepView(View):
    """One start on the way back. `tick` counts from the tick in which the way begins."""

    tick: int
    ability: str
    title: str
    resource: str


class WayBackView(View):
    """The state does not count as safe: why, how the nearest safe state differs, and the shortest way back.

    Without differences and with nothing violated the state may be safe, and what `awaits` names decides. `ticks` is
    null while no way is known; a way without steps needs no start.
    """

    violated: list[SpecificationView]
    threatened: list[SpecificationView]  # what the devices could violate without any start
    differences: list[DifferenceView]
    awaits: list[str]  # topics whose values decide whether the state is safe
    ticks: int | None
    steps: list[WayBackStepView]
    breaks: list[SpecificationView]  # what is violated on the way, and is not now
    reason: str  # which way leads back, or why none is known
