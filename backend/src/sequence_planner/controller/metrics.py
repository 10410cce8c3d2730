"""Counts and times that a controller notes of itself: noting one costs a microsecond, and nobody waits for a reader."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

from sequence_planner.controller.commands.command import answers
from sequence_planner.controller.commands.queries import AskFigures
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

ANSWERS: Final = (0.001, 0.005, 0.01, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0)  # seconds
FAILED: Final = "failed"


class Figures:
    """Since the controller began: how long `ticks` took and `answers` of the planner, and how often processes were
    `replaced`.
    """

    def __init__(
        self,
        journal: RunWriter,
        is_behind: Callable[[], bool],
        ticks: Distribution,
        answers: PlannerTimes,
        replaced: Callable[[], dict[str, int]],
    ) -> None:
        self._began = time.time()
        self._journal, self._is_behind = journal, is_behind
        self._ticks, self._answers, self._replaced = ticks, answers, replaced

    @answers(AskFigures)
    def view(self, query: AskFigures) -> FiguresView:
        """All of it as it is now."""
        journal = self._journal
        return FiguresView(
            began=self._began,
            ticks=DistributionView.of(self._ticks),
            journal=JournalFiguresView(
                waiting=journal.waiting, latency=DistributionView.of(journal.latency), behind=self._is_behind()
            ),
            planner=self._answers.view(),
            replaced=self._replaced(),
        )


class PlannerTimes:
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
