"""The parts that all documents about a running station are made of."""

from __future__ import annotations

from sequence_planner.core.data_models import DataModel

Value = bool | int | str


class View(DataModel):
    """Base of all parts of a document: immutable, and nothing beside what is declared."""


class ControlView(View):
    """The session that is in control; `taken_from` is who was before it, where control was taken over."""

    session: str
    person: str
    name: str
    since: float
    taken_from: str | None
