"""Counts and times that a controller has noted since it began, for those who watch over the station."""

from __future__ import annotations

from sequence_planner.controller.views.part import View
from sequence_planner.core.distribution import Distribution


class DistributionView(View):
    """Counts of how long something took: one of `counts` for each of `bounds` (seconds, at most so long), and a last
    one for what took longer than all. `seconds` is what it took in all.
    """

    bounds: list[float]
    counts: list[int]
    seconds: float

    @classmethod
    def of(cls, distribution: Distribution) -> DistributionView:
        """The distribution as it is now."""
        return cls(bounds=list(distribution.bounds), counts=list(distribution.counts), seconds=distribution.seconds)


class JournalFiguresView(View):
    """Figures on how the run journal keeps up: records that wait to be durable, and how long each did.

    While it is `behind` nothing is started: the database refuses records, or has confirmed none for too long.
    """

    waiting: int
    latency: DistributionView
    behind: bool


class PlannerFiguresView(View):
    """The questions of one kind to which the planner gave answers of one kind."""

    question: str  # plan, way-back, diagnosis
    outcome: str  # found, none, failed, ...
    took: DistributionView


class FiguresView(View):
    """All of it. `began` is in seconds since the epoch; `replaced` says how often each process that answers was."""

    began: float
    ticks: DistributionView
    journal: JournalFiguresView
    planner: list[PlannerFiguresView]
    replaced: dict[str, int]
