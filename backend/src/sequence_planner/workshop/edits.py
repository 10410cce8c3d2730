"""What an engineer does to a draft, and what becomes of its files.

Each edit says what it was made from. Where that part of the draft is another one by now the edit is refused, and
nothing of it is done; what somebody else did elsewhere does not matter.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue

from sequence_planner.model import editing
from sequence_planner.model.order import declared_order
from sequence_planner.model.paths import EditError, shown_path
from sequence_planner.model.reading import EntryPath
from sequence_planner.workshop.files import Files, check_path, check_size, check_text
from sequence_planner.workshop.merging import MergeConflictError, merged

MOST_EDITS = 500  # of one change
Step = Annotated[str, Field(max_length=500)] | Annotated[int, Field(ge=0, le=100_000, strict=True)]
Steps = Annotated[list[Step], Field(max_length=50)]
FilePath = Annotated[str, Field(min_length=1, max_length=300)]
Text = Annotated[str, Field(max_length=1_000_000)]


class PartChangedError(EditError):
    """What is to be edited is not what the edit was made from; `path` is empty for a file as a whole."""

    def __init__(self, file: str, path: EntryPath, message: str) -> None:
        super().__init__(message)
        self.file = file
        self.path = path

    def __reduce__(self) -> tuple[type[PartChangedError], tuple[str, EntryPath, str]]:
        """How it comes from the process in which the edit was made."""
        return PartChangedError, (self.file, self.path, str(self))


class EditBase(BaseModel):
    """Base of all edits; `file` is a path below the model's folder, `path` that of an entry in it."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    file: FilePath


class SetEntry(EditBase):
    """Give an entry another value; `was` is the one it had."""

    kind: Literal["set"] = "set"
    path: Annotated[Steps, Field(min_length=1)]
    was: JsonValue
    value: JsonValue


class AddEntry(EditBase):
    """Add an entry beside a sibling, or else where documents have it: before what belongs behind it, or at the end.
    Mappings on the way that are not there yet are made.
    """

    kind: Literal["add"] = "add"
    path: Annotated[Steps, Field(min_length=1)]
    value: JsonValue
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
        raise PartChangedError(edit.file, (), f"{edit.file} was changed meanwhile {error}") from None


def _edited(files: Files, edit: SetEntry | AddEntry | RemoveEntry | MoveEntry) -> str:
    text, path = files.get(edit.file), tuple(edit.path)
    if text is None:
        if not isinstance(edit, AddEntry):
            raise PartChangedError(edit.file, path, f"{edit.file} is not there any more")
        text = ""
    if not isinstance(edit, AddEntry):
        _require_unchanged(text, edit, path)
    match edit:
        case SetEntry():
            return editing.replace(text, path, edit.value)
        case AddEntry():
            return _added(text, edit, path)
        case RemoveEntry():
            return editing.remove(text, path)
        case MoveEntry():
            return editing.move(text, path, before=edit.before, after=edit.after)


def _added(text: str, edit: AddEntry, path: EntryPath) -> str:
    """With the mappings on the way to it, where there is nothing yet."""
    if not text.strip():
        return _first(text, path, edit.value)
    content, depth = editing.value_at(text, ()), 0
    while depth < len(path) - 1 and isinstance(content, dict) and content.get(str(path[depth])) is not None:
        content, depth = content[str(path[depth])], depth + 1
    if isinstance(content, list) and isinstance(path[depth], str):
        raise EditError(f"`{shown_path(path[:depth])}` is a list: its entries have no names")
    if depth == len(path) - 1 or isinstance(content, list):
        before = edit.before
        if before is None and edit.after is None:
            before = _next(edit.file, path, content)
        return editing.insert(text, path, edit.value, before=before, after=edit.after)
    value: JsonValue = edit.value
    for step in reversed(path[depth + 1 :]):
        value = [value] if isinstance(step, int) else {step: value}
    here = path[: depth + 1]
    if isinstance(content, dict) and path[depth] in content:  # a name with nothing behind it
        return editing.replace(text, here, value)
    return editing.insert(text, here, value, before=_next(edit.file, here, content))


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
    return editing.replace(placeholder, (name,), value)


def _require_unchanged(text: str, edit: SetEntry | RemoveEntry | MoveEntry, path: EntryPath) -> None:
    editing.value_at(text, ())  # what cannot be read has not been changed by anybody else
    try:
        now = editing.value_at(text, path)
    except EditError:
        raise PartChangedError(edit.file, path, f"`{shown_path(path)}` is not there any more in {edit.file}") from None
    if not editing.same(now, edit.was):
        raise PartChangedError(edit.file, path, f"`{shown_path(path)}` of {edit.file} was changed meanwhile")
