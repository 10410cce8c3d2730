"""What an editor offers to do where the cursor is: mending of findings, usual forms, and what can be said shorter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from weakref import WeakKeyDictionary

from lsprotocol import types

from sequence_planner.analysis.report import FindingDocument
from sequence_planner.editor.folds.finder import Fold, FoldFinder
from sequence_planner.editor.language.types.places import text_place
from sequence_planner.language_server.answers.findings import diagnostics_of, new_name, range_of
from sequence_planner.language_server.documents.cursor import read_at
from sequence_planner.language_server.documents.texts import DocumentText, edits_between
from sequence_planner.language_server.server import StationLanguageServer
from sequence_planner.language_server.snapshot import StationSnapshot
from sequence_planner.language_server.station import EditedStation
from sequence_planner.language_server.workspace import StationFile
from sequence_planner.model.source import ModelError

_FOLDS_WITHIN = 10.0  # seconds


class _StationFolds:
    """Finds what can be said shorter in a station; what was read is kept from one question to the next."""

    def __init__(self) -> None:
        self._folder = TemporaryDirectory(prefix="sequence-planner-folds-", ignore_cleanup_errors=True)
        self._finder = FoldFinder(Path(self._folder.name) / "station")

    def touching(self, files: dict[str, str], file: str, first: int, last: int) -> list[Fold]:
        """Those of which a place is in these lines of a file; none where the station cannot be used."""
        with suppress(ModelError):
            return self._finder.folds(files, _FOLDS_WITHIN, lambda each: each.touches(file, first, last)).folds
        return []


class CodeActions:
    """Answers of a server about what can be done to what is written."""

    def __init__(self, server: StationLanguageServer) -> None:
        self._server = server
        self._folds: WeakKeyDictionary[EditedStation, _StationFolds] = WeakKeyDictionary()

    async def code_actions(self, params: types.CodeActionParams) -> list[types.CodeAction]:
        """What mends the findings in a range, the usual form of a condition or an action, and shorter ways to say it.

        To prove the last takes a moment: who asks for actions is told of them, and not a lamp beside the line.
        """
        file = self._server.stations.file(params.text_document.uri, of_model=False)
        if file is None:
            return []
        text, wanted = self._server.text_of_file(file), params.context.only
        actions: list[types.CodeAction] = []
        if _is_wanted(types.CodeActionKind.QuickFix, wanted):
            actions += self._fixes(file, text, params.range)
        if _is_wanted(types.CodeActionKind.RefactorRewrite, wanted):
            snapshot, index = await file.station.snapshot(), text.index(params.range.start)
            actions += await self._server.threads.found_at_once(
                lambda: list(self._rewritten(file, snapshot, text, index))
            )
            if params.context.trigger_kind is not types.CodeActionTriggerKind.Automatic:
                actions += await self._shortened(file, params.range)
        return actions

    def _fixes(self, file: StationFile, text: DocumentText, where: types.Range) -> Iterator[types.CodeAction]:
        if file.station.checked_files.get(file.name) != file.station.files.get(file.name):
            return  # what was found is not where it was
        for finding in file.station.findings:
            if finding.file != file.name or not _touch(range_of(finding, text), where):
                continue
            yield from self._mended(file, text, finding)

    def _mended(self, file: StationFile, text: DocumentText, finding: FindingDocument) -> Iterator[types.CodeAction]:
        about = diagnostics_of([finding], text)
        for each in finding.fixes:
            edit = types.TextEdit(range_of(finding, text), each.now)
            yield types.CodeAction(
                title=f"Write `{each.now}`",
                kind=types.CodeActionKind.QuickFix,
                diagnostics=about,
                is_preferred=each.is_sure,
                edit=types.WorkspaceEdit(changes={self._server.uri(file.station, file.name): [edit]}),
            )
        if (name := new_name(finding)) is not None:
            path = file.station.folder / finding.file
            moved = types.RenameFile(path.as_uri(), path.with_name(name).as_uri())
            yield types.CodeAction(
                title=f"Call the file {name}",
                kind=types.CodeActionKind.QuickFix,
                diagnostics=about,
                is_preferred=True,
                edit=types.WorkspaceEdit(document_changes=[moved]),
            )

    def _rewritten(
        self, file: StationFile, snapshot: StationSnapshot, text: DocumentText, index: int
    ) -> Iterator[types.CodeAction]:
        """The usual form of what stands there in one line, which means the same."""
        cursor = read_at(text.text, index)
        if cursor is None or "\n" in cursor.text.raw or cursor.text.raw[:1] in "'\"":
            return
        place = text_place(snapshot.lexicon, file.name, cursor.path, cursor.parameters)
        if place is None or (new := place.formatted(str(cursor.text))) == cursor.text:
            return
        edit = types.TextEdit(text.range(*cursor.span_in_file(0, len(cursor.text))), new)
        yield types.CodeAction(
            title=f"Write it as `{new}`",
            kind=types.CodeActionKind.RefactorRewrite,
            edit=types.WorkspaceEdit(changes={self._server.uri(file.station, file.name): [edit]}),
        )

    async def _shortened(self, file: StationFile, where: types.Range) -> list[types.CodeAction]:
        station, files = file.station, dict(file.station.files)
        if (finder := self._folds.get(station)) is None:
            finder = self._folds[station] = _StationFolds()
        first, last = where.start.line + 1, where.end.line + 1
        found = await self._server.threads.found_later(lambda: finder.touching(files, file.name, first, last))
        if files != station.files:  # something was typed meanwhile
            return []
        return [
            types.CodeAction(
                title=fold.title,
                kind=types.CodeActionKind.RefactorRewrite,
                edit=self._edit(station, files, fold),
            )
            for fold in found
            if self._server.can_create_files or fold.files.keys() <= files.keys()
        ]

    def _edit(self, station: EditedStation, files: dict[str, str], fold: Fold) -> types.WorkspaceEdit:
        """The edit that makes a fold; a file that is not there yet is created first."""
        encoding = self._server.stations.encoding
        changes = {
            self._server.uri(station, name): edits_between(DocumentText(files.get(name, ""), encoding), text)
            for name, text in fold.files.items()
        }
        come = [self._server.uri(station, name) for name in fold.files if name not in files]
        if not come:
            return types.WorkspaceEdit(changes=changes)
        documents: list[types.TextDocumentEdit | types.CreateFile | types.RenameFile | types.DeleteFile] = [
            types.CreateFile(uri) for uri in come
        ]
        documents += [
            types.TextDocumentEdit(types.OptionalVersionedTextDocumentIdentifier(uri), list(edits))
            for uri, edits in changes.items()
        ]
        return types.WorkspaceEdit(document_changes=documents)


def _touch(one: types.Range, other: types.Range) -> bool:
    return one.start <= other.end and other.start <= one.end


def _is_wanted(kind: types.CodeActionKind, only: Sequence[types.CodeActionKind | str] | None) -> bool:
    """Return whether actions of a kind are asked for; a kind stands for all below it."""
    return only is None or any(
        kind.value == str(getattr(each, "value", each)) or kind.value.startswith(f"{getattr(each, 'value', each)}.")
        for each in only
    )
