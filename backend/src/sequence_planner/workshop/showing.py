"""The draft as it is shown."""

from __future__ import annotations

import json
from collections import OrderedDict
from collections.abc import Iterable

from pydantic import JsonValue

from sequence_planner.analysis.document import FindingDocument, error_document
from sequence_planner.model.editing import plain
from sequence_planner.model.reading import read_text
from sequence_planner.model.source import ModelError
from sequence_planner.workshop.draft import Change, Draft, digest
from sequence_planner.workshop.revision import Revision
from sequence_planner.workshop.view import ChangeView, FileMark, FileState, FileView, RevisionsView, RevisionView

MOST_READ, MOST_CHARACTERS = 5000, 50_000_000  # files whose content is remembered, and what they may take together


def marks(draft: Draft) -> dict[str, FileMark]:
    """How each file of the draft stands, also those that were taken away."""
    return {path: _mark(draft, path) for path in sorted(draft.files.keys() | draft.base.keys())}


def _mark(draft: Draft, path: str) -> FileMark:
    text, base = draft.files.get(path), draft.base.get(path)
    if text is None:
        return FileMark(digest=None, state=FileState.REMOVED)
    state = FileState.NEW if base is None else FileState.SAME if base == text else FileState.CHANGED
    return FileMark(digest=digest(text), state=state)


def change_view(change: Change) -> ChangeView:
    """A change, as people read it."""
    return ChangeView(
        number=change.number,
        time=change.time,
        by=change.by_name,
        kind=change.kind,
        of=change.of,
        title=change.title,
    )


def revisions_view(revisions: Iterable[Revision], running: str, edited: str) -> RevisionsView:
    """Revisions, as people read them; the other two are the trees of what runs, and of the draft."""
    views = [
        RevisionView(
            id=each.id,
            name=each.name,
            message=each.message,
            by=each.by,
            time=each.time,
            running=each.tree == running,
            draft=each.tree == edited,
        )
        for each in revisions
    ]
    return RevisionsView(
        revisions=views, saved=any(each.draft for each in views), running=any(each.running for each in views)
    )


class Reader:
    """Reads files, each text once, and tells what they hold as JSON."""

    def __init__(self) -> None:
        self._read: OrderedDict[tuple[str, str], str] = OrderedDict()
        self._characters = 0

    def shown(self, draft: Draft, paths: Iterable[str]) -> str:
        """JSON of a `FilesView` of these files, those that are not there as null."""
        views = {path: self._view(path, draft.files[path]) if path in draft.files else "null" for path in paths}
        files = ",".join(f"{json.dumps(path)}:{view}" for path, view in views.items())
        return f'{{"number":{draft.number},"files":{{{files}}}}}'

    def _view(self, path: str, text: str) -> str:
        key = path, digest(text)
        known = self._read.get(key)
        if known is None:
            content, wrong = _content(path, text)
            view = FileView(path=path, digest=key[1], text=text, content=content, wrong=wrong)
            known = self._read[key] = view.model_dump_json()
            self._characters += len(known)
        self._read.move_to_end(key)
        while len(self._read) > MOST_READ or self._characters > MOST_CHARACTERS:
            self._characters -= len(self._read.popitem(last=False)[1])
        return known


def _content(path: str, text: str) -> tuple[JsonValue, FindingDocument | None]:
    if not path.endswith(".yaml"):
        return None, None
    try:
        return plain(read_text(text, path).content), None
    except ModelError as error:
        return None, error_document(error.findings[0])
