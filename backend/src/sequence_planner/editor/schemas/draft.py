"""View schemas of the draft: files, changes, usages and revisions, and the reader of its files."""

from __future__ import annotations

import json
from collections import OrderedDict
from collections.abc import Iterable
from enum import StrEnum

from pydantic import JsonValue

from sequence_planner.analysis.report import FindingDocument, error_document
from sequence_planner.controller.views.part import View
from sequence_planner.editor.draft import ChangeKind, Draft, DraftChange, Edit, digest
from sequence_planner.editor.revision import Revision
from sequence_planner.editor.schemas.check import CheckView
from sequence_planner.mimic.views import MimicView
from sequence_planner.model.files import is_binary
from sequence_planner.model.source import ModelError
from sequence_planner.model.yaml.editor import plain
from sequence_planner.model.yaml.reader import read_text

# What is shown of the draft.


class FileState(StrEnum):
    """Difference of a draft's file from that of the station."""

    SAME = "same"
    CHANGED = "changed"
    NEW = "new"
    REMOVED = "removed"


class FileMark(View):
    """A file of the draft; `digest` is another one as soon as its text is, and null where it was taken away."""

    digest: str | None
    state: FileState


class FileView(View):
    """A file of the draft: its text, and what it holds where that can be read; else `wrong` says why not.

    `content` is null for what is no YAML.
    """

    path: str
    digest: str
    text: str
    content: JsonValue
    wrong: FindingDocument | None


class ChangeView(View):
    """A change of the draft; `of` is the number of the one that it undoes or does again. Time is in seconds since the
    epoch.
    """

    number: int
    time: float
    by: str
    kind: ChangeKind
    of: int | None
    title: str


class DraftView(View):
    """The draft after its change `number`: its files by path, and its last changes, newest first.

    `undo` and `redo` are the titles of what whoever asks could take back, or do again.
    """

    number: int
    files: dict[str, FileMark]
    changes: list[ChangeView]
    undo: str | None
    redo: str | None


class FilesView(View):
    """Files of the draft after its change `number`, by path; null is one that is not there."""

    number: int
    files: dict[str, FileView | None]


class UsageView(View):
    """A place at which a part is named, `length` characters from line and column on, which count from 1; `used_by` says
    by what. `declares` it says of the place where the part itself is written.
    """

    part: str
    file: str
    path: list[str | int]
    line: int
    column: int
    length: int
    written: str
    used_by: str
    declares: bool


class UsagesView(View):
    """Places where a part is named, and those of them outside of it that could not be without it.

    `unwritten` are entries that use it though nothing in them names it, such as a topic whose message has a field of
    that name; they stand at their own names. `unread` are texts that make no sense and hold the name, and files that
    cannot be read; `bound` says why the name is not the model's alone.
    """

    usages: list[UsageView]
    unwritten: list[UsageView]
    dependants: list[UsageView]
    unread: list[FindingDocument]
    bound: str | None


class DraftPictureView(View):
    """The picture of the draft after change `number`, as Operate would show it, and the titles of its resources.

    `digest` is that of the `mimic.yaml` it was made with, null where there is none; then `file` is the text of one that
    draws the same. Of a draft that is not `usable` there is no picture.
    """

    number: int
    usable: bool
    digest: str | None
    picture: MimicView | None
    titles: dict[str, str]
    file: str | None


class RevisionView(View):
    """A saved revision of the model; `running` and `draft` say that the station runs it, and that the draft is it.

    Time is in seconds since the epoch.
    """

    id: str
    name: str
    message: str
    by: str
    time: float
    running: bool
    draft: bool


class RevisionsView(View):
    """All revisions, newest first; `saved` says whether the draft is one of them, `running` whether the station is."""

    revisions: list[RevisionView]
    saved: bool
    running: bool


class WorkshopView(View):
    """The draft as everybody sees it: its files, and what the check has found so far."""

    number: int
    files: dict[str, FileMark]
    last: ChangeView | None
    check: CheckView


# The draft as it is shown.

# What could be said shorter in the draft.


class FoldKind(StrEnum):
    """What a fold is for."""

    QUANTIFIER = "quantifier"
    SET = "set"
    PREDICATE = "predicate"
    RELATION = "relation"
    INCLUDES = "includes"
    MAP = "map"
    ROWS = "rows"
    TYPE = "type"


class FoldPlaceView(View):
    """A place where something is written longer than it need be: what is there, and what would be there."""

    file: str
    line: int
    column: int
    was: str
    now: str


class FoldView(View):
    """A way to write something shorter that was proven to mean the same. `name` is proposed for what it adds.

    `edits` make it, carried out together.
    """

    id: str
    kind: FoldKind
    title: str
    name: str | None
    places: tuple[FoldPlaceView, ...]
    saved_lines: int
    saved_characters: int
    edits: tuple[Edit, ...]


class FoldsView(View):
    """The folds of the draft after change `number`, those first that save most.

    Of one that is not `usable` there are none; where it is not `whole`, time was up before all had been looked at.
    """

    number: int
    usable: bool
    whole: bool
    folds: tuple[FoldView, ...]


MOST_READ, MOST_CHARACTERS = 5000, 50_000_000  # files whose content is remembered, and what they may take together


def marks(draft: Draft) -> dict[str, FileMark]:
    """Tell how each file of the draft stands, also those that were taken away."""
    return {path: _mark(draft, path) for path in sorted(draft.files.keys() | draft.base.keys())}


def _mark(draft: Draft, path: str) -> FileMark:
    text, base = draft.files.get(path), draft.base.get(path)
    if text is None:
        return FileMark(digest=None, state=FileState.REMOVED)
    state = FileState.NEW if base is None else FileState.SAME if base == text else FileState.CHANGED
    return FileMark(digest=digest(text), state=state)


def change_view(change: DraftChange) -> ChangeView:
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


class FileReader:
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
            shown = "" if is_binary(path) else text  # nobody reads those as a text
            view = FileView(path=path, digest=key[1], text=shown, content=content, wrong=wrong)
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
