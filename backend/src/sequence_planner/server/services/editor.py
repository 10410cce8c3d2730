"""The server's workshop: the one draft of its station, kept in the database and checked whenever it changes."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from sqlalchemy import Connection
from starlette.concurrency import run_in_threadpool

from sequence_planner.controller.views.pipelines import RecordView
from sequence_planner.controller.views.station import DeploymentState, StationView
from sequence_planner.core.actor import Actor
from sequence_planner.editor import draft as drafts
from sequence_planner.editor.draft import (
    AddEntry,
    Differences,
    Draft,
    DraftChange,
    DraftProposal,
    Edit,
    PartChangedError,
    WriteText,
)
from sequence_planner.editor.pipelines.schemas import Examples, RecordedView, Recording
from sequence_planner.editor.processes import ComparisonDesk, DraftProcess
from sequence_planner.editor.revision import Revision
from sequence_planner.editor.schemas.check import waiting
from sequence_planner.editor.schemas.draft import (
    DraftChangesView,
    DraftView,
    FileMark,
    PlannedDeploymentView,
    RevisionsView,
    RevisionView,
    WorkshopView,
    change_view,
    marks,
    places_changed,
    revisions_view,
)
from sequence_planner.editor.talk.comments import read_verdicts
from sequence_planner.model.files import Files, FolderReader
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.model.paths import EditError
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.server.services.reading import ReadableWorkshop
from sequence_planner.server.settings import Settings, StreamLimits
from sequence_planner.texts.message import message
from sequence_planner.texts.refused import Refused

MOST_SHOWN = 50  # changes
MOST_TOLD = 12  # changes of which it is told what they did: as many as the page shows
FOLDED_WITHIN = 110.0  # seconds, for the states that a station can come to
TRIED_FOR = 900.0  # seconds for which a simulation is kept that nobody asks for


class Workshop(ReadableWorkshop):
    """The draft of the station in the folder `model`, and its `revisions`."""

    def __init__(
        self, identity: IdentityService, model: Path, revisions: Path, limits: StreamLimits, start: StartNeeds
    ) -> None:
        super().__init__(model, limits, start)
        self._files = FolderReader(model)
        self._identity = identity
        self._revisions = revisions
        self._stepping = DraftProcess("stepping.worker")
        self._simulating = DraftProcess("simulating.worker", rests_after=TRIED_FOR)
        self._outlining = DraftProcess("outline.worker")
        self._spaces = DraftProcess("state_space.worker", rests_after=TRIED_FOR)
        self._comparing = ComparisonDesk(model)
        self._marks: tuple[Draft, dict[str, FileMark], int] | None = None  # and in how many places it differs
        self._opening = asyncio.Lock()
        self._saves = 0  # so far
        self._edited: tuple[tuple[Draft, int], tuple[Revision, int] | None] | None = None  # as what that is saved
        self._planned: PlannedDeploymentView | None = None
        self._comment = 0
        self._deployed_over: tuple[float, Files] | None = None  # when, and what: until it is seen what became of it

    @classmethod
    def for_model(cls, identity: IdentityService, settings: Settings) -> Workshop | None:
        """The workshop of the server's model; None where it does not know any."""
        model, revisions = settings.model, settings.revisions
        if model is None or revisions is None:
            return None
        return cls(identity, model, revisions, settings.stream, settings.start)

    async def close(self) -> None:
        """End what is being checked and answered."""
        await super().close()
        await self._comparing.close()
        for each in (self._stepping, self._simulating, self._outlining, self._spaces):
            each.close()

    async def _opened(self) -> Draft:
        """The draft, begun if there is none yet, with what has happened to the files of the station since."""
        async with self._opening:
            files = await run_in_threadpool(self._files.read)
            draft = await self._identity.read(drafts.read)
            if draft.number and draft.base != files and self._was_before_the_deployment(files):
                # A deployment was undone. What was deployed stays in the draft, where it can be mended.
                await self._identity.write(lambda connection: drafts.rebase(connection, files))
                draft = replace(draft, base=files)
            while not draft.number or draft.base != files:
                proposal = await self._proposed(draft, "taken_up", draft.number, draft.base, files)
                taking = partial[Draft | None](_taken_up, draft, files, proposal, self._identity.now())
                if (taken := await self._identity.write(taking)) is None:
                    taken = await self._identity.read(drafts.read)
                draft = taken
            await self._noticed(draft)
        return draft

    async def view(self, by: Actor) -> DraftView:
        """The draft, for somebody who could undo what they did. Raises `WorkerError`."""
        draft = await self.open()
        files, _ = await self._marked(draft)

        def read(connection: Connection) -> DraftView:
            done, undone = drafts.stacks(connection, by)
            return DraftView(
                number=draft.number,
                files=files,
                changes=[
                    *(change_view(each, did) for each, did in drafts.accounts(connection, MOST_TOLD)),
                    *(change_view(each, {}) for each in drafts.changes(connection, MOST_SHOWN)[MOST_TOLD:]),
                ],
                undo=done[-1].title if done else None,
                redo=undone[-1].title if undone else None,
            )

        return await self._identity.read(read)

    async def changes(self) -> DraftChangesView:
        """In how many places the draft differs from what runs. It is neither begun nor checked for that."""
        draft = await self._identity.read(drafts.read)
        places = (await self._marked(draft))[1] if draft.number else 0
        return DraftChangesView(number=draft.number, changes=places)

    async def request(self, body: bytes, by: Actor) -> str:
        """Carry out the edits of a `ChangeBody`; the files that are others now, as JSON of a `FilesView`.

        Raises `BodyError`, `EditError` and `WorkerError`.
        """
        return (await self._changed(lambda draft: self._proposed(draft, "requested", body), by))[1]

    async def change(self, edits: Sequence[Edit], by: Actor, title: str) -> int:
        """Carry edits out; the number of the change. Raises `EditError` and `WorkerError`."""
        return (await self._changed(lambda draft: self._proposed(draft, "edited", edits, title), by))[0]

    async def rename(self, part: str, name: str, by: Actor) -> str:
        """Give a part another name, which all that name it follow; the files that are others now, as JSON.

        Raises `EditError` and `WorkerError`.
        """

        async def propose(draft: Draft) -> DraftProposal:
            found = await self._process.ask(draft.files, "renamed_files", part, name)
            assert isinstance(found, dict)
            edits = [WriteText(file=path, was=draft.files.get(path), text=text) for path, text in found.items()]
            return await self._proposed(draft, "edited", edits, f"{part.partition(':')[2]} is called {name}")

        return (await self._changed(propose, by))[1]

    async def outlined(self, outline: object) -> str:
        """Return what an `Outline` becomes, for a station that is called as this one, as JSON of an `OutlineView`.

        Raises `WorkerError`.
        """
        found = await self._outlining.ask((await self.open()).files, "outlined", outline)
        assert isinstance(found, str)
        return found

    async def stepped(
        self, present: Mapping[str, object], steps: Sequence[object], *, follow: bool, until: str | None
    ) -> str:
        """Lead a station through the draft from `present` values on; JSON of a `StepsView`.

        Raises `EditError` for a condition that is none, and `WorkerError`.
        """
        draft = await self.open()
        asked = draft.number, self.folder, present, list(steps), follow, until
        found = await self._stepping.ask(draft.files, "stepped", *asked)
        assert isinstance(found, str)
        return found

    async def space(self, present: Mapping[str, object], question: object) -> str:
        """Return the states that the draft can come to, folded as the question wants, with the `present` values; JSON
        of a `StateSpaceView`.

        Raises `EditError` for what is not in the model, and `WorkerError`.
        """
        draft = await self.open()
        asked = draft.number, self.folder, present, question
        found = await self._spaces.ask(draft.files, "space", *asked, patience=FOLDED_WITHIN)
        assert isinstance(found, str)
        return found

    async def simulated(self, id: str | None, present: Mapping[str, object] | str, advance: object) -> str:
        """Begin a simulation of the draft from `present` values or with the scenario of that name, or let the one with
        this `id` go on; JSON of a `SimulationView`.

        Raises `EditError` for what cannot be done, `NoSimulationError` and `WorkerError`.
        """
        draft = await self.open()
        asked = draft.number, self.folder, id, present, advance
        found = await self._simulating.ask(draft.files, "simulated", *asked)
        assert isinstance(found, str)
        return found

    async def scenario_of(self, id: str, expected: object) -> str:
        """Return the scenario that a simulation becomes; JSON of a `WrittenScenarioView`.

        Raises `EditError` where it expects nothing, `NoSimulationError` and `WorkerError`.
        """
        draft = await self.open()
        found = await self._simulating.ask(draft.files, "scenario", id, expected)
        assert isinstance(found, str)
        return found

    async def undo(self, by: Actor) -> str:
        """Take back what somebody did last; JSON of a `FilesView`. Raises `EditError` and `WorkerError`."""
        return (await self._changed(lambda draft: self._again(draft, by, undo=True), by))[1]

    async def redo(self, by: Actor) -> str:
        """Do again what somebody took back last; JSON of a `FilesView`. Raises `EditError` and `WorkerError`."""
        return (await self._changed(lambda draft: self._again(draft, by, undo=False), by))[1]

    async def revised(self) -> RevisionsView:
        """All revisions. Raises `WorkerError`."""
        revisions, running, edited = await self.saved()
        return revisions_view(revisions, running, edited, await self._identity.read(read_verdicts))

    async def saved(self) -> tuple[list[Revision], str, str]:
        """All revisions, newest first, and the trees of what runs and of the draft. Raises `WorkerError`."""
        return await self._revised(await self.open())

    async def _revised(self, draft: Draft) -> tuple[list[Revision], str, str]:
        found = await self._editing.ask(draft.files, "revised", self._revisions, draft.base)
        assert isinstance(found, tuple)
        return found

    async def edited_revision(self) -> tuple[Revision, int] | None:
        """The revision that the draft is, with its number from the oldest on, where another model runs; found once for
        each draft, which is neither begun nor checked for that. Raises `WorkerError`.
        """
        draft = await self._identity.read(drafts.read)
        async with self._opening:
            files = await run_in_threadpool(self._files.read)
        if not draft.number or draft.files == files:
            return None
        asked = draft, self._saves
        if self._edited is None or self._edited[0] != asked:
            revisions, _, tree = await self._revised(draft)
            numbered = zip(revisions, range(len(revisions), 0, -1), strict=True)
            self._edited = asked, next(((each, number) for each, number in numbered if each.tree == tree), None)
        return self._edited[1]

    async def files_of(self, revision: str) -> dict[str, str]:
        """The files of a revision. Raises `EditError` where there is none, and `WorkerError`."""
        found = await self._editing.ask((await self.open()).files, "files_of", self._revisions, revision)
        assert isinstance(found, dict)
        return found

    async def compared(self, old: Files, new: Files, patience: float, *, written_only: bool) -> str:
        """Return what is known within so many seconds of how two versions differ, or only of how that is written, as
        JSON of a `ComparisonView`.

        Raises `WorkerError`.
        """
        return await self._comparing.compare(old, new, patience, written_only=written_only)

    async def save(self, draft: Draft, name: str, message: str, by: Actor) -> RevisionView:
        """Save the draft under a name. Raises `EditError` and `WorkerError`."""
        asked = self._revisions, draft.base, name, message, by, self._identity.now()
        saved = await self._editing.ask(draft.files, "saved", *asked)
        assert isinstance(saved, Revision)
        self._saves += 1
        return next(each for each in (await self.revised()).revisions if each.id == saved.id)

    def note_deployment(self, draft: Draft) -> None:
        """The draft is about to be deployed."""
        self._deployed_over = self._identity.now(), draft.base

    @property
    def planned(self) -> PlannedDeploymentView | None:
        """What is to be deployed later, or was not."""
        return self._planned

    def plan_deployment(self, planned: PlannedDeploymentView | None) -> None:
        """Show what is to be deployed later."""
        self._planned = planned
        if self._shown is not None and self._shown.planned != planned:
            self._show(self._shown.model_copy(update={"planned": planned}))

    def tell_comment(self, number: int) -> None:
        """Show that somebody has said something of the draft."""
        self._comment = number
        if self._shown is not None:
            self._show(self._shown.model_copy(update={"comment": number}))

    def hear(self, view: StationView) -> None:
        """Take note of what the controller shows: whoever brings files back that were there before a deployment that
        went well has changed the model, and nothing is undone by that.
        """
        deployment, deployed = view.deployment, self._deployed_over
        if deployment is None or deployed is None or deployment.state is not DeploymentState.RUNS:
            return
        if deployment.at >= deployed[0]:  # not an earlier one
            self._deployed_over = None

    def _was_before_the_deployment(self, files: Files) -> bool:
        return self._deployed_over is not None and self._deployed_over[1] == files

    async def restore(self, draft: Draft, files: Files, name: str, by: Actor) -> str:
        """Let the draft become these files, those of the revision `name`; JSON of a `FilesView` of what is other now.

        Raises `EditError` and `WorkerError`.
        """
        edits = [
            WriteText(file=path, was=draft.files.get(path), text=files.get(path))
            for path in sorted(draft.files.keys() | files.keys())
            if draft.files.get(path) != files.get(path)
        ]
        title = f"Back to “{name}”"
        return (await self._changed(lambda draft: self._proposed(draft, "edited", edits, title), by))[1]

    async def begin_with(self, number: int, example: Files, title: str, by: Actor) -> str:
        """Let the draft, after its change `number`, become an example with the name that the station has; JSON of a
        `FilesView` of what is other now.

        Raises `Refused` where it is another draft by now, `EditError` and `WorkerError`.
        """

        async def propose(draft: Draft) -> DraftProposal:
            if draft.number != number:
                raise Refused("stale-draft", message("refused.stale-draft.look"))
            return await self._proposed(draft, "begun_with", example, title)

        return (await self._changed(propose, by))[1]

    async def record(self, pipeline: str, name: str, heard: RecordView, by: Actor) -> RecordedView:
        """Add an example to the draft. Raises `EditError` and `WorkerError`."""
        question = Recording(pipeline=pipeline, name=name, first=heard.first, last=heard.last)
        (made,) = await self._asked(question, as_json=False)
        edit = AddEntry(file=made.file, path=[*made.path, 0], value=made.example)
        number = await self.change([edit], by, f"An example of {pipeline}: {name}")
        (runs,) = await self._asked(Examples(pipeline=pipeline, name=name), as_json=False)
        return RecordedView(number=number, run=runs.runs[-1], example=made.example, left_out=made.left_out)

    async def _again(self, draft: Draft, by: Actor, *, undo: bool) -> DraftProposal:
        def last(connection: Connection) -> tuple[DraftChange, Differences]:
            done, undone = drafts.stacks(connection, by)
            if not (found := done if undo else undone):
                raise EditError(message("edit.nothing-to-undo" if undo else "edit.nothing-to-redo"))
            return found[-1], drafts.differences_of(connection, found[-1])

        return await self._proposed(draft, "undone" if undo else "redone", *await self._identity.read(last))

    async def _proposed(self, draft: Draft, name: str, *asked: object) -> DraftProposal:
        proposal = await self._editing.ask(draft.files, name, *asked)
        assert isinstance(proposal, DraftProposal)
        return proposal

    async def _changed(self, propose: Callable[[Draft], Awaitable[DraftProposal]], by: Actor) -> tuple[int, str]:
        """Let the draft be what is proposed, which is thought of again where somebody else was quicker; the number of
        the change, and the files that are others then as JSON of a `FilesView`.
        """
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
        return after.number, await self._files_of(after, list(proposal.changed))

    async def _told_by_whom(self, error: PartChangedError, by: Actor) -> PartChangedError:
        """The same with the name of who was there before."""
        last = await self._identity.read(lambda connection: drafts.last_of(connection, error.file))
        if last is None or last.by_id == by.id:
            return error
        return PartChangedError(error.file, error.path, message("edit.by", what=error.why, person=last.by_name))

    async def _noticed(self, draft: Draft) -> None:
        """Show the draft, and check it, where it is another one; after a deployment only how its files stand is."""
        files, places = await self._marked(draft)
        if (shown := self._shown) is not None and shown.number == draft.number:
            if files != shown.files:
                self._show(shown.model_copy(update={"files": files, "changes": places}))
            return
        changes = await self._identity.read(lambda connection: drafts.accounts(connection, 1))
        last = change_view(*changes[0]) if changes else None
        self._shown = WorkshopView(
            number=draft.number,
            files=files,
            changes=places,
            last=last,
            check=waiting(draft.number),
            planned=self._planned,
            comment=self._comment,
        )
        if draft.files != draft.base:  # or else the check finds out about what runs
            self._comparing.warm_up(draft.base)
        self._desk.check(draft.number, draft.files)

    async def _marked(self, draft: Draft) -> tuple[dict[str, FileMark], int]:
        """Return how each file stands, and in how many places all differ; found once for each draft."""
        if self._marks is None or self._marks[0] != draft:
            self._marks = draft, *await run_in_threadpool(lambda: (marks(draft), places_changed(draft)))
        return self._marks[1:]


def _taken_up(draft: Draft, files: Files, proposal: DraftProposal, now: float, connection: Connection) -> Draft | None:
    return drafts.take_up(connection, draft, files, proposal, now)


def _written(draft: Draft, proposal: DraftProposal, by: Actor, now: float, connection: Connection) -> Draft | None:
    return drafts.write(connection, draft, proposal, by, now)
