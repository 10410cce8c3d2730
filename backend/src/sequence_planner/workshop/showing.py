"""The draft as it is shown."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable
from threading import Lock

from pydantic import JsonValue

from sequence_planner.analysis.document import FindingDocument, error_document
from sequence_planner.model.editing import plain
from sequence_planner.model.reading import read_text
from sequence_planner.model.source import ModelError
from sequence_planner.workshop.draft import Change, Draft, digest
from sequence_planner.workshop.view import ChangeView, FileMark, FileState, FileView

MOST_READ = 5000  # files whose content is remembered


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


class Reader:
    """Reads files, each text once; used from any thread."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._read: OrderedDict[tuple[str, str], FileView] = OrderedDict()

    def views(self, draft: Draft, paths: Iterable[str]) -> dict[str, FileView | None]:
        """These files, those that are not there as null."""
        return {path: self._view(path, draft.files[path]) if path in draft.files else None for path in paths}

    def _view(self, path: str, text: str) -> FileView:
        key = path, digest(text)
        with self._lock:
            known = self._read.get(key)
        if known is None:
            content, wrong = _content(path, text)
            known = FileView(path=path, digest=key[1], text=text, content=content, wrong=wrong)
        with self._lock:
            self._read[key] = known
            self._read.move_to_end(key)
            if len(self._read) > MOST_READ:
                self._read.popitem(last=False)
        return known


def _content(path: str, text: str) -> tuple[JsonValue, FindingDocument | None]:
    if not path.endswith(".yaml"):
        return None, None
    try:
        return plain(read_text(text, path).content), None
    except ModelError as error:
        return None, error_document(error.findings[0])
