"""Help while a document is written: completion, explanations, what mends a finding, and what the supervisor adds."""

from __future__ import annotations

from lsprotocol import types

from sequence_planner.editor.language.completion import MOST_OPTIONS
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.language_server.answers.completing import Proposal, proposals
from sequence_planner.language_server.answers.hints import guard_hints
from sequence_planner.language_server.answers.hovering import explanation
from sequence_planner.language_server.documents.schemas import DocumentSchemas
from sequence_planner.language_server.documents.texts import DocumentText
from sequence_planner.language_server.server import StationLanguageServer

_COMPLETION_KINDS = {
    None: types.CompletionItemKind.Property,
    NameKind.MEASURED: types.CompletionItemKind.Variable,
    NameKind.OUTPUT: types.CompletionItemKind.Variable,
    NameKind.ESTIMATED: types.CompletionItemKind.Variable,
    NameKind.FLAG: types.CompletionItemKind.Event,
    NameKind.ACTIVITY: types.CompletionItemKind.Event,
    NameKind.PARAMETER: types.CompletionItemKind.TypeParameter,
    NameKind.VALUE: types.CompletionItemKind.EnumMember,
    NameKind.KEYWORD: types.CompletionItemKind.Keyword,
    NameKind.RESOURCE: types.CompletionItemKind.Module,
    NameKind.ABILITY: types.CompletionItemKind.Function,
    NameKind.OPERATION: types.CompletionItemKind.Function,
    NameKind.ENUMERATION: types.CompletionItemKind.Enum,
    NameKind.SET: types.CompletionItemKind.Enum,
    NameKind.PREDICATE: types.CompletionItemKind.Function,
    NameKind.RELATION: types.CompletionItemKind.Function,
    NameKind.MAP: types.CompletionItemKind.Function,
}


class Assistance:
    """Answers of a server about what is being written."""

    def __init__(self, server: StationLanguageServer) -> None:
        self._server = server
        self._at_once = server.threads.found_at_once
        self._schemas = DocumentSchemas()

    async def completion(self, params: types.CompletionParams) -> types.CompletionList | None:
        """What can be written at a position."""
        file = self._server.stations.file(params.text_document.uri)
        if file is None:
            return None
        text = self._server.text_of_file(file)
        snapshot, index = await file.station.snapshot(), text.index(params.position)
        found = await self._at_once(lambda: proposals(snapshot, self._schemas, file.name, text.text, index))
        items = [_item(text, number, each) for number, each in enumerate(found)]
        return types.CompletionList(is_incomplete=len(items) >= MOST_OPTIONS, items=items)

    async def hover(self, params: types.HoverParams) -> types.Hover | None:
        """What the name at a position is."""
        file = self._server.stations.file(params.text_document.uri)
        if file is None:
            return None
        text = self._server.text_of_file(file)
        snapshot, index = await file.station.snapshot(), text.index(params.position)
        found = await self._at_once(lambda: explanation(snapshot, self._schemas, file.name, text.text, index))
        if found is None:
            return None
        told = types.MarkupContent(types.MarkupKind.Markdown, found.text)
        return types.Hover(told, text.range(found.start, found.end))

    async def inlay_hints(self, params: types.InlayHintParams) -> list[types.InlayHint] | None:
        """What the supervisor adds to the abilities in a range, as far as that is known."""
        file = self._server.stations.file(params.text_document.uri)
        if file is None or not self._server.shows_guards or file.station.analysis is None:
            return None
        text, analysis = self._server.text_of_file(file), file.station.analysis
        content = (await file.station.snapshot()).content
        found = await self._at_once(lambda: list(guard_hints(content, text.text, file.name, analysis)))
        first, last = params.range.start.line, params.range.end.line
        return [
            types.InlayHint(
                position=text.position(text.index_of(hint.line, len(text.row(hint.line - 1)) + 1)),
                label=hint.label,
                tooltip=types.MarkupContent(types.MarkupKind.Markdown, hint.about),
                padding_left=True,
            )
            for hint in found
            if first <= hint.line - 1 <= last
        ]


def _item(text: DocumentText, number: int, proposal: Proposal) -> types.CompletionItem:
    return types.CompletionItem(
        label=proposal.label,
        kind=_COMPLETION_KINDS[proposal.kind],
        detail=proposal.detail or None,
        documentation=types.MarkupContent(types.MarkupKind.Markdown, proposal.about) if proposal.about else None,
        sort_text=f"{number:04}",
        filter_text=proposal.insert.rstrip(": "),
        text_edit=types.TextEdit(text.range(proposal.start, proposal.end), proposal.insert),
    )
