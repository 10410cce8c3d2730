"""The server's way to the process that looks back: one question at a time, and an end to each."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from sequence_planner.execution.record.codec import HistoryError
from sequence_planner.history.timeline import Answer, Question
from sequence_planner.process.task import WorkerError
from sequence_planner.process.worker import Worker, WorkerLateError
from sequence_planner.texts.message import message

IDLE: Final = 300.0  # seconds without a question, after which the process is ended
_NICENESS: Final = 10  # ticks come first, and plans


class HistoryProcess:
    """Asks about the run of a station: its model's folder, the URL of its database, and the folder of its archive, if
    one is named. Used from one event loop.
    """

    def __init__(self, model: Path, database: str, archive: Path | None = None) -> None:
        self._process: Worker[Question, Answer] = Worker(
            "sequence_planner.history.worker:work",  # named: the server does without what that imports
            (model, database, archive),
            "looking-back",
            niceness=_NICENESS,
            errors=(HistoryError,),
            late=0.0,
            starting=None,
            rests_after=IDLE,
            kept=False,
        )

    async def ask(self, question: Question, patience: float) -> Answer:
        """The answer, within so many seconds from its turn on. Raises `HistoryError`."""
        try:
            return await self._process.ask(question, patience)
        except WorkerLateError:
            raise HistoryError(
                "history-timeout", message("refused.history-timeout.late", seconds=f"{patience:g}")
            ) from None
        except WorkerError:
            raise HistoryError("history-failed", message("refused.history-failed.ended")) from None

    def close(self) -> None:
        """End the process."""
        self._process.close()
