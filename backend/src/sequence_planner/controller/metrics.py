"""Counts and times that a controller notes of itself: noting one costs a microsecond, and nobody waits for a reader."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Final

from sequence_planner.controller.views.metrics import (
    DistributionView,
    FiguresView,
    JournalFiguresView,
    PlannerFiguresView,
)
from sequence_planner.core.distribution import Distribution
from sequence_planner.journal.writer import RunWriter
from sequence_planner.planning.portfolio.worker import Answer, Request
from sequence_planner.planning.problem import PlanAnswer, PlanRequest, WayBackAnswer, WayBackRequest

TICKS: Final = (0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 1.0)  # seconds
ANSWERS: Final = (0.001, 0.005, 0.01, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0)  # seconds
FAILED: Final = "failed"


class Figures:
    """Since the controller began."""

    def __init__(self) -> None:
        self.began = time.time()
        self.ticks = Distribution(TICKS)
        self.answers = Answers()

    def view(self, journal: RunWriter, behind: bool, replaced: Mapping[str, int]) -> FiguresView:
        """All of it as it is now."""
        return FiguresView(
            began=self.began,
            ticks=DistributionView.of(self.ticks),
            journal=JournalFiguresView(
                waiting=journal.waiting, latency=DistributionView.of(journal.latency), behind=behind
            ),
            planner=self.answers.view(),
            replaced=dict(replaced),
        )


class Answers:
    """The times that the planner took, by what it was asked and what came of that."""

    def __init__(self) -> None:
        self._took: dict[tuple[str, str], Distribution] = {}

    def note(self, request: Request, answer: Answer | None, seconds: float) -> None:
        """An answer came, or with None it has failed to give one."""
        key = _question(request), FAILED if answer is None else _outcome(answer)
        self._took.setdefault(key, Distribution(ANSWERS)).note(seconds)

    def view(self) -> list[PlannerFiguresView]:
        """Each kind that there was."""
        return [
            PlannerFiguresView(question=question, outcome=outcome, took=DistributionView.of(took))
            for (question, outcome), took in sorted(self._took.items())
        ]


def _question(request: Request) -> str:
    match request:
        case PlanRequest():
            return "plan"
        case WayBackRequest():
            return "way-back"
        case _:
            return "diagnosis"


def _outcome(answer: Answer) -> str:
    match answer:
        case PlanAnswer(verdict=verdict):
            return verdict.name.lower().replace("_", "-")
        case WayBackAnswer(way=way):
            return "none" if way is None else "found"
        case _:
            return "none" if answer.reason is None else "found"
