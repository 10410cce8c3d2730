"""What is shown of who can do what while something does not take part."""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.control.view_part import Value, View


class AbsenceReason(StrEnum):
    """Why nothing is started with it."""

    SILENT = "silent"
    OUT_OF_SERVICE = "out of service"


class AbsenceView(View):
    """A resource or an ability with which nothing is started."""

    of: str  # resource or ability
    name: str
    title: str
    why: AbsenceReason


class NobodyView(View):
    """An operation that nobody can complete now; `lacks` are the titles of what has to be there again for it."""

    operation: str
    title: str
    active: bool
    lacks: list[str]


class DoableView(View):
    """An operation that may still be completed, as far as is known without a search.

    `by` are the titles of the resources that would start something for it. `once` is what somebody has to see to
    first, by the names of variables.
    """

    operation: str
    title: str
    active: bool
    by: list[str]
    once: dict[str, Value]


class WhoCanView(View):
    """What nobody can do for the want of what is `absent`, and what others may still do."""

    absent: list[AbsenceView]
    nobody: list[NobodyView]
    others: list[DoableView]
