"""The shared draft of a station's model: edits, undo and redo, revisions and their database tables."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue
from sqlalchemy import (
    BigInteger,
    Column,
    Connection,
    Double,
    Integer,
    Row,
    Select,
    String,
    Table,
    delete,
    func,
    insert,
    select,
    update,
)
from sqlalchemy import (
    Text as TextColumn,
)

from sequence_planner.core.actor import SYSTEM, Actor
from sequence_planner.core.data_models import DataModel
from sequence_planner.db.metadata import METADATA
from sequence_planner.editor.merging import MergeConflictError, merged
from sequence_planner.model.files import Files, check_path, check_size, check_text
from sequence_planner.model.paths import EditError, shown_path
from sequence_planner.model.yaml import editor
from sequence_planner.model.yaml.content import same
from sequence_planner.model.yaml.order import declared_order
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.texts.message import message

# What an engineer does to a draft, and what becomes of its files.
#
# Each edit says what it was made from. Where that part of the draft is another one by now the edit is refused, and
# nothing of it is done; what somebody else did elsewhere does not matter.

MOST_EDITS = 500  # of one change
Step = Annotated[str, Field(max_length=500)] | Annotated[int, Field(ge=0, le=100_000, strict=True)]
Steps = Annotated[list[Step], Field(max_length=50)]
FilePath = Annotated[str, Field(min_length=1, max_length=300)]
Text = Annotated[str, Field(max_length=1_000_000)]


class PartChangedError(EditError):
    """A mismatch of what is to be edited and what the edit was made from; `path` is empty for a file as a whole."""

    def __init__(self, file: str, path: EntryPath, why: str) -> None:
        super().__init__(why)
        self.file = file
        self.path = path

    def __reduce__(self) -> tuple[type[PartChangedError], tuple[str, EntryPath, str]]:
        """Say how it comes from the process in which the edit was made."""
        return PartChangedError, (self.file, self.path, self.why)


class EditBase(DataModel):
    """Base of all edits; `file` is a path below the model's folder, `path` that of an entry in it."""

    file: FilePath


class SetEntry(EditBase):
    """Give an entry another value; `was` is the one it had."""

    kind: Literal["set"] = "set"
    path: Annotated[Steps, Field(min_length=1)]
    was: JsonValue
    value: JsonValue


class AddEntry(EditBase):
    """Add an entry beside a sibling, or else where documents have it: before what belongs behind it, or at the end.
    Mappings on the way that are not there yet are made. `text` is the YAML of its value with comments: in a block of
    others it is written so, where it says the same.
    """

    kind: Literal["add"] = "add"
    path: Annotated[Steps, Field(min_length=1)]
    value: JsonValue
    text: Text | None = None
    before: Step | None = None
    after: Step | None = None


class RemoveEntry(EditBase):
    """Take an entry out; `was` is its value."""

    kind: Literal["remove"] = "remove"
    path: Annotated[Steps, Field(min_length=1)]
    was: JsonValue


class MoveEntry(EditBase):
    """Put an entry elsewhere among its siblings: to the end, or beside one of them; `was` is its value."""

    kind: Literal["move"] = "move"
    path: Annotated[Steps, Field(min_length=1)]
    was: JsonValue
    before: Step | None = None
    after: Step | None = None


class WriteText(EditBase):
    """Give a file the text that `was` has become; null is no file. What others did to other lines stays."""

    kind: Literal["text"] = "text"
    was: Text | None
    text: Text | None


Edit = Annotated[SetEntry | AddEntry | RemoveEntry | MoveEntry | WriteText, Field(discriminator="kind")]


class ChangeBody(BaseModel):
    """Edits that are carried out together, or not at all; `title` says what they do, for the list of changes."""

    model_config = ConfigDict(extra="forbid")
    title: Annotated[str, Field(min_length=1, max_length=300)]
    edits: Annotated[list[Edit], Field(min_length=1, max_length=MOST_EDITS)]


def applied(files: Files, edits: Sequence[Edit]) -> dict[str, str]:
    """The files after the edits, one after the other. Raises `EditError`, of which `PartChangedError` is one."""
    after = dict(files)
    for edit in edits:
        check_path(edit.file)
        text = _written(after, edit) if isinstance(edit, WriteText) else _edited(after, edit)
        if text is None:
            after.pop(edit.file, None)
        else:
            check_text(edit.file, text)
            after[edit.file] = text
    check_size(after)
    return after


def _written(files: Files, edit: WriteText) -> str | None:
    now = files.get(edit.file)
    if now == edit.was:
        return edit.text
    try:
        return merged(edit.was, edit.text, now)
    except MergeConflictError as error:
        why = message("edit.file-changed", file=edit.file, how=error.how)
        raise PartChangedError(edit.file, (), why) from None


def _edited(files: Files, edit: SetEntry | AddEntry | RemoveEntry | MoveEntry) -> str:
    text, path = files.get(edit.file), tuple(edit.path)
    if text is None:
        if not isinstance(edit, AddEntry):
            raise PartChangedError(edit.file, path, message("edit.file-gone", file=edit.file))
        text = ""
    if not isinstance(edit, AddEntry):
        _require_unchanged(text, edit, path)
    match edit:
        case SetEntry():
            return editor.replace(text, path, edit.value)
        case AddEntry():
            return _added(text, edit, path)
        case RemoveEntry():
            return editor.remove(text, path)
        case MoveEntry():
            return editor.move(text, path, before=edit.before, after=edit.after)


def _added(text: str, edit: AddEntry, path: EntryPath) -> str:
    """With the mappings on the way to it, where there is nothing yet."""
    if not text.strip():
        return _first(text, path, edit.value)
    content, depth = editor.value_at(text, ()), 0
    while depth < len(path) - 1 and isinstance(content, dict) and content.get(str(path[depth])) is not None:
        content, depth = content[str(path[depth])], depth + 1
    if isinstance(content, list) and isinstance(path[depth], str):
        raise EditError(f"`{shown_path(path[:depth])}` is a list: its entries have no names")
    if depth == len(path) - 1 or isinstance(content, list):
        before = edit.before
        if before is None and edit.after is None:
            before = _next(edit.file, path, content)
        return editor.insert(text, path, edit.value, before=before, after=edit.after, written=edit.text)
    value: JsonValue = edit.value
    for step in reversed(path[depth + 1 :]):
        value = [value] if isinstance(step, int) else {step: value}
    here = path[: depth + 1]
    if isinstance(content, dict) and path[depth] in content:  # a name with nothing behind it
        return editor.replace(text, here, value)
    return editor.insert(text, here, value, before=_next(edit.file, here, content))


def _next(file: str, path: EntryPath, siblings: object) -> str | None:
    """The first sibling that belongs behind the entry at `path`; None where it is the last, or has no such place."""
    order = declared_order(file, path[:-1])
    if not isinstance(siblings, dict) or path[-1] not in order:
        return None
    later = order[order.index(str(path[-1])) + 1 :]
    return next((str(key) for key in siblings if key in later), None)


def _first(text: str, path: EntryPath, value: JsonValue) -> str:
    """The first entry of a file that has none."""
    name = str(path[0])
    for step in reversed(path[1:]):
        value = [value] if isinstance(step, int) else {step: value}
    placeholder = f"{text}{name}: x\n"
    return editor.replace(placeholder, (name,), value)


def _require_unchanged(text: str, edit: SetEntry | RemoveEntry | MoveEntry, path: EntryPath) -> None:
    editor.value_at(text, ())  # what cannot be read has not been changed by anybody else
    try:
        now = editor.value_at(text, path)
    except EditError:
        why = message("edit.part-gone", part=shown_path(path), file=edit.file)
        raise PartChangedError(edit.file, path, why) from None
    if not same(now, edit.was):
        raise PartChangedError(edit.file, path, message("edit.part-changed", part=shown_path(path), file=edit.file))


# The tables of the draft: the one of the station, and who changed what in it. Times are seconds since the epoch.
#
# What a file was when the draft began stands beside what it is, so that what somebody does to the files of the station
# meanwhile can be brought together with it.

PATH = String(300)

DRAFT_FILES = Table(
    "draft_files",
    METADATA,
    Column("path", PATH, primary_key=True),
    Column("text", TextColumn, nullable=True),  # none: it was taken away
    Column("base", TextColumn, nullable=True),  # none: it is new
)

DRAFT_CHANGES = Table(
    "draft_changes",
    METADATA,
    Column("number", BigInteger().with_variant(Integer, "sqlite"), primary_key=True, autoincrement=False),
    Column("time", Double, nullable=False),
    Column("by_id", String(200), nullable=False),
    Column("by_name", String(200), nullable=False),
    Column("kind", String(20), nullable=False),
    Column("of", BigInteger().with_variant(Integer, "sqlite"), nullable=True),  # what is undone, or done again
    Column("title", String(300), nullable=False),
    Column("files", TextColumn, nullable=False),  # JSON: {path: [before, after]}
)


# The draft of a station: its files while engineers edit them, all of them the same one.
#
# Each change is kept with who made it and what the files were before, so that it can be undone; undoing is a change
# too.

MOST_CHANGES = 1000  # that are kept

# Of each file that differs what it was and what it is; none is no file.
Differences = Mapping[str, tuple[str | None, str | None]]


class ChangeKind(StrEnum):
    """Kind of a change."""

    EDIT = "edit"
    UNDO = "undo"
    REDO = "redo"
    TAKEN = "taken"  # what somebody has done to the files of the station


@dataclass(frozen=True)
class DraftChange:
    """A change of the draft, without what it did; `of` is the number of the one that it undoes or does again."""

    number: int
    time: float
    by_id: str
    by_name: str
    kind: ChangeKind
    of: int | None
    title: str


@dataclass(frozen=True)
class Draft:
    """The draft after its change `number`; `base` are the files that it began from."""

    number: int
    files: Files
    base: Files


def digest(text: str) -> str:
    """A short mark of a text, another one as soon as it changes."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def read(connection: Connection) -> Draft:
    """The draft; number 0 and no files before it was begun."""
    number = _number(connection)
    rows = connection.execute(select(DRAFT_FILES).order_by(DRAFT_FILES.c.path)).all()
    return Draft(
        number,
        {row.path: row.text for row in rows if row.text is not None},
        {row.path: row.base for row in rows if row.base is not None},
    )


def taking_up(draft: Draft, files: Files) -> DraftProposal:
    """Return what was edited, brought together with what has happened to the files of the station since. A file of
    which both changed the same lines stays as it is in the draft; the title says so.
    """
    after, conflicts = dict(draft.files), list[str]()
    for path in sorted(draft.base.keys() | files.keys()):
        try:
            text = merged(draft.base.get(path), files.get(path), draft.files.get(path))
        except MergeConflictError:
            conflicts.append(path)
            continue
        if text is None:
            after.pop(path, None)
        else:
            after[path] = text
    title = "The files of the station have changed" if draft.number else "The files of the station"
    if conflicts:
        title += f"; where the draft had changed the same lines, its own are kept: {', '.join(conflicts)}"
    return DraftProposal(_changed(draft.files, after), ChangeKind.TAKEN, None, title, always=bool(conflicts))


def take_up(connection: Connection, draft: Draft, files: Files, proposal: DraftProposal, now: float) -> Draft | None:
    """Let the draft be one of the station that consists of `files`, with which `proposal` brings it together: what it
    is compared with from now on. None where it is another one by now than the `draft` this was made from.
    """
    if read(connection) != draft:
        return None
    _write(connection, draft, proposal, SYSTEM, now)
    rebase(connection, files)
    return read(connection)


def rebase(connection: Connection, files: Files) -> None:
    """From now on the draft counts as begun from `files`."""
    draft = read(connection)
    for path in draft.files.keys() | draft.base.keys() | files.keys():
        _put(connection, path, draft.files.get(path), files.get(path))


@dataclass(frozen=True)
class DraftProposal:
    """A proposal for the files of a draft, for those that are others then (none is no file), and what it is.

    Without any it is a change only if it is to be one `always`.
    """

    changed: Mapping[str, str | None]
    kind: ChangeKind
    of: int | None
    title: str
    always: bool = False


def editing(draft: Draft, edits: Sequence[Edit], title: str) -> DraftProposal:
    """Carry edits out, all of them or none. Raises `EditError`."""
    return DraftProposal(_changed(draft.files, applied(draft.files, edits)), ChangeKind.EDIT, None, title)


def replacing(draft: Draft, files: Files, title: str) -> DraftProposal:
    """Let these be all files of the draft. Raises `EditError`."""
    for path, text in files.items():
        check_path(path)
        check_text(path, text)
    check_size(files)
    return DraftProposal(_changed(draft.files, files), ChangeKind.EDIT, None, title)


def undoing(draft: Draft, of: DraftChange, differences: Differences) -> DraftProposal:
    """Take a change back, wherever others have not changed the same lines since. Raises `EditError`."""
    edits = [WriteText(file=path, was=after, text=before) for path, (before, after) in differences.items()]
    return DraftProposal(_changed(draft.files, applied(draft.files, edits)), ChangeKind.UNDO, of.number, of.title)


def redoing(draft: Draft, of: DraftChange, differences: Differences) -> DraftProposal:
    """Do again what was taken back. Raises `EditError`."""
    edits = [WriteText(file=path, was=before, text=after) for path, (before, after) in differences.items()]
    return DraftProposal(_changed(draft.files, applied(draft.files, edits)), ChangeKind.REDO, of.number, of.title)


def write(connection: Connection, draft: Draft, proposal: DraftProposal, by: Actor, now: float) -> Draft | None:
    """Let the draft be what is proposed; None where it is another one by now than the `draft` this was made from."""
    if _number(connection) != draft.number:
        return None
    return _write(connection, draft, proposal, by, now)


def differences_of(connection: Connection, change: DraftChange) -> Differences:
    """Return what a change did."""
    written = connection.execute(select(DRAFT_CHANGES.c.files).where(DRAFT_CHANGES.c.number == change.number))
    found: dict[str, list[str | None]] = json.loads(written.scalar_one())
    return {path: (before, after) for path, (before, after) in found.items()}


def accounts(connection: Connection, limit: int) -> list[tuple[DraftChange, Differences]]:
    """The last changes, each with what it did, newest first."""
    return [(change, differences_of(connection, change)) for change in changes(connection, limit)]


def changes(connection: Connection, limit: int) -> list[DraftChange]:
    """The last changes, newest first."""
    rows = connection.execute(_known().order_by(DRAFT_CHANGES.c.number.desc()).limit(limit))
    return [_change(row) for row in rows]


def stacks(connection: Connection, by: Actor) -> tuple[list[DraftChange], list[DraftChange]]:
    """The changes that somebody can undo, and those that they can do again; the last of each comes first to it."""
    mine = (DRAFT_CHANGES.c.by_id == by.id) & (DRAFT_CHANGES.c.kind != ChangeKind.TAKEN.value)
    done: list[DraftChange] = []
    undone: list[DraftChange] = []
    known: dict[int, DraftChange] = {}
    for row in connection.execute(_known().where(mine).order_by(DRAFT_CHANGES.c.number)):
        each = _change(row)
        known[each.number] = each
        match each.kind:
            case ChangeKind.UNDO if done and done[-1].number == each.of:
                undone.append(done.pop())
            case ChangeKind.REDO if undone and undone[-1].number == each.of:
                done.append(undone.pop())
            case ChangeKind.EDIT:
                done.append(each)
                undone.clear()
            case _:  # what it was about is not kept any more
                continue
    return done, undone


def _changed(before: Files, after: Files) -> dict[str, str | None]:
    paths = sorted(before.keys() | after.keys())
    return {path: after.get(path) for path in paths if before.get(path) != after.get(path)}


def _write(connection: Connection, draft: Draft, proposal: DraftProposal, by: Actor, now: float) -> Draft:
    changed = {path: text for path, text in proposal.changed.items() if draft.files.get(path) != text}
    differences = {path: (draft.files.get(path), text) for path, text in changed.items()}
    after = {path: text for path, text in {**draft.files, **changed}.items() if text is not None}
    if not differences and draft.number and not proposal.always:
        return draft
    number = draft.number + 1
    connection.execute(
        insert(DRAFT_CHANGES).values(
            number=number,
            time=now,
            by_id=by.id,
            by_name=by.name,
            kind=proposal.kind.value,
            of=proposal.of,
            title=proposal.title[:300],
            files=json.dumps(differences),
        )
    )
    connection.execute(delete(DRAFT_CHANGES).where(DRAFT_CHANGES.c.number <= number - MOST_CHANGES))
    for path, (_, text) in differences.items():
        _put(connection, path, text, draft.base.get(path))
    return Draft(number, after, draft.base)


def _number(connection: Connection) -> int:
    return connection.execute(select(func.max(DRAFT_CHANGES.c.number))).scalar() or 0


def _put(connection: Connection, path: str, text: str | None, base: str | None) -> None:
    here = DRAFT_FILES.c.path == path
    if text is None and base is None:
        connection.execute(delete(DRAFT_FILES).where(here))
    elif connection.execute(update(DRAFT_FILES).where(here).values(text=text, base=base)).rowcount == 0:
        connection.execute(insert(DRAFT_FILES).values(path=path, text=text, base=base))


def last_of(connection: Connection, path: str) -> DraftChange | None:
    """The last change of a file."""
    mark = json.dumps(path) + ": ["
    found = _known().where(DRAFT_CHANGES.c.files.contains(mark, autoescape=True))
    row = connection.execute(found.order_by(DRAFT_CHANGES.c.number.desc()).limit(1)).first()
    return None if row is None else _change(row)


def _known() -> Select[tuple[object, ...]]:
    """Changes, without what they did."""
    return select(*(column for column in DRAFT_CHANGES.columns if column.name != "files"))


def _change(row: Row[tuple[object, ...]]) -> DraftChange:
    return DraftChange(row.number, row.time, row.by_id, row.by_name, ChangeKind(row.kind), row.of, row.title)
