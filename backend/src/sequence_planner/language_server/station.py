"""A station whose documents are open in an editor: unsaved texts over its files, what is wrong, and what names mean."""

from __future__ import annotations

import asyncio
import gc
import tempfile
import traceback
from dataclasses import replace
from pathlib import Path
from typing import Protocol

from sequence_planner.analysis.report import AnalysisDocument, FindingDocument, error_document
from sequence_planner.core.late_log import LateLog
from sequence_planner.editor.language.draft import LanguageDraft
from sequence_planner.editor.processes import CheckDesk, Knowing
from sequence_planner.editor.schemas.check import CheckState, CheckView, listed
from sequence_planner.editor.symbols.texts import ModelContent
from sequence_planner.language.types import Place
from sequence_planner.language_server.snapshot import StationSnapshot
from sequence_planner.language_server.threads import ServerThreads
from sequence_planner.model.files import LONGEST_FILE, Files, FolderReader, is_of_model
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.model.reading.folder import unread_files
from sequence_planner.model.source import Finding
from sequence_planner.process.gc_tuning import collection_put_off
from sequence_planner.process.task import WorkerError

LOG = LateLog(__name__)


class StationListener(Protocol):
    """Whoever is told what has become known of a station."""

    def findings_changed(self, station: EditedStation) -> None:
        """Other things are wrong with it."""
        ...

    def guards_changed(self, station: EditedStation) -> None:
        """Its supervisor adds something else."""
        ...


class EditedStation:
    """The station in `folder`. Used from one event loop; what takes longer is done in `threads`.

    `findings` are of change `checked`: then its files were `checked_files`. `analysis` has what the supervisor adds, as
    far as that is known; after an edit it is that of before until it has been found again.
    """

    def __init__(self, folder: Path, threads: ServerThreads, listener: StationListener, deadline: float) -> None:
        self.folder = folder
        self.number = 0
        self.findings: list[FindingDocument] = []
        self.checked_files: Files = {}
        self.analysis: AnalysisDocument | None = None
        self._listener = listener
        self._threads = threads
        self._saved = FolderReader(folder)
        self._on_disk: dict[str, str] = {}
        self._typed: dict[str, str] = {}
        self._temporary = tempfile.TemporaryDirectory(prefix="sequence-planner-language-", ignore_cleanup_errors=True)
        self._draft = LanguageDraft(Path(self._temporary.name) / "draft")
        self._knowing = Knowing()
        self._snapshot: asyncio.Future[StationSnapshot] | None = None
        self._desk = CheckDesk(folder, StartNeeds(), self, self._hear, deadline)
        self._files_of: dict[int, Files] = {}
        self._readable: dict[str, str] = {}

    @property
    def files(self) -> Files:
        """The files as they are typed, where they are open, or else as they are saved."""
        return {**self._on_disk, **self._typed}

    def file_of(self, path: Path) -> str | None:
        """What a path is called in the station; None for what is no file of it."""
        try:
            name = path.relative_to(self.folder).as_posix()
        except ValueError:
            return None
        return name if is_of_model(name) else None

    def typed(self, file: str, text: str | None) -> None:
        """A file has this text in the editor; none where it has been closed there."""
        if text is None:
            self._typed.pop(file, None)
        else:
            self._typed[file] = text

    def look_again(self) -> None:
        """See what has been saved in its folder."""
        try:
            self._on_disk = self._saved.read()
        except OSError:
            self._on_disk = {}

    def changed(self) -> None:
        """Find out anew what is wrong with it and what its names mean."""
        self.number += 1
        files = self.files
        self._files_of = {number: each for number, each in self._files_of.items() if number > self.number - 3}
        self._files_of[self.number] = files
        self._desk.check(self.number, files)

    async def errors(self, files: Files) -> list[FindingDocument]:
        """Return what makes it unusable, as far as it shows before pipelines are built. Raises `WorkerError`."""
        number = self.number
        try:
            found = await self._threads.found_later(lambda: self._errors(files))
        except Exception as error:  # so that what is typed next is looked at all the same
            LOG.error("a station could not be looked at", because="".join(traceback.format_exception(error)))
            raise WorkerError(str(error)) from error
        if not found and any(each.severity == "error" for each in self.findings):
            self._show(number, files, [])
        self._read_names(number, files)
        return found

    async def snapshot(self) -> StationSnapshot:
        """Return what its names mean, now or as far as that was last made out."""
        if self._snapshot is None:
            self._read_names(self.number, self.files)
        assert self._snapshot is not None
        return await asyncio.shield(self._snapshot)

    async def close(self) -> None:
        """End what is being found out about it."""
        await self._desk.close()
        await self._threads.found_later(self._temporary.cleanup)

    def _hear(self, view: CheckView) -> None:
        files = self._files_of.get(view.number)
        if files is None or view.state is CheckState.WAITING:
            return
        if view.analysis is not None and view.analysis.guards is not None:
            self.analysis = view.analysis
            self._listener.guards_changed(self)
        if view.findings or view.state is CheckState.DONE:
            self._show(view.number, files, view.findings)

    def _show(self, number: int, files: Files, findings: list[FindingDocument]) -> None:
        self.findings, self.checked_files = findings, files
        self._listener.findings_changed(self)

    @collection_put_off()
    def _errors(self, files: Files) -> list[FindingDocument]:
        too_long = []
        for file, text in files.items():
            if len(text) > LONGEST_FILE:
                message = f"this has {len(text)} characters, and a file of a model has at most {LONGEST_FILE}"
                too_long.append(Finding(Place(file, 1, 1), message))
        if too_long:
            return [error_document(each) for each in too_long]
        self._draft.take(self._knowing.news(files))
        wrong = self._draft.errors()
        beside = [
            replace(each, place=each.place._replace(file=Path(each.place.file).relative_to(self.folder).as_posix()))
            for each in unread_files(self.folder)
        ]
        return listed([error_document(each) for each in sorted({*wrong, *beside})])

    def _read_names(self, number: int, files: Files) -> None:
        """Have names read; until then those from before are known."""
        made = asyncio.ensure_future(self._threads.found_later(lambda: self._read(number, files)))
        if self._snapshot is None or not self._snapshot.done():
            self._snapshot = made
        else:
            made.add_done_callback(self._know)

    def _know(self, made: asyncio.Future[StationSnapshot]) -> None:
        if not made.cancelled() and made.exception() is None:
            self._snapshot = made

    @collection_put_off()
    def _read(self, number: int, files: Files) -> StationSnapshot:
        files = {file: text for file, text in files.items() if len(text) <= LONGEST_FILE}
        if not self._readable:  # names that are saved are known where what is typed cannot be read yet
            self._draft.take(self._knowing.news(self._on_disk))
            assert self._draft.lexicon
            gc.freeze()  # most of it stays, and to look through it would hold up whoever types
        self._draft.take(self._knowing.news(files))
        lexicon = self._draft.lexicon
        for each in (lexicon.family, lexicon.operations):  # here, and not when somebody waits for them
            assert each is not None
        return StationSnapshot(number, files, lexicon, self._draft.messages(), self._content(files))

    def _content(self, files: Files) -> ModelContent:
        """The files, those that are no YAML now as they were when they were."""
        content = ModelContent(files)
        self._readable = {file: files[file] if file in content else self._readable.get(file, "") for file in files}
        return ModelContent(self._readable) if content.skipped else content
