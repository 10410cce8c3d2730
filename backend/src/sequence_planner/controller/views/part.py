"""The parts that all documents about a running station are made of."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict

Value = bool | int | str


class View(BaseModel):
    """Base of all parts of a document: immutable, and nothing beside what is declared."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class ControlView(View):
    """The session that is in control; `taken_from` is who was before it, where control was taken over."""

    session: str
    person: str
    name: str
    since: float
    taken_from: str | None
