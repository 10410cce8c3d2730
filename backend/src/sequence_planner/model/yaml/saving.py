"""Editing files: a change of a file's text is written whole or not at all, and only over the file it was made from."""

from __future__ import annotations

import difflib
import hashlib
import os
import re
import tempfile
from collections.abc import Callable
from pathlib import Path

from sequence_planner.model.paths import EditError
from sequence_planner.texts.message import message

BYTE_ORDER_MARK = "\ufeff"
_LINE = re.compile(r"[^\n]*\n|[^\n]+")


def digest(path: Path) -> str:
    """Return what `edit_file` can be told to expect: changes whenever the file does."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def edit_file(path: Path, change: Callable[[str], str], *, expected: str | None = None) -> str:
    """Change a file's text; returns the difference as `diff -u` shows it, empty if there is none.

    Line ends and permissions stay as they were. With `expected`, the `digest` of the file that the change is based on,
    a file that was changed since is left alone. Raises `EditError`.
    """
    try:
        written = path.read_bytes()
        text = written.decode("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror or str(error) if isinstance(error, OSError) else message("wrong.unreadable.utf-8")
        raise EditError(message("edit.file-unreadable", path=str(path), why=reason)) from error
    if expected is not None and hashlib.sha256(written).hexdigest() != expected:
        raise _changed(path)
    mark = BYTE_ORDER_MARK if text.startswith(BYTE_ORDER_MARK) else ""
    plain = text.removeprefix(mark).replace("\r\n", "\n")
    has_windows_ends = "\r\n" in text
    if has_windows_ends and plain.count("\n") != text.count("\r\n"):
        raise EditError(message("edit.mixed-line-ends", path=str(path)))
    new = change(plain)
    if new != plain:
        content = mark + (new.replace("\n", "\r\n") if has_windows_ends else new)
        try:
            _write(path, content.encode("utf-8"), instead_of=written)
        except OSError as error:
            raise EditError(
                message("edit.file-unwritable", path=str(path), why=error.strerror or str(error))
            ) from error
    return _difference(path, plain, new)


def add_file(path: Path, text: str) -> str:
    """Write a file that is not there yet, with the folder it is in; returns the difference. Raises `EditError`."""
    try:
        path.parent.mkdir(exist_ok=True)
        with path.open("x", encoding="utf-8", newline="") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
    except FileExistsError:
        raise EditError(message("edit.file-there", path=str(path))) from None
    except OSError as error:
        raise EditError(message("edit.file-unwritable", path=str(path), why=error.strerror or str(error))) from error
    return _difference(path, "", text)


def _difference(path: Path, old: str, new: str) -> str:
    lines: list[str] = []
    for line in difflib.unified_diff(_LINE.findall(old), _LINE.findall(new), str(path), str(path)):
        lines.append(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n")
    return "".join(lines)


def _changed(path: Path) -> EditError:
    return EditError(message("edit.file-changed-by-others", path=str(path)))


def _write(path: Path, content: bytes, instead_of: bytes) -> None:
    """Put `content` in the place of the file in one step: whoever reads it finds the old or the new, never a part.

    Raises `EditError` when the file no longer holds `instead_of`.
    """
    target = path.resolve()  # a link stays a link
    handle, name = tempfile.mkstemp(prefix=f".{target.name}.", dir=target.parent)
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(target.stat().st_mode & 0o7777)
        if target.read_bytes() != instead_of:
            raise _changed(path)
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
