"""Ways through a station: what names mean and where, what documents declare, and other names for parts."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Protocol

from lsprotocol import types

from sequence_planner.editor.symbols.rename import Usage, renamed
from sequence_planner.language_server.answers.hovering import explanation
from sequence_planner.language_server.answers.naming import (
    Declaration,
    declarations_of,
    declared_in,
    named_in,
    part_at,
    used_places,
)
from sequence_planner.language_server.documents.cursor import entry_end
from sequence_planner.language_server.documents.schemas import DocumentSchemas
from sequence_planner.language_server.documents.texts import DocumentText, edits_between
from sequence_planner.language_server.server import StationLanguageServer
from sequence_planner.language_server.snapshot import StationSnapshot
from sequence_planner.language_server.station import EditedStation
from sequence_planner.language_server.workspace import StationFile
from sequence_planner.model.files import Files
from sequence_planner.model.paths import EditError

_MOST_SYMBOLS = 500
_SYMBOL_KINDS = {
    "enumeration": types.SymbolKind.Enum,
    "value": types.SymbolKind.EnumMember,
    "resource": types.SymbolKind.Module,
    "type": types.SymbolKind.Class,
    "set": types.SymbolKind.Enum,
    "relation": types.SymbolKind.Function,
    "map": types.SymbolKind.Function,
    "predicate": types.SymbolKind.Function,
    "variable": types.SymbolKind.Variable,
    "ability": types.SymbolKind.Function,
    "effect": types.SymbolKind.Event,
    "alarm": types.SymbolKind.Event,
    "operation": types.SymbolKind.Function,
    "sequence": types.SymbolKind.Function,
    "specification": types.SymbolKind.Constant,
    "work_master": types.SymbolKind.Class,
    "parameter": types.SymbolKind.TypeParameter,
    "message": types.SymbolKind.Struct,
}


class _AtPosition(Protocol):
    """What asks about a position of a document."""

    text_document: types.TextDocumentIdentifier
    position: types.Position


class Navigation:
    """Answers of a server about names."""

    def __init__(self, server: StationLanguageServer) -> None:
        self._server = server
        self._at_once = server.threads.found_at_once
        self._schemas = DocumentSchemas()
        self._declared: dict[tuple[Path, str], tuple[str, list[Declaration]]] = {}

    async def definition(self, params: types.DefinitionParams) -> list[types.Location] | None:
        """Where what is named at a position is declared."""

        def places(snapshot: StationSnapshot, file: str, text: DocumentText, index: int) -> list[tuple[str, int, int]]:
            told = explanation(snapshot, self._schemas, file, text.text, index)
            if told is not None and told.declared is not None and told.declared.file:
                return [(told.declared.file, told.declared.line, told.declared.column)]
            usage = _usage_at(snapshot, file, text, index)
            found = () if usage is None else declarations_of(snapshot, usage.part)
            return [(each.file, each.line, each.column) for each in found]

        asked = self._asked(params)
        if asked is None:
            return None
        file, text, index = asked
        snapshot = await file.station.snapshot()
        found = await self._at_once(lambda: places(snapshot, file.name, text, index))
        return [self._location(file.station, *each) for each in found]

    async def references(self, params: types.ReferenceParams) -> list[types.Location] | None:
        """Every place at which what is named at a position is named."""
        asked = self._asked(params)
        if asked is None:
            return None
        file, text, index = asked
        snapshot, files = await file.station.snapshot(), file.station.files

        def places() -> list[Usage]:
            usage = _usage_at(snapshot, file.name, text, index)
            return [] if usage is None else used_places(snapshot, files, usage.part)

        found = await self._at_once(places)
        return [
            self._location(file.station, each.file, each.line, each.column, each.length)
            for each in found
            if params.context.include_declaration or not each.declares
        ]

    async def highlights(self, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight] | None:
        """The places of the document at which the same is named as at a position."""
        asked = self._asked(params)
        if asked is None:
            return None
        file, text, index = asked
        snapshot = await file.station.snapshot()

        def places() -> list[Usage]:
            found = named_in(snapshot, file.name)
            usage = part_at(found, *_line_and_column(text, index))
            return [] if usage is None else [each for each in found if each.part == usage.part]

        found = await self._at_once(places)
        kinds = {True: types.DocumentHighlightKind.Write, False: types.DocumentHighlightKind.Read}
        return [types.DocumentHighlight(_range(text, each), kinds[each.declares]) for each in found]

    async def prepare_rename(self, params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder | None:
        """What would be called otherwise."""
        asked = self._asked(params)
        if asked is None:
            return None
        file, text, index = asked
        snapshot = await file.station.snapshot()
        found = await self._at_once(lambda: _usage_at(snapshot, file.name, text, index))
        if found is None:
            raise self._server.refuse("there is no name of the model here")
        if found.part.kind == "message":
            raise self._server.refuse("a type of message is known to all nodes by this name: it is not changed here")
        return types.PrepareRenamePlaceholder(_range(text, found), found.written)

    async def rename(self, params: types.RenameParams) -> types.WorkspaceEdit | None:
        """Another name for what is named at a position, in all files."""
        asked = self._asked(params)
        if asked is None:
            return None
        file, text, index = asked
        station, files = file.station, file.station.files
        snapshot = await station.snapshot()

        def other() -> dict[str, str | None]:
            usage = _usage_at(snapshot, file.name, text, index)
            if usage is None:
                raise EditError("there is no name of the model here")
            return renamed(files, usage.part, params.new_name, snapshot.messages)

        try:
            new = await self._at_once(other)
        except EditError as error:
            raise self._server.refuse(str(error)) from None
        return self._edit(station, files, new)

    async def document_symbols(self, params: types.DocumentSymbolParams) -> list[types.DocumentSymbol] | None:
        """What a document declares."""
        file = self._server.stations.file(params.text_document.uri)
        if file is None:
            return None
        text, snapshot = self._server.text_of_file(file), await file.station.snapshot()
        found = await self._at_once(lambda: self._declarations(file.station, snapshot, file.name))
        return _nested(text, [each for each in found if each.usage.length])

    async def workspace_symbols(self, params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        """What is declared in stations of which something is open, and has these letters in this order."""
        symbols: list[types.WorkspaceSymbol] = []
        for station in self._server.stations.stations:
            snapshot = await station.snapshot()
            found = await self._at_once(partial(self._all_declarations, station, snapshot))
            for each in found:
                usage, full = each.usage, each.usage.part.full
                if len(symbols) < _MOST_SYMBOLS and _has_in_order(params.query.lower(), full.lower()):
                    where = self._location(station, usage.file, usage.line, usage.column, usage.length)
                    kind = _SYMBOL_KINDS.get(usage.part.kind, types.SymbolKind.Interface)
                    symbols.append(types.WorkspaceSymbol(where, full, kind, container_name=station.folder.name))
        return symbols

    def _asked(self, params: _AtPosition) -> tuple[StationFile, DocumentText, int] | None:
        file = self._server.stations.file(params.text_document.uri)
        if file is None:
            return None
        text = self._server.text_of_file(file)
        return file, text, text.index(params.position)

    def _declarations(self, station: EditedStation, snapshot: StationSnapshot, file: str) -> list[Declaration]:
        known = self._declared.get((station.folder, file))
        if known is None or known[0] != snapshot.content.texts.get(file, ""):
            self._know(station, snapshot, declared_in(snapshot, file), [file])
        return self._declared[station.folder, file][1]

    def _all_declarations(self, station: EditedStation, snapshot: StationSnapshot) -> list[Declaration]:
        if any((station.folder, file) not in self._declared for file in snapshot.content):
            self._know(station, snapshot, declared_in(snapshot), list(snapshot.content))
        return [each for file in snapshot.content for each in self._declarations(station, snapshot, file)]

    def _know(
        self, station: EditedStation, snapshot: StationSnapshot, found: list[Declaration], files: list[str]
    ) -> None:
        """Remember what files declare."""
        own: dict[str, list[Declaration]] = {file: [] for file in files}
        for each in found:
            own.get(each.usage.file, []).append(each)
        for file, declared in own.items():
            self._declared[station.folder, file] = snapshot.content.texts.get(file, ""), declared

    def _location(
        self, station: EditedStation, file: str, line: int, column: int, length: int | None = None
    ) -> types.Location:
        text = self._server.text_of_file(StationFile(station, file))
        start = text.index_of(line, column)
        end = text.word(start)[1] if length is None else start + length
        return types.Location(self._server.uri(station, file), text.range(start, end))

    def _edit(self, station: EditedStation, files: Files, new: dict[str, str | None]) -> types.WorkspaceEdit:
        """The edit that makes these files the new ones; a file that goes is another one's new name."""
        gone = [file for file, text in new.items() if text is None]
        come = [file for file in new if file not in files]
        moved = dict(zip(come, gone, strict=True))
        changes: dict[str, list[types.TextEdit]] = {}
        for file, text in new.items():
            if text is not None:
                old = DocumentText(files[moved.get(file, file)], self._server.stations.encoding)
                changes[self._server.uri(station, moved.get(file, file))] = edits_between(old, text)
        if not moved:
            return types.WorkspaceEdit(changes=changes)
        if not self._server.can_move_files:
            raise self._server.refuse(
                "this editor does not rename files, and the name of a resource is that of its file"
            )
        documents: list[types.TextDocumentEdit | types.CreateFile | types.RenameFile | types.DeleteFile] = [
            types.TextDocumentEdit(types.OptionalVersionedTextDocumentIdentifier(uri), list(edits))
            for uri, edits in changes.items()
            if edits
        ]
        documents += [
            types.RenameFile((station.folder / old).as_uri(), (station.folder / name).as_uri())
            for name, old in moved.items()
        ]
        return types.WorkspaceEdit(document_changes=documents)


def _line_and_column(text: DocumentText, index: int) -> tuple[int, int]:
    line = text.text.count("\n", 0, index) + 1
    return line, index - text.index_of(line, 1) + 1


def _usage_at(snapshot: StationSnapshot, file: str, text: DocumentText, index: int) -> Usage | None:
    return part_at(named_in(snapshot, file), *_line_and_column(text, index))


def _range(text: DocumentText, usage: Usage) -> types.Range:
    start = text.index_of(usage.line, usage.column)
    return text.range(start, start + usage.length)


def _nested(text: DocumentText, found: Iterable[Declaration]) -> list[types.DocumentSymbol]:
    """Symbols within those whose entries they are parts of."""
    roots: list[types.DocumentSymbol] = []
    around: list[tuple[Declaration, list[types.DocumentSymbol]]] = []
    for each in found:
        start = text.index_of(each.usage.line, each.usage.column)
        end = max(start + each.usage.length, entry_end(text.text, start))
        inner: list[types.DocumentSymbol] = []
        symbol = types.DocumentSymbol(
            name=each.usage.part.name,
            detail=each.usage.part.kind.replace("_", " "),
            kind=_SYMBOL_KINDS.get(each.usage.part.kind, types.SymbolKind.Interface),
            range=text.range(start, end),
            selection_range=_range(text, each.usage),
            children=inner,
        )
        while around and around[-1][0].path != each.path[: len(around[-1][0].path)]:
            around.pop()
        (around[-1][1] if around else roots).append(symbol)
        around.append((each, inner))
    return roots


def _has_in_order(letters: str, name: str) -> bool:
    at = iter(name)
    return all(letter in at for letter in letters)
