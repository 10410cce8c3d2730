"""A language server at work, from its first message to its last.

It says at once what it can do. What it needs for that is imported when the editor has heard it.
"""

from __future__ import annotations

import asyncio
import importlib
import logging
from collections.abc import Mapping
from functools import cache, partial

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from sequence_planner.language_server.server import StationLanguageServer
from sequence_planner.language_server.streams import ClientStreams, talk

_LATER = ("station", "answers.assistance", "answers.navigation", "answers.findings", "answers.code_actions")
_ASSISTANCE, _NAVIGATION = "answers.assistance:Assistance", "answers.navigation:Navigation"
_ACTING = "answers.code_actions:CodeActions"
_TRIGGERS = [".", "(", "[", "{", " "]
_ACTIONS = [types.CodeActionKind.QuickFix, types.CodeActionKind.RefactorRewrite]


# What can be asked: by whom of `answers` it is answered, and how it is offered.
_OFFERED: Mapping[str, tuple[str, str, object]] = {
    types.TEXT_DOCUMENT_COMPLETION: (_ASSISTANCE, "completion", types.CompletionOptions(trigger_characters=_TRIGGERS)),
    types.TEXT_DOCUMENT_HOVER: (_ASSISTANCE, "hover", None),
    types.TEXT_DOCUMENT_CODE_ACTION: (_ACTING, "code_actions", types.CodeActionOptions(_ACTIONS)),
    types.TEXT_DOCUMENT_INLAY_HINT: (_ASSISTANCE, "inlay_hints", None),
    types.TEXT_DOCUMENT_DEFINITION: (_NAVIGATION, "definition", None),
    types.TEXT_DOCUMENT_REFERENCES: (_NAVIGATION, "references", None),
    types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT: (_NAVIGATION, "highlights", None),
    types.TEXT_DOCUMENT_PREPARE_RENAME: (_NAVIGATION, "prepare_rename", None),
    types.TEXT_DOCUMENT_RENAME: (_NAVIGATION, "rename", types.RenameOptions(prepare_provider=True)),
    types.TEXT_DOCUMENT_DOCUMENT_SYMBOL: (_NAVIGATION, "document_symbols", None),
    types.WORKSPACE_SYMBOL: (_NAVIGATION, "workspace_symbols", None),
}


def serve_editor() -> int:
    """Talk to an editor over the standard streams until it leaves; returns the exit code."""
    streams = ClientStreams()
    for handler in logging.getLogger().handlers:
        handler.addFilter(_is_news)

    async def talking() -> int:
        server = StationLanguageServer()
        _offer(server)
        try:
            return await talk(server.protocol, streams)
        finally:
            await server.stations.close()
            server.threads.close()

    return asyncio.run(talking())


def _is_news(record: logging.LogRecord) -> bool:
    """Return whether somebody should hear of it: what an editor is refused it is told itself."""
    return record.exc_info is None or not isinstance(record.exc_info[1], JsonRpcException)


def _offer(server: StationLanguageServer) -> None:
    """Have the server answer all that."""

    @cache
    def _answering(place: str) -> object:
        module, _, name = place.partition(":")
        return getattr(importlib.import_module(f"{__package__}.{module}"), name)(server)

    def asked_of(place: str, name: str, params: object) -> object:
        return getattr(_answering(place), name)(params)

    for method, (place, name, options) in _OFFERED.items():
        server.offer(method, partial(asked_of, place, name), options)
    server.offer(types.INITIALIZED, lambda _: _import_all(server))


async def _import_all(server: StationLanguageServer) -> None:
    server.watch_files()

    def imported() -> None:
        for name in _LATER:
            importlib.import_module(f"{__package__}.{name}")

    await server.threads.found_at_once(imported)
