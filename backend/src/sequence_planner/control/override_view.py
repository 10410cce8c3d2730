"""What a person may set while a station runs, and what is set."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from sequence_planner.control.view_part import View

FieldValue = bool | int | Annotated[float, Field(allow_inf_nan=False)] | str


class OverrideFieldView(View):
    """A field that may be set to a number `between` two, or to one of `among`; the other of the two is null.

    `value` is what is set now, null when nothing is.
    """

    type: str
    between: tuple[float, float] | None
    among: list[FieldValue] | None
    value: FieldValue | None


class OverrideView(View):
    """An override of the model, in the pipeline of a topic or flow. What is set is gone after `expires` seconds.

    `actor` has set what is set, until `until` (seconds since the epoch); both are null when nothing is.
    """

    pipeline: str
    resource: str
    expires: float
    fields: dict[str, OverrideFieldView]
    actor: str | None
    until: float | None
