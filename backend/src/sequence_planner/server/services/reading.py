"""Answers about a draft, whichever it is: its files, its check, and what follows from it. Nothing here changes one."""

from __future__ import annotations

import asyncio
from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sequence_planner.controller.views.details import AutomatonView
from sequence_planner.core.actor import Actor
from sequence_planner.editor.draft import Draft
from sequence_planner.editor.pipelines.schemas import DraftQuestion, PipelineQuestion
from sequence_planner.editor.processes import (
    Changed,
    CheckDesk,
    DraftAnswering,
    DraftProcess,
    LanguageQuestionKind,
    TextAt,
    worked,
)
from sequence_planner.editor.schemas.check import CheckView, waiting
from sequence_planner.editor.schemas.draft import DraftView, WorkshopView
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.model.paths import EditError
from sequence_planner.server.settings import StreamLimits
from sequence_planner.server.stream.broadcast import LatestValue
from sequence_planner.server.stream.messages import WorkshopSnapshot
from sequence_planner.texts.message import message

ANSWERED_WITHIN = 20.0  # seconds, for questions about a text
RUN_WITHIN = 30.0  # seconds, for questions about pipelines, which run


class ReadableWorkshop(ABC):
    """A draft that can be asked about. The processes that answer start when they are asked, and rest after a while.

    `folder` is the model whose Python stages belong to it, which is to be run as `start` says. Used from one event
    loop.
    """

    def __init__(self, folder: Path, limits: StreamLimits, start: StartNeeds) -> None:
        self.latest = LatestValue(self._present, limits)
        self.folder = folder
        self._editing = DraftProcess("editing_worker")
        self._process = DraftProcess()
        self._folding = DraftProcess("folds.folding_worker")
        self._pipelines = DraftAnswering("pipelines.worker", 2)  # the draft, and what runs
        self._desk = CheckDesk(folder, start, self._process, self._found)
        self._check: CheckView | None = None
        self._shown: WorkshopView | None = None
        self._encoded: str | None = None
        self._tied: tuple[int, str] | None = None  # the number of a draft, and its graph
        self._tying = asyncio.Lock()

    @abstractmethod
    async def view(self, by: Actor) -> DraftView:
        """The draft, for somebody who could undo what they did. Raises `WorkerError`."""

    @abstractmethod
    async def _opened(self) -> Draft:
        """See to it that what is shown is the draft as it is now, and that this is checked. Raises `WorkerError`."""

    async def open(self) -> Draft:
        """The draft as it is now. Raises `WorkerError`."""
        return await self._opened()

    async def close(self) -> None:
        """End what is being checked and answered."""
        await self._desk.close()
        for each in (self._editing, self._process, self._folding, self._pipelines):
            each.close()

    async def files(self, paths: Sequence[str] | None = None) -> str:
        """JSON of a `FilesView` of the draft; all its files where none are named. Raises `WorkerError`."""
        return await self._files_of(await self.open(), paths)

    async def usages(self, part: str) -> str:
        """Return where a part is named, as JSON of a `UsagesView`. Raises `EditError` and `WorkerError`."""
        found = await self._process.ask((await self.open()).files, "used", part)
        assert isinstance(found, str)
        return found

    async def tied(self) -> str:
        """Return what is tied to what, as JSON of a `GraphView`: found once for each draft. Raises `WorkerError`."""
        async with self._tying:
            draft = await self.open()
            if self._tied is None or self._tied[0] != draft.number:
                found = await self._process.ask(draft.files, "tied", draft.number)
                assert isinstance(found, str)
                self._tied = draft.number, found
            return self._tied[1]

    async def sequenced(self) -> str:
        """Return the operations and their order, as JSON of a `DraftOperationsView`. Raises `WorkerError`."""
        draft = await self.open()
        found = await self._process.ask(draft.files, "sequenced", draft.number)
        assert isinstance(found, str)
        return found

    async def pictured(self) -> str:
        """Return the picture of the draft, as JSON of a `DraftPictureView`. Raises `WorkerError`."""
        draft = await self.open()
        found = await self._process.ask(draft.files, "pictured", draft.number)
        assert isinstance(found, str)
        return found

    async def folded(self, wanted: str | None, name: str | None) -> str:
        """Return what could be said shorter, or one of that with another name for what it adds, as JSON of a
        `FoldsView`.

        Raises `EditError` where there is no such fold, and `WorkerError`.
        """
        draft = await self.open()
        found = await self._folding.ask(draft.files, "folded", draft.number, wanted, name)
        assert isinstance(found, str)
        return found

    async def checked(self) -> CheckView:
        """Return what is known of the draft."""
        draft = await self.open()
        return self._check or waiting(draft.number)

    async def played(self, finding: int, ability: str, number: int) -> list[AutomatonView]:
        """Return how an ability goes through the run that shows a finding of the check of change `number`.

        Raises `EditError` where there is no such run or ability, and `WorkerError`.
        """
        check, draft = await self.checked(), await self.open()
        if number != check.number or number != draft.number:
            raise EditError(message("edit.draft-changed"))
        trace = check.findings[finding].trace if finding < len(check.findings) else None
        if trace is None:
            raise EditError(message("edit.no-run"))
        found = await worked("drawn", draft.files, self.folder, ability, trace)
        if isinstance(found, str):
            raise EditError(found)
        assert isinstance(found, list)
        return found

    async def ask(self, kind: LanguageQuestionKind, asked: TextAt) -> str:
        """Return what is answered to a question about a text, as JSON. Raises `WorkerError`."""
        draft = await self.open()
        answer = await self._process.ask(draft.files, "answer", kind, asked, patience=ANSWERED_WITHIN)
        assert isinstance(answer, str)
        return answer

    async def ask_pipelines(self, question: PipelineQuestion | bytes) -> str:
        """Return what is answered to a question about the pipelines, as JSON; bytes are the body of a `Preview`.

        Raises `EditError`, `BodyError` and `WorkerError`.
        """
        answer = await self._asked(question, as_json=True)
        assert isinstance(answer, str)
        return answer

    async def _asked(self, question: PipelineQuestion | bytes, *, as_json: bool) -> Any:  # noqa: ANN401 - one or the other
        draft = await self.open()

        def asked(changed: Changed, running: Changed) -> DraftQuestion:
            return DraftQuestion(draft.number, changed, running, self.folder, question, as_json)

        return await self._pipelines.ask(asked, draft.files, draft.base, patience=RUN_WITHIN)

    async def _files_of(self, draft: Draft, paths: Sequence[str] | None) -> str:
        found = await self._editing.ask(draft.files, "shown", draft.number, paths)
        assert isinstance(found, str)
        return found

    def _found(self, check: CheckView) -> None:
        self._check = check
        if self._shown is not None:
            self._show(self._shown.model_copy(update={"check": check}))

    def _show(self, shown: WorkshopView) -> None:
        self._shown = shown
        self._encoded = None
        self.latest.tell()

    def _present(self) -> str:
        if self._encoded is None:
            assert self._shown is not None  # nobody listens before it was opened
            self._encoded = WorkshopSnapshot(kind="workshop", workshop=self._shown).model_dump_json()
        return self._encoded
