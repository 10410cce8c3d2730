"""The server's workshop: the one draft of its station, kept in the database and checked whenever it changes."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from functools import partial
from pathlib import Path

from sqlalchemy import Connection
from starlette.concurrency import run_in_threadpool

from sequence_planner.actor import Actor
from sequence_planner.control.definition_view import AutomatonView
from sequence_planner.control.pipeline_view import RecordView
from sequence_planner.model.paths import EditError
from sequence_planner.web.identity import IdentityOffice
from sequence_planner.web.latest import Latest
from sequence_planner.web.looking_messages import WorkshopSnapshot
from sequence_planner.web.settings import StreamLimits
from sequence_planner.workshop import draft as drafts
from sequence_planner.workshop.asking import Changed, DraftAnswering
from sequence_planner.workshop.check_process import CheckDesk
from sequence_planner.workshop.check_view import CheckView, waiting
from sequence_planner.workshop.draft import Change, Differences, Draft, Proposal
from sequence_planner.workshop.draft_process import DraftProcess
from sequence_planner.workshop.edits import AddEntry, Edit, PartChangedError, WriteText
from sequence_planner.workshop.files import Files, FolderReader
from sequence_planner.workshop.pipelines.questions import (
    Asked,
    Examples,
    PipelineAnswer,
    PipelineQuestion,
    Recording,
)
from sequence_planner.workshop.pipelines.view import RecordedView, RecordingView, RunsView
from sequence_planner.workshop.processes import worked
from sequence_planner.workshop.questions import LanguageAnswer, LanguageQuestionKind, TextAt
from sequence_planner.workshop.revisions import Revision, Revisions, tree_of
from sequence_planner.workshop.showing import Reader, change_view, marks
from sequence_planner.workshop.view import DraftView, FilesView, RevisionsView, RevisionView, UsagesView, WorkshopView

MOST_SHOWN = 50  # changes
ANSWERED_WITHIN = 20.0  # seconds, for questions about a text
RUN_WITHIN = 30.0  # seconds, for questions about pipelines, which run


def _revision_view(revision: Revision, running: str, edited: str) -> RevisionView:
    return RevisionView(
        id=revision.id,
        name=revision.name,
        message=revision.message,
        by=revision.by,
        time=revision.time,
        running=revision.tree == running,
        draft=revision.tree == edited,
    )


class Workshop:
    """The draft of the station in the folder `model`, and its `revisions`. Used from one event loop."""

    def __init__(self, identity: IdentityOffice, model: Path, revisions: Path, limits: StreamLimits) -> None:
        self.latest = Latest(self._present, limits)
        self.folder = model
        self._files = FolderReader(model)
        self._identity = identity
        self._revisions = Revisions(revisions)
        self._keeping = asyncio.Lock()
        self._reader = Reader()
        self._process = DraftProcess()
        self._desk = CheckDesk(model, self._process, self._found)
        self._pipelines = DraftAnswering("pipelines.worker", "answering", 2)  # the draft, and what runs
        self._check: CheckView | None = None
        self._shown: WorkshopView | None = None
        self._encoded: str | None = None
        self._opening = asyncio.Lock()
        self._tied: tuple[int, str] | None = None  # the number of a draft, and its graph
        self._tying = asyncio.Lock()

    async def close(self) -> None:
        """End what is being checked and answered."""
        await self._desk.close()
        await self._process.close()
        await self._pipelines.close()

    async def read_ahead(self) -> None:
        """Read what the files hold, so that whoever asks for them first need not wait for that."""
        files = await run_in_threadpool(self._files.read)
        draft = await self._identity.read(drafts.read)
        for each in (draft, Draft(draft.number, files, files)):
            await run_in_threadpool(self._reader.views, each, each.files)

    async def open(self) -> Draft:
        """The draft, begun if there is none yet, with what has happened to the files of the station since."""
        async with self._opening:
            files = await run_in_threadpool(self._files.read)
            draft = await self._identity.read(drafts.read)
            if not draft.number or draft.base != files:
                now = self._identity.now()
                draft = await self._identity.write(lambda connection: drafts.take_up(connection, files, now))
            await self._noticed(draft)
        return draft

    async def view(self, by: Actor) -> DraftView:
        """The draft, for somebody who could undo what they did."""
        draft = await self.open()

        def read(connection: Connection) -> DraftView:
            done, undone = drafts.stacks(connection, by)
            return DraftView(
                number=draft.number,
                files=marks(draft),
                changes=[change_view(each) for each in drafts.changes(connection, MOST_SHOWN)],
                undo=done[-1].title if done else None,
                redo=undone[-1].title if undone else None,
            )

        return await self._identity.read(read)

    async def files(self, paths: Sequence[str] | None = None) -> FilesView:
        """Files of the draft; all of them where none are named."""
        draft = await self.open()
        chosen = list(draft.files) if paths is None else paths
        found = await run_in_threadpool(self._reader.views, draft, chosen)
        return FilesView(number=draft.number, files=found)

    async def change(self, edits: Sequence[Edit], by: Actor, title: str) -> FilesView:
        """Carry edits out; the files that are others now. Raises `EditError`."""
        return await self._changed(lambda draft: run_in_threadpool(drafts.editing, draft, edits, title), by)

    async def rename(self, part: str, name: str, by: Actor) -> FilesView:
        """Give a part another name, which all that name it follow; the files that are others now.

        Raises `EditError` and `WorkEndedError`.
        """

        async def propose(draft: Draft) -> Proposal:
            found = await self._process.ask(draft.files, "renamed_files", part, name)
            if isinstance(found, str):
                raise EditError(found)
            assert isinstance(found, dict)
            edits = [WriteText(file=path, was=draft.files.get(path), text=text) for path, text in found.items()]
            title = f"{part.partition(':')[2]} is called {name}"
            return await run_in_threadpool(drafts.editing, draft, edits, title)

        return await self._changed(propose, by)

    async def usages(self, part: str) -> UsagesView:
        """Where a part is named. Raises `EditError` and `WorkEndedError`."""
        found = await self._process.ask((await self.open()).files, "used", part)
        if isinstance(found, str):
            raise EditError(found)
        assert isinstance(found, UsagesView)
        return found

    async def tied(self) -> str:
        """What is tied to what, as JSON of a `GraphView`: found once for each draft. Raises `WorkEndedError`."""
        async with self._tying:
            draft = await self.open()
            if self._tied is None or self._tied[0] != draft.number:
                found = await self._process.ask(draft.files, "tied", draft.number)
                assert isinstance(found, str)
                self._tied = draft.number, found
            return self._tied[1]

    async def played(self, finding: int, ability: str, number: int) -> list[AutomatonView]:
        """How an ability goes through the run that shows a finding of the check of change `number`.

        Raises `EditError` where there is no such run or ability, and `WorkEndedError`.
        """
        check, draft = await self.checked(), await self.open()
        if number != check.number or number != draft.number:
            raise EditError("the draft has changed since: look at its findings again")
        trace = check.findings[finding].trace if finding < len(check.findings) else None
        if trace is None:
            raise EditError("there is no run that shows such a finding")
        found = await worked("drawn", draft.files, self.folder, ability, trace)
        if isinstance(found, str):
            raise EditError(found)
        assert isinstance(found, list)
        return found

    async def undo(self, by: Actor) -> FilesView:
        """Take back what somebody did last. Raises `EditError`."""
        return await self._changed(lambda draft: self._again(draft, by, undo=True), by)

    async def redo(self, by: Actor) -> FilesView:
        """Do again what somebody took back last. Raises `EditError`."""
        return await self._changed(lambda draft: self._again(draft, by, undo=False), by)

    async def checked(self) -> CheckView:
        """What is known of the draft."""
        draft = await self.open()
        return self._check or waiting(draft.number)

    async def revised(self) -> RevisionsView:
        """All revisions."""
        draft = await self.open()

        def read() -> RevisionsView:
            edited, running = tree_of(draft.files), tree_of(draft.base)
            views = [_revision_view(each, running, edited) for each in self._revisions.all()]
            return RevisionsView(
                revisions=views,
                saved=any(each.draft for each in views),
                running=any(each.running for each in views),
            )

        return await run_in_threadpool(read)

    async def files_of(self, revision: str) -> dict[str, str]:
        """The files of a revision. Raises `EditError` where there is none."""
        return await run_in_threadpool(self._revisions.files, revision)

    async def save(self, draft: Draft, name: str, message: str, by: Actor) -> RevisionView:
        """Save the draft under a name. Raises `EditError`."""
        async with self._keeping:
            saved = await run_in_threadpool(
                self._revisions.save, draft.files, draft.base, name, message, by, self._identity.now()
            )
        return _revision_view(saved, tree_of(draft.base), saved.tree)

    async def restore(self, draft: Draft, files: Files, name: str, by: Actor) -> FilesView:
        """Let the draft become these files, those of the revision `name`; the files that are others now."""
        edits = [
            WriteText(file=path, was=draft.files.get(path), text=files.get(path))
            for path in sorted(draft.files.keys() | files.keys())
            if draft.files.get(path) != files.get(path)
        ]
        return await self.change(edits, by, f"Back to “{name}”")

    async def ask(self, kind: LanguageQuestionKind, asked: TextAt) -> LanguageAnswer:
        """What is answered to a question about a text. Raises `WorkEndedError`."""
        draft = await self.open()
        answer = await self._process.ask(draft.files, "answer", kind, asked, patience=ANSWERED_WITHIN)
        assert isinstance(answer, LanguageAnswer)
        return answer

    async def ask_pipelines(self, question: PipelineQuestion) -> PipelineAnswer:
        """What is answered to a question about the pipelines. Raises `EditError` and `WorkEndedError`."""
        draft = await self.open()

        def asked(changed: Changed, running: Changed) -> Asked:
            return Asked(draft.number, changed, running, self.folder, question)

        answer = await self._pipelines.ask(asked, draft.files, draft.base, patience=RUN_WITHIN)
        if isinstance(answer, str):
            raise EditError(answer)
        assert isinstance(answer, PipelineAnswer)
        return answer

    async def record(self, pipeline: str, name: str, heard: RecordView, by: Actor) -> RecordedView:
        """Add an example to the draft. Raises `EditError` and `WorkEndedError`."""
        question = Recording(pipeline=pipeline, name=name, first=heard.first, last=heard.last)
        made = await self.ask_pipelines(question)
        assert isinstance(made, RecordingView)
        edit = AddEntry(file=made.file, path=[*made.path, 0], value=made.example)
        changed = await self.change([edit], by, f"An example of {pipeline}: {name}")
        runs = await self.ask_pipelines(Examples(pipeline=pipeline, name=name))
        assert isinstance(runs, RunsView)
        return RecordedView(number=changed.number, run=runs.runs[-1], example=made.example, left_out=made.left_out)

    async def _again(self, draft: Draft, by: Actor, *, undo: bool) -> Proposal:
        def last(connection: Connection) -> tuple[Change, Differences]:
            done, undone = drafts.stacks(connection, by)
            if not (found := done if undo else undone):
                raise EditError(f"there is nothing of yours to {'undo' if undo else 'do again'}")
            return found[-1], drafts.differences_of(connection, found[-1])

        propose = drafts.undoing if undo else drafts.redoing
        return await run_in_threadpool(propose, draft, *await self._identity.read(last))

    async def _changed(self, propose: Callable[[Draft], Awaitable[Proposal]], by: Actor) -> FilesView:
        """Let the draft be what is proposed, which is thought of again where somebody else was quicker."""
        while True:
            before = await self.open()
            try:
                proposal = await propose(before)
            except PartChangedError as error:
                raise await self._told_by_whom(error, by) from error
            now = self._identity.now()
            after = await self._identity.write(partial(_written, before, proposal, by, now), by=by)
            if after is not None:
                break
        await self._noticed(after)
        touched = [
            path
            for path in sorted(before.files.keys() | after.files.keys())
            if before.files.get(path) != after.files.get(path)
        ]
        found = await run_in_threadpool(self._reader.views, after, touched)
        return FilesView(number=after.number, files=found)

    async def _told_by_whom(self, error: PartChangedError, by: Actor) -> PartChangedError:
        """The same with the name of who was there before."""
        last = await self._identity.read(lambda connection: drafts.last_of(connection, error.file))
        if last is None or last.by_id == by.id:
            return error
        return PartChangedError(error.file, error.path, f"{error}, by {last.by_name}")

    async def _noticed(self, draft: Draft) -> None:
        """Show the draft, and check it, where it is another one."""
        if self._shown is not None and self._shown.number == draft.number:
            return
        changes = await self._identity.read(lambda connection: drafts.changes(connection, 1))
        last = change_view(changes[0]) if changes else None
        self._shown = WorkshopView(number=draft.number, files=marks(draft), last=last, check=waiting(draft.number))
        self._desk.check(draft.number, draft.files)

    def _found(self, check: CheckView) -> None:
        self._check = check
        if self._shown is not None:
            self._shown = self._shown.model_copy(update={"check": check})
        self._encoded = None
        self.latest.tell()

    def _present(self) -> str:
        if self._encoded is None:
            assert self._shown is not None  # nobody listens before it was opened
            self._encoded = WorkshopSnapshot(kind="workshop", workshop=self._shown).model_dump_json()
        return self._encoded


def _written(draft: Draft, proposal: Proposal, by: Actor, now: float, connection: Connection) -> Draft | None:
    return drafts.write(connection, draft, proposal, by, now)
