"""Cache of analysis results: parsed models, supervisors and check evidence, keyed by model content."""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeVar

from sequence_planner.analysis.analysis import Analysis
from sequence_planner.analysis.report import read_supervisor
from sequence_planner.analysis.store import folder, kept, key, program
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.late_log import LateLog

if TYPE_CHECKING:
    from sequence_planner.analysis.checks.evidence import Evidence
    from sequence_planner.analysis.mutual_exclusion import NeverTogether

# What was found of a model, kept for the next start of a controller that runs it, and for commands.
#
# It lies in the user's cache, by the content of the model and of the program, or, where that cannot be used, in the
# folder of the running station and goes with it. What lies in a folder that somebody else can write to is never read:
# it decides what is safe.

LOG = LateLog(__name__)
NAMES: Final = {"Analysis": "analysis", "NeverTogether": "never-together", "Supervisor": "supervisor"}
"""How files begin, by what is in them."""
_EVIDENCE: Final = "evidence"
MOST_KEPT: Final = 20  # files of each kind; the oldest are removed
_DIGEST: Final = 32  # bytes of SHA-256, before what is kept

Found = TypeVar("Found", Analysis, "NeverTogether", Supervisor)


def cache() -> Path | None:
    """The user's cache; None where there is none that is the user's alone."""
    with contextlib.suppress(OSError, RuntimeError):  # there may be no home
        found = folder()
        found.mkdir(mode=0o700, parents=True, exist_ok=True)
        if _is_own(found) and os.access(found, os.W_OK):
            return found
    return None


def remember(where: Path, automaton: Automaton, found: Analysis | NeverTogether | Supervisor) -> None:
    """Keep what was found, if the folder is the user's alone."""
    write(where, NAMES[type(found).__name__], key(automaton), found)


def remembered(where: Path, automaton: Automaton, kind: type[Found]) -> Found | None:
    """Return what was found of this very model, by this very program; None if nothing was, or it cannot be read."""
    found = read(where, NAMES[kind.__name__], key(automaton))
    return found if isinstance(found, kind) else None


def remembered_evidence(automaton: Automaton) -> Evidence | None:
    """Return what answers about the model of this name rested on when it was last looked at, from the user's cache."""
    from sequence_planner.analysis.checks.evidence import Evidence  # noqa: PLC0415

    where = cache()
    found = None if where is None else read(where, _EVIDENCE, _of_name(automaton))
    return found if isinstance(found, Evidence) else None


def remember_evidence(automaton: Automaton, found: Evidence) -> None:
    """Keep it for the next edit."""
    where = cache()
    if where is not None:
        write(where, _EVIDENCE, _of_name(automaton), found)


def _of_name(automaton: Automaton) -> str:
    return hashlib.sha256(program() + automaton.name.encode()).hexdigest()


def write(where: Path, kind: str, of: str, found: object) -> None:
    """Keep what was found of what has the key `of`, if the folder is the user's alone."""
    if not _is_own(where):
        return
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


def read(where: Path, kind: str, of: str) -> object:
    """Return what was found of that; None if nothing was, or it cannot be read."""
    try:
        if not _is_own(where):
            return None
        with (where / f"{kind}-{of}").open("rb") as file:
            digest, content = file.read(_DIGEST), file.read()
        if hashlib.sha256(content).digest() != digest:
            raise ValueError("it is damaged")
        return pickle.loads(content)
    except FileNotFoundError:
        return None
    except Exception as error:  # whatever a damaged file makes of it
        LOG.warning("what was found of the model before cannot be read and is found anew", because=str(error))
        return None


def supervisor_of(automaton: Automaton) -> Supervisor:
    """The supervisor of `automaton`: remembered, or computed here and now, and then remembered.

    Raises `SynthesisError` if there is none.
    """
    known = known_supervisor(automaton)
    if known is None:
        from sequence_planner.synthesis.supervisor import synthesise  # noqa: PLC0415

        known = synthesise(automaton)
        remember_supervisor(automaton, known)
    return known


def known_supervisor(automaton: Automaton) -> Supervisor | None:
    """The supervisor of `automaton` if it is remembered in the user's cache."""
    where = cache()
    if where is None:
        return None
    found = remembered(where, automaton, Supervisor)
    if found is None and (analysis := remembered(where, automaton, Analysis)) is not None:
        found = analysis.supervisor
    if found is None and (command := kept(automaton)) is not None and command.supervisor is not None:
        found = read_supervisor(automaton, command.supervisor)
    return found


def remember_supervisor(automaton: Automaton, found: Supervisor) -> None:
    """Keep a supervisor in the user's cache, if there is one."""
    where = cache()
    if where is not None:
        remember(where, automaton, found)


def _is_own(where: Path) -> bool:
    status = where.stat()
    return status.st_uid == os.getuid() and not stat.S_IMODE(status.st_mode) & 0o077


# What the files of a model mean, kept for commands and for a station's processes: few models have changed since.
#
# It is kept by all that lies in the model's folder, or in the file of a plain automaton, and by what its path is
# called, which findings name.

AUTOMATON: Final = "automaton"
STATION: Final = "station"
_MOST_FILES: Final = 2_000
_MOST_BYTES: Final = 20_000_000


class _NoModelError(Exception):
    """The error that what is there is more than a model, or something else."""


def content_key(path: Path) -> str | None:
    """Return a key to what is in the files of a model, and in this program; None where that is not to be found out
    soon.
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


def automaton_read_before(of: str) -> Automaton | None:
    """The automaton of a model with this content; None if it was never read, or cannot be read again."""
    found = read_before(AUTOMATON, of)
    return found if isinstance(found, Automaton) else None


def keep_automaton(of: str, automaton: Automaton) -> None:
    """Keep the automaton of a model with this content."""
    keep(AUTOMATON, of, automaton)


def read_before(kind: str, of: str) -> object:
    """Return what was kept of a model with this content; None if nothing was, or it cannot be read again."""
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
