"""A store of what was found of a model, kept in the user's cache by the content of the model and of the program itself.

It serves commands that are given one after the other. What a running station keeps lies beside it, see `cache`.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import pickle
import tempfile
from dataclasses import replace
from functools import cache
from pathlib import Path

from pydantic import ValidationError

from sequence_planner.analysis.report import AnalysisDocument, Document, SupervisorDocument
from sequence_planner.automaton.automaton import Automaton

MOST_KEPT = 100  # files; the oldest are removed


class Kept(Document):
    """The part of the findings about a model that is kept; no `supervisor` if there is none."""

    analysis: AnalysisDocument
    supervisor: SupervisorDocument | None


def folder() -> Path:
    """Return where it is kept: in `XDG_CACHE_HOME`, or else in `~/.cache`."""
    base = os.environ.get("XDG_CACHE_HOME", "")
    return (Path(base) if Path(base).is_absolute() else Path.home() / ".cache") / "sequence-planner"


def key(automaton: Automaton) -> str:
    """Return what a model and the program have in common with others only if the same is found of them.

    Places count, as what is found names them. In which order a job has its operations and what alarms
    there are does not.
    """
    masters = {name: replace(master, operations={}) for name, master in automaton.work_masters.items()}
    content = pickle.dumps((replace(automaton, work_masters=masters, alarms={}), dict(automaton.places)))
    # Equal texts may be one text or several, which a pickle tells; after one of them they are as after all others.
    content = pickle.dumps(pickle.loads(content))
    return hashlib.sha256(program() + content).hexdigest()


def kept(automaton: Automaton) -> Kept | None:
    """Return what was found of the model; None if that is not known, or can no longer be read."""
    try:
        content = json.loads(_file(automaton).read_bytes())
        text = content["text"]
        if hashlib.sha256(text.encode()).hexdigest() == content["sum"]:
            return Kept.model_validate_json(text)
    except (OSError, RuntimeError, ValueError, KeyError, TypeError, AttributeError, ValidationError):
        pass
    return None


def keep(automaton: Automaton, found: Kept) -> None:
    """Keep what was found. Where nothing can be written, nothing is kept."""
    with contextlib.suppress(OSError, RuntimeError):
        file = _file(automaton)
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        text = found.model_dump_json()
        content = json.dumps({"sum": hashlib.sha256(text.encode()).hexdigest(), "text": text})
        with tempfile.TemporaryDirectory(dir=file.parent) as beside:
            written = Path(beside) / file.name
            written.write_text(content, encoding="utf-8")
            written.replace(file)
        _remove_oldest(file.parent)


def _file(automaton: Automaton) -> Path:
    return folder() / f"{key(automaton)}.json"


def _remove_oldest(where: Path) -> None:
    files = sorted(where.glob("*.json"), key=lambda file: file.stat().st_mtime, reverse=True)
    for file in files[MOST_KEPT:]:
        file.unlink(missing_ok=True)


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
