"""The server's way to the process that looks back: one question at a time, and an end to each."""

from __future__ import annotations

import asyncio
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from typing import Final

from sequence_planner.execution.record.codec import HistoryError
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import start
from sequence_planner.history.timeline import Answer, Question, Refused

IDLE: Final = 300.0  # seconds without a question, after which the process is ended


class HistoryProcess:
    """Asks about the run of a station: its model's folder, the URL of its database, and the folder of its archive, if
    one is named. Used from one event loop.
    """

    def __init__(self, model: Path, database: str, archive: Path | None = None) -> None:
        self._model = model
        self._database = database
        self._archive = archive
        self._turn = asyncio.Lock()
        self._running: tuple[Child, Connection] | None = None
        self._idle: asyncio.TimerHandle | None = None

    async def ask(self, question: Question, patience: float) -> Answer:
        """The answer, within so many seconds from its turn on. Raises `HistoryError`."""
        async with self._turn:
            self._keep_alive(None)
            try:
                async with asyncio.timeout(patience):
                    answer = await self._asked(question)
            except TimeoutError:
                self.close()
                raise HistoryError(
                    "history-timeout", f"there was no answer within {patience:g} s: ask for less, or try again later"
                ) from None
            except (EOFError, OSError):
                self.close()
                raise HistoryError("history-failed", "the process that looks back has ended: try again") from None
            except asyncio.CancelledError:
                self.close()  # its answer would be taken for that to the next question
                raise
            self._keep_alive(IDLE)
        if isinstance(answer, Refused):
            raise HistoryError(answer.slug, answer.detail)
        return answer

    def close(self) -> None:
        """End the process."""
        self._keep_alive(None)
        if self._running is not None:
            process, connection = self._running
            self._running = None
            process.kill()
            process.join()
            connection.close()

    async def _asked(self, question: Question) -> Answer:
        if self._running is None:
            self._running = await asyncio.shield(asyncio.to_thread(self._started))
        connection = self._running[1]
        connection.send(question)
        heard = asyncio.Event()
        loop = asyncio.get_running_loop()
        loop.add_reader(connection.fileno(), heard.set)
        try:
            await heard.wait()
        finally:
            loop.remove_reader(connection.fileno())
        answer: Answer = await asyncio.to_thread(connection.recv)
        return answer

    def _started(self) -> tuple[Child, Connection]:
        ours, theirs = Pipe()
        arguments = (self._model, self._database, self._archive)
        # Named and not handed over: the server does without what that imports.
        process = start("sequence_planner.history.worker:work", *arguments, name="looking-back", connection=theirs)
        return process, ours

    def _keep_alive(self, seconds: float | None) -> None:
        """End the process after so many seconds; None: not yet."""
        if self._idle is not None:
            self._idle.cancel()
        self._idle = None if seconds is None else asyncio.get_running_loop().call_later(seconds, self.close)
