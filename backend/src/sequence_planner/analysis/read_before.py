"""What the files of a model mean, kept for commands and for a station's processes: few models have changed since.

It is kept by all that lies in the model's folder, or in the file of a plain automaton, and by what its path is called,
which findings name.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from sequence_planner.analysis.remembering import cache, read, write
from sequence_planner.analysis.store import program
from sequence_planner.automaton.structure import Automaton

AUTOMATON: Final = "automaton"
STATION: Final = "station"
_MOST_FILES: Final = 2_000
_MOST_BYTES: Final = 20_000_000


class _NoModelError(Exception):
    """What is there is more than a model, or something else."""


def content_key(path: Path) -> str | None:
    """What is in the files of a model, and in this program; None where that is not to be found out soon."""
    total, files, size = hashlib.sha256(program()), 0, 0
    total.update(f"{path}\0".encode("utf-8", "surrogateescape"))
    with contextlib.suppress(OSError, _NoModelError):
        for name, content in _contents(path, ""):
            files, size = files + 1, size + len(content)
            if files > _MOST_FILES or size > _MOST_BYTES:
                return None
            for each in (name.encode("utf-8", "surrogateescape"), content):
                total.update(len(each).to_bytes(8) + each)
        return total.hexdigest()
    return None


def automaton_read_before(of: str) -> Automaton | None:
    """The automaton of a model with this content; None if it was never read, or cannot be read again."""
    found = read_before(AUTOMATON, of)
    return found if isinstance(found, Automaton) else None


def keep_automaton(of: str, automaton: Automaton) -> None:
    """Keep the automaton of a model with this content."""
    keep(AUTOMATON, of, automaton)


def read_before(kind: str, of: str) -> object:
    """What was kept of a model with this content; None if nothing was, or it cannot be read again."""
    where = cache()
    return None if where is None else read(where, kind, of)


def keep(kind: str, of: str, found: object) -> None:
    """Keep what a model with this content means."""
    where = cache()
    if where is not None:
        write(where, kind, of, found)


def _contents(path: Path | str, below: str) -> Iterator[tuple[str, bytes]]:
    """All files, and folders by their names. Raises `OSError` and `_NoModelError`."""
    if not stat.S_ISDIR(os.stat(path).st_mode):  # noqa: PTH116 - of a path that may be a text
        yield below, _content(path)
        return
    with os.scandir(path) as entries:
        for entry in sorted(entries, key=lambda each: each.name):
            name = f"{below}/{entry.name}"
            if entry.is_dir():
                if entry.is_symlink():
                    raise _NoModelError
                if entry.name == "__pycache__" or (not below and entry.name.startswith(".")):
                    continue  # what Python, editors and version control keep there
                yield f"{name}/", b""
                yield from _contents(entry.path, name)
            elif entry.is_file():
                yield name, _content(entry.path)
            else:
                raise _NoModelError


def _content(path: Path | str) -> bytes:
    with open(path, "rb") as file:  # noqa: PTH123 - of a path that may be a text
        return file.read(_MOST_BYTES + 1)
