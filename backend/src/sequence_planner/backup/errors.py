"""The things that keep a backup from being made or from being whole: of which kind each is, and in words what to do."""

from __future__ import annotations

import errno
from enum import StrEnum
from pathlib import Path
from typing import Final

from sequence_planner.core.storage_error import StorageError


class Trouble(StrEnum):
    """Kinds of trouble that people remedy in different ways."""

    NO_SPACE = "no-space"
    NO_FOLDER = "no-folder"
    NOT_WRITABLE = "not-writable"
    NO_PROGRAM = "no-program"  # that copies the database
    NOT_WHOLE = "not-whole"  # what would be copied, or what was
    OTHER = "other"


class BackupError(StorageError):
    """A backup cannot be made, or is not whole; the message says what to do."""

    def __init__(self, trouble: Trouble, message: str) -> None:
        super().__init__(message)
        self.trouble = trouble

    def __reduce__(self) -> tuple[type[BackupError], tuple[Trouble, str]]:
        """For the process that makes backups, which tells another."""
        return BackupError, (self.trouble, str(self))


_NO_SPACE: Final = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
_NO_FOLDER: Final = (errno.ENOENT, errno.ENOTDIR)
_NOT_WRITABLE: Final = (errno.EACCES, errno.EPERM, errno.EROFS)


def trouble_of(error: OSError, folder: Path) -> BackupError:
    """Put in words what the system says while a backup is written to or unpacked in `folder`."""
    said = f"{error.strerror or error}: {error.filename}" if error.filename else str(error.strerror or error)
    if error.errno in _NO_SPACE:
        return no_space(folder, said)
    if error.filename is not None and not Path(str(error.filename)).absolute().is_relative_to(folder.absolute()):
        return BackupError(Trouble.OTHER, f"the backup cannot be made: {said}")  # what was to be copied is to blame
    if error.errno in _NO_FOLDER:
        return no_folder(folder, said)
    if error.errno in _NOT_WRITABLE:
        return not_writable(folder, said)
    return BackupError(Trouble.OTHER, f"{folder} cannot be written to: {said}")


def no_space(folder: Path, said: str) -> BackupError:
    """There is no room for what is to be written."""
    return BackupError(
        Trouble.NO_SPACE, f"there is no room on the disk of {folder}: make room, or name a folder elsewhere ({said})"
    )


def no_folder(folder: Path, said: str) -> BackupError:
    """The folder is not there."""
    return BackupError(Trouble.NO_FOLDER, f"there is no folder {folder}: make or mount it, or name another ({said})")


def not_writable(folder: Path, said: str) -> BackupError:
    """The folder is there, and nothing can be written to it."""
    return BackupError(
        Trouble.NOT_WRITABLE, f"nothing can be written to {folder}: let the user who runs the station do so ({said})"
    )


def trouble_in(error: StorageError) -> Trouble:
    """Of which kind an error is."""
    return error.trouble if isinstance(error, BackupError) else Trouble.OTHER
