"""Where the archive is. A folder that somebody has named must be there: one that is not may be a disk that is not
mounted, and what is written in its place nobody would look for.
"""

from __future__ import annotations

import os
from pathlib import Path

from sequence_planner.journal.archive_file import ArchiveError
from sequence_planner.storage.location import archive_folder


def place(named: Path | None, url: str, model: Path | None) -> Path:
    """The folder, there or not. Raises `StorageError` for a URL that names no database."""
    return (named or archive_folder(url, model or Path())).absolute()


def usable(named: Path | None, url: str, model: Path | None) -> Path:
    """The folder, which can be written to; one that nobody has named is made, for this user alone.

    Raises `StorageError`.
    """
    folder = place(named, url, model)
    try:
        if named is None:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        raise ArchiveError(f"the folder {folder} cannot be made ({error.strerror}): see to its disk") from error
    if not folder.is_dir():
        raise ArchiveError(f"there is no folder {folder}: make or mount it, or name another with --archive-folder")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise ArchiveError(f"nothing can be written to {folder}: let the user who runs the station do so")
    return folder
