"""The server that an editor talks to: what it is asked about documents of stations, and what it tells by itself."""

from __future__ import annotations

import asyncio
from collections import defaultdict
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol, default_converter
from pygls.protocol.language_server import lsp_method

from sequence_planner.core.late_log import LateLog
from sequence_planner.language_server.documents.texts import DocumentText
from sequence_planner.language_server.threads import ServerThreads
from sequence_planner.language_server.workspace import OpenWorkspace, StationFile, path_of
from sequence_planner.version import VERSION

if TYPE_CHECKING:
    from sequence_planner.language_server.station import EditedStation

LOG = LateLog(__name__)
NAME = "sequence-planner"
DEADLINE = 60.0  # seconds that a check of a whole station may take
_WATCHED = ("**/*.yaml", "**/*.yml", "**/messages/**/*.{msg,srv,action}", "**/stages/**")
_REFUSED = -32803  # RequestFailed: nothing is wrong with the request


class _Protocol(LanguageServerProtocol):
    """Documents are kept by the workspace of stations alone."""

    @lsp_method(types.TEXT_DOCUMENT_DID_OPEN)
    def lsp_text_document__did_open(self, params: types.DidOpenTextDocumentParams) -> None:
        """A document is open."""
        document = params.text_document
        self._stations.opened(document.uri, document.version, document.text)

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> None:
        """Something was typed."""
        document = self._stations.documents.get(params.text_document.uri)
        if document is not None:
            document.change(list(params.content_changes), params.text_document.version)
            self._stations.typed(params.text_document.uri)

    @lsp_method(types.TEXT_DOCUMENT_DID_CLOSE)
    async def lsp_text_document__did_close(self, params: types.DidCloseTextDocumentParams) -> None:
        """A document is open no more."""
        ended = await self._stations.closed(params.text_document.uri)
        if ended is not None:
            self._language_server.leave(ended)

    @property
    def _language_server(self) -> StationLanguageServer:
        server = self._server
        assert isinstance(server, StationLanguageServer)
        return server

    @property
    def _stations(self) -> OpenWorkspace:
        return self._language_server.stations


class StationLanguageServer(LanguageServer):
    """Tells an editor about stations; `answers` registers what it can be asked.

    What takes a moment is done in a thread beside that in which stations are read, so that nobody who types waits for
    a check. What was asked and is no longer wanted is not begun.
    """

    def __init__(self) -> None:
        self.threads = ServerThreads()
        self.stations = OpenWorkspace(self, self.threads, DEADLINE)  # which the protocol looks at when it is made
        super().__init__(NAME, VERSION, protocol_cls=_Protocol, converter_factory=default_converter)
        self.shows_guards = True
        self.offer(types.INITIALIZE, self.initialized)
        self.offer(types.WORKSPACE_DID_CHANGE_CONFIGURATION, lambda params: self.take_settings(params.settings))
        self.offer(types.WORKSPACE_DID_CHANGE_WATCHED_FILES, self.files_changed)
        self.offer(types.TEXT_DOCUMENT_DID_SAVE, self.saved)
        self._published: dict[Path, set[str]] = defaultdict(set)
        self._texts: dict[tuple[Path, str], DocumentText] = {}
        self._telling: set[asyncio.Task[None]] = set()

    def offer(self, method: str, handler: Callable[[Any], object], options: object = None) -> None:
        """Have what is asked by a method, or told by it, handled."""

        async def handled(params: Any) -> object:  # noqa: ANN401 (pygls takes any other for the server)
            answer = handler(params)
            return await answer if isinstance(answer, Awaitable) else answer

        self.feature(method, options)(handled)

    def text_of_file(self, file: StationFile) -> DocumentText:
        """The text of a file as it is now; empty where it is gone."""
        text, key = file.station.files.get(file.name, ""), (file.station.folder, file.name)
        known = self._texts.get(key)
        if known is None or known.text != text:
            known = self._texts[key] = DocumentText(text, self.stations.encoding)
        return known

    def uri(self, station: EditedStation, file: str) -> str:
        """The address of a file, as the editor that has it open writes it."""
        path = station.folder / file
        return next((uri for uri in self.stations.documents if path_of(uri) == path), path.as_uri())

    def initialized(self, params: types.InitializeParams) -> None:
        """Take over how the editor counts and what it wants."""
        encoding = self.workspace.position_encoding
        self.stations.encoding = str(encoding.value if isinstance(encoding, types.PositionEncodingKind) else encoding)
        self.take_settings(params.initialization_options)

    def take_settings(self, settings: object) -> None:
        """Take over what is set: `supervisorHints` and `deadline`, alone or below `sequencePlanner`."""
        found = settings.get("sequencePlanner", settings) if isinstance(settings, dict) else None
        if not isinstance(found, dict):
            return
        if isinstance(hints := found.get("supervisorHints"), bool) and hints != self.shows_guards:
            self.shows_guards = hints
            self._refresh_hints()
        deadline = found.get("deadline")
        if isinstance(deadline, int | float) and not isinstance(deadline, bool) and deadline > 0:
            self.stations.deadline = float(deadline)

    def watch_files(self) -> None:
        """Have the editor tell what happens to files."""
        workspace = self.client_capabilities.workspace
        watching = workspace and workspace.did_change_watched_files
        if watching and watching.dynamic_registration:
            watchers = [types.FileSystemWatcher(pattern) for pattern in _WATCHED]
            options = types.DidChangeWatchedFilesRegistrationOptions(watchers)
            registration = types.Registration("files", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)
            self._ask(self.client_register_capability_async(types.RegistrationParams([registration])))

    def files_changed(self, params: types.DidChangeWatchedFilesParams) -> None:
        """Something has happened to files, perhaps outside of the editor."""
        self.stations.look_again([path for each in params.changes if (path := path_of(each.uri)) is not None])

    def saved(self, params: types.DidSaveTextDocumentParams) -> None:
        """A document was saved: perhaps into a new file."""
        if (path := path_of(params.text_document.uri)) is not None:
            self.stations.look_again([path])

    def findings_changed(self, station: EditedStation) -> None:
        """Show what is wrong, in each document of it; a document in which was typed meanwhile is looked at anew."""
        from sequence_planner.language_server.answers.findings import diagnostics_of  # noqa: PLC0415 (see `serving`)

        found = defaultdict(list)
        for finding in station.findings:
            found[finding.file].append(finding)
        now, published = station.files, self._published[station.folder]
        for file in sorted(found.keys() | published):
            if now.get(file) != station.checked_files.get(file):
                continue
            text = DocumentText(now.get(file, ""), self.stations.encoding)
            self._publish(station, file, diagnostics_of(found[file], text))
            (published.add if found[file] else published.discard)(file)

    def guards_changed(self, station: EditedStation) -> None:
        """Have hints asked for again."""
        self._refresh_hints()

    @property
    def can_move_files(self) -> bool:
        """True if the editor renames files where it is told to."""
        return self._can(types.ResourceOperationKind.Rename)

    @property
    def can_create_files(self) -> bool:
        """True if the editor creates files where it is told to."""
        return self._can(types.ResourceOperationKind.Create)

    def _can(self, operation: types.ResourceOperationKind) -> bool:
        workspace = self.client_capabilities.workspace
        edits = workspace and workspace.workspace_edit
        return bool(edits and operation in (edits.resource_operations or ()))

    def leave(self, station: EditedStation) -> None:
        """Nothing of a station is open any more, so that nothing is said of it either."""
        self._texts = {key: text for key, text in self._texts.items() if key[0] != station.folder}
        for file in self._published.pop(station.folder, set()):
            self._publish(station, file, [])

    def refuse(self, why: str) -> JsonRpcException:
        """The error that something cannot be done, which the editor shows."""
        return JsonRpcException(why, _REFUSED)

    def _publish(self, station: EditedStation, file: str, diagnostics: list[types.Diagnostic]) -> None:
        uri = self.uri(station, file)
        document = self.stations.documents.get(uri)
        version = None if document is None else document.version
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, diagnostics, version))

    def _refresh_hints(self) -> None:
        workspace = self.protocol.client_capabilities.workspace
        if workspace and workspace.inlay_hint and workspace.inlay_hint.refresh_support:
            self._ask(self.workspace_inlay_hint_refresh_async(None))

    def _ask(self, question: Any) -> None:  # noqa: ANN401 (as pygls has it)
        async def patient() -> None:
            try:
                await question
            except JsonRpcException as error:
                LOG.warning("the editor has refused", because=str(error))

        task = asyncio.get_running_loop().create_task(patient())
        self._telling.add(task)
        task.add_done_callback(self._telling.discard)
