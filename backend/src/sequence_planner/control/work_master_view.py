"""What jobs of a station consist of: its work masters, and what their operations and the abilities depend on."""

from __future__ import annotations

from sequence_planner.control.view_part import View


class WorkOperationView(View):
    """An operation of a work master: which others come before it, and the variables that its goal depends on."""

    title: str
    after: list[str]
    goal_reads: list[str]


class WorkMasterView(View):
    """A work master: its operations, the estimates that a new product `brings`, and the variables of these."""

    title: str
    brings: list[str]
    brought: list[str]
    operations: dict[str, WorkOperationView]


class WorkAbilityView(View):
    """An ability: the variables that it writes, or that are expected to react to it.

    An `instant` one is done as soon as it was started.
    """

    title: str
    writes: list[str]
    instant: bool


class WorkMastersView(View):
    """All work masters, and all abilities."""

    work_masters: dict[str, WorkMasterView]
    abilities: dict[str, WorkAbilityView]
