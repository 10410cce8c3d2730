"""The one who is in control of a station, as it is shown."""

from __future__ import annotations

from sequence_planner.controller.views.part import View


class ControlView(View):
    """The session that is in control; `taken_from` is who was before it, where control was taken over."""

    session: str
    person: str
    name: str
    since: float
    taken_from: str | None
