"""The store of what is known of models: what their files mean, supervisors, findings and the evidence for them.

It is for commands and for the next start of a controller. Nothing is found again of another model or by another
version of the program, as both are in the key. It lies in the user's cache or, where that cannot be used, in the folder
of the running station. What lies in a folder that somebody else can write to is never read: it decides what is safe.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import stat
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Final, TypeVar

from sequence_planner.analysis.analysis import Analysis
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.late_log import LateLog
from sequence_planner.language.shorthand.titles import NO_TITLES
from sequence_planner.language.shorthand.vocabulary import NO_VOCABULARY

LOG = LateLog(__name__)
MOST_KEPT: Final = 20  # files of each kind; the oldest are removed
_DIGEST: Final = 32  # bytes of SHA-256, before what is kept

Found = TypeVar("Found")


def user_cache() -> Path | None:
    """The user's cache; None where there is none that is the user's alone."""
    with contextlib.suppress(OSError, RuntimeError):  # there may be no home
        found = folder()
        found.mkdir(mode=0o700, parents=True, exist_ok=True)
        if _is_own(found) and os.access(found, os.W_OK):
            return found
    return None


def folder() -> Path:
    """Return where it is: in `XDG_CACHE_HOME`, or else in `~/.cache`."""
    base = os.environ.get("XDG_CACHE_HOME", "")
    return (Path(base) if Path(base).is_absolute() else Path.home() / ".cache") / "sequence-planner"


def write(of: str, found: object, where: Path | None = None) -> None:
    """Keep what was found of what has the key `of`, by its type; in the user's cache, or elsewhere.

    Where nothing can be written, nothing is kept.
    """
    where = where or user_cache()
    if where is None or not _is_own(where):
        return
    kind = type(found).__name__
    try:
        with tempfile.NamedTemporaryFile(dir=where, delete=False) as file:
            content = pickle.dumps(found)
            file.write(hashlib.sha256(content).digest() + content)
        Path(file.name).replace(where / f"{kind}-{of}")
        by_age = sorted(where.glob(f"{kind}-*"), key=lambda each: each.stat().st_mtime, reverse=True)
        for each in by_age[MOST_KEPT:]:
            each.unlink(missing_ok=True)
    except OSError as error:
        LOG.warning("the next start of the controller has to find out about the model anew", because=str(error))


def read(of: str, wanted: type[Found], where: Path | None = None) -> Found | None:
    """Return what was found of that; None if nothing was, or it cannot be read."""
    where = where or user_cache()
    try:
        if where is None or not _is_own(where):
            return None
        with (where / f"{wanted.__name__}-{of}").open("rb") as file:
            digest, content = file.read(_DIGEST), file.read()
        if hashlib.sha256(content).digest() != digest:
            raise ValueError("it is damaged")
        found = pickle.loads(content)
    except FileNotFoundError:
        return None
    except Exception as error:  # whatever a damaged file makes of it
        LOG.warning("what was found of the model before cannot be read and is found anew", because=str(error))
        return None
    return found if isinstance(found, wanted) else None


def _is_own(where: Path) -> bool:
    status = where.stat()
    return status.st_uid == os.getuid() and not stat.S_IMODE(status.st_mode) & 0o077


def supervisor_of(automaton: Automaton) -> Supervisor:
    """The supervisor of `automaton`: known, or computed here and now, and then kept.

    Raises `SynthesisError` if there is none.
    """
    known = known_supervisor(automaton)
    if known is None:
        from sequence_planner.synthesis.supervisor import synthesise  # noqa: PLC0415

        known = synthesise(automaton)
        write(key(automaton), known)
    return known


def known_supervisor(automaton: Automaton) -> Supervisor | None:
    """The supervisor of `automaton` if a command or a controller has found it."""
    found = read(key(automaton), Supervisor)
    if found is None and (analysis := read(key(automaton), Analysis)) is not None:
        found = analysis.supervisor
    return found


# What a model, its files or its name are kept by.


def key(automaton: Automaton) -> str:
    """Return what a model and the program have in common with others only if the same is found of them.

    Places and titles of parts count, as what is found names them. In which order a job has its operations, what alarms
    there are, in which words the model is written and what it calls variables and values does not.
    """
    masters = {name: replace(master, operations={}) for name, master in automaton.work_masters.items()}
    wordless = replace(automaton, vocabulary=NO_VOCABULARY, titles=NO_TITLES)
    ground = replace(wordless, work_masters=masters, alarms={}, indices={})
    content = pickle.dumps((ground, dict(automaton.places)))
    # Equal texts may be one text or several, which a pickle tells; after one of them they are as after all others.
    content = pickle.dumps(pickle.loads(content))
    return hashlib.sha256(program() + content).hexdigest()


def name_key(automaton: Automaton) -> str:
    """Return a key to what the model of this name was like when it was last looked at."""
    return hashlib.sha256(program() + automaton.name.encode()).hexdigest()


_MOST_FILES: Final = 2_000
_MOST_BYTES: Final = 20_000_000


class _NoModelError(Exception):
    """The error that what is there is more than a model, or something else."""


def content_key(path: Path) -> str | None:
    """Return a key to what is in the files of a model: in its folder, or in the file of a plain automaton; None where
    that is not to be found out soon.

    What its path is called counts, as findings name it.
    """
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


@cache
def program() -> bytes:
    """A sum of when, where and how long the program's own files were written, so that what an older one has found does
    not count. To read them all would take as long as many a command.
    """
    total = hashlib.sha256()
    folders = [str(Path(__file__).parents[1])]
    while folders:
        with os.scandir(folders.pop()) as entries:
            for entry in sorted(entries, key=lambda each: each.name):
                if entry.is_dir():
                    folders.append(entry.path)
                elif entry.name.endswith(".py"):
                    status = entry.stat()
                    written = status.st_mtime_ns, status.st_ctime_ns, status.st_size, status.st_ino
                    total.update(f"{entry.path} {written}\n".encode())
    return total.digest()
