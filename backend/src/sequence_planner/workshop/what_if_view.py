"""What is shown of how a station would go on with another model."""

from __future__ import annotations

from sequence_planner.control.view_part import Value, View


class Run(View):
    """A run of an ability, in seconds from the beginning; `ended` is null where it was under way at the end."""

    ability: str
    title: str
    resource: str
    started: float
    ended: float | None


class Completed(View):
    """An operation reached its goal, so many seconds from the beginning."""

    operation: str
    title: str
    at: float


class WhatIfView(View):
    """`seconds` were simulated from the values `before` on, to those `after`; null is unknown.

    `safe` says whether it began in a safe state; from another one nothing is started. `active` are the operations under
    way at the end, and `unplanned` says why there was no plan then. `obstacle` says why nothing could be simulated.
    """

    seconds: float
    safe: bool
    runs: list[Run]
    completed: list[Completed]
    before: dict[str, Value | None]
    after: dict[str, Value | None]
    active: list[str]
    unplanned: str
    obstacle: str | None
