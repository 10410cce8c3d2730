"""What was found of the model that a station runs, kept for its controller's next start.

It lies in the folder of the running station, which is the user's alone and goes with the station. What lies in a folder
that somebody else can write to is never read: it decides what is safe.
"""

from __future__ import annotations

import os
import pickle
import stat
import tempfile
from pathlib import Path

import structlog

from sequence_planner.analysis.analysis import Analysis
from sequence_planner.analysis.store import key
from sequence_planner.automaton.structure import Automaton

LOG = structlog.get_logger(__name__)
NAME = "analysis"  # of the file


def remember(folder: Path, automaton: Automaton, found: Analysis) -> None:
    """Keep what was found, if the folder is the user's alone."""
    if not _is_own(folder):
        return
    try:
        with tempfile.NamedTemporaryFile(dir=folder, delete=False) as file:
            pickle.dump((key(automaton), found), file)
        Path(file.name).replace(folder / NAME)
    except OSError as error:
        LOG.warning("the next start of the controller has to compute the safe states anew", because=str(error))


def remembered(folder: Path, automaton: Automaton) -> Analysis | None:
    """What was found of this very model, by this very program; None if nothing was, or it cannot be read."""
    try:
        if not _is_own(folder):
            return None
        with (folder / NAME).open("rb") as file:
            of, found = pickle.load(file)
    except FileNotFoundError:
        return None
    except Exception as error:  # whatever a damaged file makes of it
        LOG.warning("what was found of the model before cannot be read", because=repr(error))
        return None
    return found if of == key(automaton) and isinstance(found, Analysis) else None


def _is_own(folder: Path) -> bool:
    status = folder.stat()
    return status.st_uid == os.getuid() and not stat.S_IMODE(status.st_mode) & 0o077
