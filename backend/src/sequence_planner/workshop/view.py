"""What is shown of the draft."""

from __future__ import annotations

from enum import StrEnum

from pydantic import JsonValue

from sequence_planner.analysis.document import FindingDocument
from sequence_planner.control.view_part import View
from sequence_planner.workshop.check_view import CheckView
from sequence_planner.workshop.draft import ChangeKind


class FileState(StrEnum):
    """How a file of the draft differs from that of the station."""

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
    """Where a part is named, and which of these places outside of it could not be without it.

    `unwritten` are entries that use it though nothing in them names it, such as a topic whose message has a field of
    that name; they stand at their own names. `unread` are texts that make no sense and hold the name, and files that
    cannot be read; `bound` says why the name is not the model's alone.
    """

    usages: list[UsageView]
    unwritten: list[UsageView]
    dependants: list[UsageView]
    unread: list[FindingDocument]
    bound: str | None


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
    """What all who look at the draft are shown: its files, and what the check of it has found so far."""

    number: int
    files: dict[str, FileMark]
    last: ChangeView | None
    check: CheckView
