"""The draft of a station: its files while engineers edit them, all of them the same one.

Each change is kept with who made it and what the files were before, so that it can be undone; undoing is a change too.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

from sqlalchemy import Connection, Row, Select, delete, func, insert, select, update

from sequence_planner.actor import SYSTEM, Actor
from sequence_planner.workshop.edits import Edit, WriteText, applied
from sequence_planner.workshop.files import Files
from sequence_planner.workshop.merging import MergeConflictError, merged
from sequence_planner.workshop.tables import DRAFT_CHANGES, DRAFT_FILES

MOST_CHANGES = 1000  # that are kept

# Of each file that differs what it was and what it is; none is no file.
Differences = Mapping[str, tuple[str | None, str | None]]


class ChangeKind(StrEnum):
    """What a change is."""

    EDIT = "edit"
    UNDO = "undo"
    REDO = "redo"
    TAKEN = "taken"  # what somebody has done to the files of the station


@dataclass(frozen=True)
class Change:
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


def taking_up(draft: Draft, files: Files) -> Proposal:
    """What was edited, brought together with what has happened to the files of the station since. A file of which both
    changed the same lines stays as it is in the draft; the title says so.
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
    return Proposal(_changed(draft.files, after), ChangeKind.TAKEN, None, title, always=bool(conflicts))


def take_up(connection: Connection, draft: Draft, files: Files, proposal: Proposal, now: float) -> Draft | None:
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
class Proposal:
    """What shall become of the files of a draft, of those that are others then (none is no file), and what it is.

    Without any it is a change only if it is to be one `always`.
    """

    changed: Mapping[str, str | None]
    kind: ChangeKind
    of: int | None
    title: str
    always: bool = False


def editing(draft: Draft, edits: Sequence[Edit], title: str) -> Proposal:
    """Carry edits out, all of them or none. Raises `EditError`."""
    return Proposal(_changed(draft.files, applied(draft.files, edits)), ChangeKind.EDIT, None, title)


def undoing(draft: Draft, of: Change, differences: Differences) -> Proposal:
    """Take a change back, wherever others have not changed the same lines since. Raises `EditError`."""
    edits = [WriteText(file=path, was=after, text=before) for path, (before, after) in differences.items()]
    return Proposal(_changed(draft.files, applied(draft.files, edits)), ChangeKind.UNDO, of.number, of.title)


def redoing(draft: Draft, of: Change, differences: Differences) -> Proposal:
    """Do again what was taken back. Raises `EditError`."""
    edits = [WriteText(file=path, was=before, text=after) for path, (before, after) in differences.items()]
    return Proposal(_changed(draft.files, applied(draft.files, edits)), ChangeKind.REDO, of.number, of.title)


def write(connection: Connection, draft: Draft, proposal: Proposal, by: Actor, now: float) -> Draft | None:
    """Let the draft be what is proposed; None where it is another one by now than the `draft` this was made from."""
    if _number(connection) != draft.number:
        return None
    return _write(connection, draft, proposal, by, now)


def differences_of(connection: Connection, change: Change) -> Differences:
    """What a change did."""
    written = connection.execute(select(DRAFT_CHANGES.c.files).where(DRAFT_CHANGES.c.number == change.number))
    found: dict[str, list[str | None]] = json.loads(written.scalar_one())
    return {path: (before, after) for path, (before, after) in found.items()}


def changes(connection: Connection, limit: int) -> list[Change]:
    """The last changes, newest first."""
    rows = connection.execute(_known().order_by(DRAFT_CHANGES.c.number.desc()).limit(limit))
    return [_change(row) for row in rows]


def stacks(connection: Connection, by: Actor) -> tuple[list[Change], list[Change]]:
    """The changes that somebody can undo, and those that they can do again; the last of each comes first to it."""
    mine = (DRAFT_CHANGES.c.by_id == by.id) & (DRAFT_CHANGES.c.kind != ChangeKind.TAKEN.value)
    done: list[Change] = []
    undone: list[Change] = []
    known: dict[int, Change] = {}
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


def _write(connection: Connection, draft: Draft, proposal: Proposal, by: Actor, now: float) -> Draft:
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


def last_of(connection: Connection, path: str) -> Change | None:
    """The last change of a file."""
    mark = json.dumps(path) + ": ["
    found = _known().where(DRAFT_CHANGES.c.files.contains(mark, autoescape=True))
    row = connection.execute(found.order_by(DRAFT_CHANGES.c.number.desc()).limit(1)).first()
    return None if row is None else _change(row)


def _known() -> Select[tuple[object, ...]]:
    """Changes, without what they did."""
    return select(*(column for column in DRAFT_CHANGES.columns if column.name != "files"))


def _change(row: Row[tuple[object, ...]]) -> Change:
    return Change(row.number, row.time, row.by_id, row.by_name, ChangeKind(row.kind), row.of, row.title)
