"""The process that looks back for the server: it replays and simulates, and can be killed at any time.

It keeps the station and its safe states, so that only the first question waits for them.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from functools import cached_property
from pathlib import Path

import structlog

from sequence_planner.analysis.store import supervisor_of
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.execution.record.codec import HistoryError
from sequence_planner.history.simulation import branch
from sequence_planner.history.state_at import called_off, looking_back, moment_view, past_view
from sequence_planner.history.timeline import (
    Answer,
    BranchView,
    LookBack,
    Question,
    TakeBranch,
    record_view,
)
from sequence_planner.journal.archive import Archive, ArchiveError
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.model.source import ModelError
from sequence_planner.process.budget import Budget
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.synthesis.supervisor import SynthesisError
from sequence_planner.texts.message import message

LOG = structlog.get_logger(__name__)
MOST_TOLD = 5000  # records of a branch


class _Room:
    def __init__(self, model: Path, database: str, archive: Archive) -> None:
        self._model = model
        self._database = database
        self._archive = archive

    @cached_property
    def _station(self) -> ReadyStation:
        return prepare_station(self._model)

    @cached_property
    def _supervisor(self) -> Supervisor:
        return supervisor_of(self._station.automaton)

    def answer(self, question: Question) -> Answer:
        """Answer what is asked. Raises `HistoryError`, and what else keeps it from being answered."""
        station, supervisor = self._station, self._supervisor
        with closing(Database.open(self._database, create=False)) as database, database.reading() as connection:
            run = WholeRun(connection, self._archive)
            match question:
                case LookBack(number):
                    return moment_view(run, looking_back(run, station.automaton, supervisor, number))
                case TakeBranch(number, seconds, corrections, deadline):
                    found = branch(run, station, supervisor, number, seconds, corrections, deadline)
        return BranchView(
            seconds=found.seconds,
            records=[record_view(each) for each in found.records[:MOST_TOLD]],
            cut=len(found.records) > MOST_TOLD,
            end=past_view(found.execution, called_off(found.records)),
        )


def work(asked: tuple[Path, str, Path | None]) -> Callable[[Question, Budget], Answer]:
    """Return what answers questions about a model's folder, with a database and an archive; a process's life."""
    model, database, archive = asked
    room = _Room(model, database, Archive(archive))

    def answer(question: Question, _: Budget) -> Answer:
        try:
            return room.answer(question)
        except HistoryError:
            raise
        except ArchiveError as error:
            raise HistoryError(
                "archive-unreadable", message("refused.archive-unreadable.why", why=str(error).rstrip("."))
            ) from None
        except StorageError as error:
            raise HistoryError(
                "storage-unavailable", message("refused.archive-unreadable.why", why=str(error).rstrip("."))
            ) from None
        except (ModelError, SynthesisError) as error:
            raise HistoryError("model-changed", message("refused.model-changed.replay", why=str(error))) from None
        except Exception as error:
            LOG.exception("a look back failed")
            raise HistoryError(
                "history-failed", message("refused.history-failed.replay", why=f"{type(error).__name__}: {error}")
            ) from None

    return answer
