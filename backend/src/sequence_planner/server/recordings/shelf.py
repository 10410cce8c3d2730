"""Recordings of ROS 2 traffic that engineers bring: kept for a while, and read with the draft as it is when asked."""

from __future__ import annotations

import asyncio
import errno
import json
import secrets
import shutil
from collections import OrderedDict
from collections.abc import AsyncIterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from starlette.concurrency import run_in_threadpool

from sequence_planner.editor.processes import DraftProcess
from sequence_planner.language.types import Value
from sequence_planner.model.paths import EditError
from sequence_planner.server.errors import ProblemFound
from sequence_planner.server.services.editor import Workshop
from sequence_planner.texts.message import message

MOST_KEPT: Final = 4
KEPT_FOR: Final = 3600.0  # seconds after it was used
RESTS_AFTER: Final = 900.0  # seconds for which what was read is known without a question
LAID_OUT_WITHIN: Final = 120.0  # seconds, for what is unpacked
READ_WITHIN: Final = 75.0  # seconds; the process itself works for less, and tells how far it came
MOST_AT_ONCE: Final = 2  # recordings that are on their way
PIECE: Final = 1 << 20  # bytes that are written at once
MB: Final = 1_000_000
_FULL: Final = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@dataclass
class _Kept:
    """A recording: what it is called, its bytes, and when it was used last."""

    name: str
    size: int
    used: float


class RecordingShelf:
    """Keeps the last recordings in a `folder` of its own, each of at most so many MB. Used from one event loop."""

    def __init__(self, shop: Workshop, folder: Path, largest: int) -> None:
        self._shop = shop
        self._folder = folder
        self._most = largest * MB
        self._process = DraftProcess("recordings.worker", rests_after=RESTS_AFTER)
        self._kept: OrderedDict[str, _Kept] = OrderedDict()
        self._coming = asyncio.Semaphore(MOST_AT_ONCE)
        self._sweeping: asyncio.TimerHandle | None = None
        self._begun = False

    async def close(self) -> None:
        """Forget all recordings, and end the process that reads them."""
        self._process.close()
        if self._sweeping is not None:
            self._sweeping.cancel()
        self._kept.clear()
        await run_in_threadpool(shutil.rmtree, self._folder, ignore_errors=True)

    async def bring(self, name: str, pieces: AsyncIterator[bytes]) -> str:
        """Take a recording as it comes, and read it; JSON of a `RecordedTrafficView`.

        Raises `ProblemFound` for one that cannot be used, of which nothing stays, and `WorkerError`.
        """
        async with self._coming:
            id = secrets.token_hex(8)
            place = self._folder / id
            try:
                await run_in_threadpool(self._begin, place)
                size = await _written(place / "come", pieces)
                await self._asked("lay_out", place / "come", name, place / "bag", self._most, within=LAID_OUT_WITHIN)
                self._kept[id] = _Kept(name, size, asyncio.get_running_loop().time())
                overview = await self.overview(id, -1.0)
            except BaseException as error:
                self._kept.pop(id, None)
                await asyncio.shield(run_in_threadpool(shutil.rmtree, place, ignore_errors=True))
                if isinstance(error, OSError) and error.errno in _FULL:
                    raise ProblemFound(
                        507, "no-room", message("refused.no-room.disk", why=str(error.strerror))
                    ) from None
                raise
            await self._sweep()
            return overview

    async def overview(self, id: str, since: float) -> str:
        """Return what a recording has for the draft as it is now, with its moments after one; JSON of a
        `RecordedTrafficView`.

        Raises `ProblemFound` where it is kept no more or cannot be read, and `WorkerError`.
        """
        return await self._found("overview", id, since)

    async def state_then(self, id: str, at: float) -> str:
        """Return the state of the draft at a moment of a recording; JSON of a `RecordedStateView`. Raises as
        `overview` does.
        """
        return await self._found("recorded_state", id, at)

    async def present(self, id: str, at: float) -> Mapping[str, Value | None]:
        """Return the values with which What-if begins at a moment of a recording. Raises as `overview` does."""
        values: dict[str, Value | None] = json.loads(await self.state_then(id, at))["values"]
        return values

    async def put_away(self, id: str) -> None:
        """Forget a recording. Raises `ProblemFound` where it is kept no more."""
        self._known(id)
        await self._forget(id)

    async def _found(self, question: str, id: str, moment: float) -> str:
        kept = self._known(id)
        kept.used = asyncio.get_running_loop().time()
        self._kept.move_to_end(id)
        about = id, kept.name, kept.size, self._folder / id / "bag"
        draft = await self._shop.open()
        found = await self._asked(question, draft.number, self._shop.folder, about, moment, within=READ_WITHIN)
        assert isinstance(found, str)
        return found

    async def _asked(self, question: str, *asked: object, within: float) -> object:
        files = (await self._shop.open()).files
        try:
            return await self._process.ask(files, question, *asked, patience=within)
        except EditError as error:
            raise ProblemFound(422, "recording-unread", message("step.so", so=error.why)) from None

    def _known(self, id: str) -> _Kept:
        kept = self._kept.get(id)
        if kept is None:
            minutes = round(KEPT_FOR / 60)
            raise ProblemFound(
                404, "no-recording", message("refused.no-recording.again", most=MOST_KEPT, minutes=minutes)
            )
        return kept

    def _begin(self, place: Path) -> None:
        """Make a place for a recording; what an earlier process has left is nobody's any more."""
        if not self._begun:
            shutil.rmtree(self._folder, ignore_errors=True)
            self._folder.mkdir(mode=0o700)
            self._begun = True
        place.mkdir()
        (place / "bag").mkdir()

    async def _sweep(self) -> None:
        """Forget recordings that are too many, or that nobody has used for long."""
        now = asyncio.get_running_loop().time()
        old = [id for id, kept in self._kept.items() if now - kept.used >= KEPT_FOR]
        surplus = [id for id in self._kept if id not in old][: max(0, len(self._kept) - len(old) - MOST_KEPT)]
        for id in (*old, *surplus):
            await self._forget(id)
        if self._sweeping is not None:
            self._sweeping.cancel()
            self._sweeping = None
        if self._kept:
            due = min(kept.used for kept in self._kept.values()) + KEPT_FOR
            self._sweeping = asyncio.get_running_loop().call_at(due + 1.0, self._sweep_again)

    def _sweep_again(self) -> None:
        self._again = asyncio.ensure_future(self._sweep())

    async def _forget(self, id: str) -> None:
        self._kept.pop(id, None)
        await run_in_threadpool(shutil.rmtree, self._folder / id, ignore_errors=True)


async def _written(file: Path, pieces: AsyncIterator[bytes]) -> int:
    """Write what comes, and never have more than a piece of it in memory; returns how many bytes came."""
    size, waiting = 0, bytearray()
    with await run_in_threadpool(file.open, "xb") as opened:
        async for piece in pieces:
            size += len(piece)
            waiting += piece
            if len(waiting) >= PIECE:
                await run_in_threadpool(opened.write, bytes(waiting))
                waiting.clear()
        await run_in_threadpool(opened.write, bytes(waiting))
    return size
