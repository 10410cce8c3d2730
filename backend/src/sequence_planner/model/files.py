"""The files of a model as texts: what an engineer may write in a browser, and how it is read from a folder and written.

Pictures and videos of instructions stand among them in base 64. Python stages are none of them: these come only from
files on the server.
"""

from __future__ import annotations

import base64
import binascii
import contextlib
import os
import re
import shutil
import stat
import tempfile
import time
from collections.abc import Iterator, Mapping
from operator import itemgetter
from pathlib import Path
from typing import NamedTuple

from sequence_planner.model.paths import (
    DEFINITIONS,
    DRAWING,
    DRAWINGS,
    FILES,
    INSTRUCTION,
    INSTRUCTIONS,
    PICTURES,
    SCENARIOS,
    TESTS,
    EditError,
)
from sequence_planner.model.yaml.saving import BYTE_ORDER_MARK
from sequence_planner.texts.message import message

# Texts by their paths below the model's folder, such as `resources/robot.yaml`.
Files = Mapping[str, str]


class FileContent(NamedTuple):
    """A file byte by byte, and who may do what with it: the bits of its mode."""

    data: bytes
    mode: int


# The same files as they are, those that are no text among them.
Contents = Mapping[str, FileContent]

LONGEST_FILE = 1_000_000  # characters
LARGEST_PICTURE = 1_000_000  # bytes
LARGEST_VIDEO = 5_000_000  # bytes
MOST_FILES = 2_000
MOST_CHARACTERS = 20_000_000  # of all files together
STAGES = "stages"
_UNFINISHED = ".unfinished"
# Where files are looked for.
SEARCHED_FOLDERS = ("resources", "types", "messages", DRAWINGS, INSTRUCTIONS, TESTS, "packages")

_NAME = "[A-Za-z_][A-Za-z0-9_]{0,99}"
_DEFINITIONS = "|".join(rf"messages/{_NAME}/{kind}/{_NAME}\.{kind}" for kind in DEFINITIONS)
_NO_TEXT = re.compile("[\0\ud800-\udfff]")
_OF_PACKAGE = rf"package\.yaml|types/{_NAME}\.yaml|{_DEFINITIONS}"
_PATH = re.compile(
    rf"{'|'.join(map(re.escape, FILES))}|packages\.lock|(?:resources|types)/{_NAME}\.yaml|{_DEFINITIONS}"
    rf"|{DRAWINGS}/{DRAWING.pattern}|{INSTRUCTIONS}/{INSTRUCTION.pattern}|{SCENARIOS.pattern}"
    rf"|packages/{_NAME}/(?:{_OF_PACKAGE})"
)


def is_of_model(path: str) -> bool:
    """Return whether a path is that of one of a model's files."""
    return _PATH.fullmatch(path) is not None


def check_path(path: str) -> None:
    """Raises `EditError` for a path that is none of a model's files."""
    if not is_of_model(path):
        raise EditError(message("edit.no-file-of-model", path=path, files=", ".join(FILES)))


def is_binary(path: str) -> bool:
    """Return whether one of a model's files is no text: a picture or a video of an instruction."""
    return path.startswith(f"{INSTRUCTIONS}/") and not path.endswith(".svg")


def largest(path: str) -> int:
    """The bytes that a picture or a video may have at most."""
    return LARGEST_PICTURE if path.endswith(PICTURES) else LARGEST_VIDEO


def content_of(path: str, text: str) -> bytes:
    """The bytes of a file that is known by this text. Raises `EditError` for a text that is none of such a file."""
    if not is_binary(path):
        return text.encode("utf-8")
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        raise EditError(message("edit.no-base64", path=path)) from None


def text_of(path: str, content: bytes) -> str | None:
    """The text by which the bytes of a file are known; None where they are none, or more than a model may have."""
    if is_binary(path):
        return base64.b64encode(content).decode("ascii") if len(content) <= largest(path) else None
    try:
        return content.decode("utf-8").removeprefix(BYTE_ORDER_MARK).replace("\r\n", "\n")
    except UnicodeDecodeError:
        return None


def check_text(path: str, text: str) -> None:
    """Raises `EditError` for a text that is too long, or that no file could hold."""
    if is_binary(path):
        if (size := len(content_of(path, text))) > largest(path):
            raise EditError(message("edit.large-file", path=path, size=size, most=largest(path)))
        return
    if len(text) > LONGEST_FILE:
        raise EditError(message("edit.long-file", path=path, count=len(text), most=LONGEST_FILE))
    if (wrong := _NO_TEXT.search(text)) is not None:
        raise EditError(message("edit.no-character", path=path, code=f"{ord(wrong[0]):#06x}"))


def check_size(files: Files) -> None:
    """Raises `EditError` for more files, or longer ones, than a model has."""
    if len(files) > MOST_FILES:
        raise EditError(message("edit.many-files", most=MOST_FILES))
    if (size := sum(map(len, files.values()))) > MOST_CHARACTERS:
        raise EditError(message("edit.long-model", count=size, most=MOST_CHARACTERS))


def read_files(folder: Path) -> dict[str, str]:
    """The files of the model in `folder`; those that are no UTF-8 text, or too large a picture, are left out. Raises
    `OSError`.
    """
    return FolderReader(folder).read()


class FolderReader:
    """Reads the model in a folder again and again: only files that may be others than they were."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._known: dict[str, tuple[_Stamp, str | None]] = {}

    def read(self) -> dict[str, str]:
        """The files; those that are no UTF-8 text are left out. Raises `OSError`."""
        known, self._known = self._known, {}
        files: dict[str, str] = {}
        for name, entry in sorted(_found(self._folder), key=itemgetter(0)):
            if len(files) == MOST_FILES:
                break
            now, stamp = time.time_ns(), _stamp(entry.stat())
            before = known.get(name)
            text = before[1] if before is not None and before[0] == stamp else _text(name, Path(entry.path))
            # A file that was written just before it was read may be written once more without another stamp.
            if now - stamp[0] > _RACY:
                self._known[name] = stamp, text
            if text is not None:
                files[name] = text
        return files


# When a file was written, its size, and which one it is.
_Stamp = tuple[int, int, int, int]
_RACY = 2_000_000_000  # nanoseconds


def _stamp(status: os.stat_result) -> _Stamp:
    return max(status.st_mtime_ns, status.st_ctime_ns), status.st_size, status.st_dev, status.st_ino


def _found(folder: Path | str, below: str = "") -> Iterator[tuple[str, os.DirEntry[str]]]:
    """The files of a model below `folder`, each with its name, that of `folder` being `below`."""
    with contextlib.suppress(FileNotFoundError, NotADirectoryError, PermissionError), os.scandir(folder) as entries:
        for entry in entries:
            name = f"{below}{entry.name}"
            if (below or name in SEARCHED_FOLDERS) and entry.is_dir(follow_symlinks=False):
                yield from _found(entry.path, f"{name}/")
            elif is_of_model(name) and entry.is_file():
                yield name, entry


def is_package_name(name: str) -> bool:
    """Return whether a package can be called so."""
    return re.fullmatch(_NAME, name) is not None


def is_of_package(path: str) -> bool:
    """Return whether a file belongs to a package, by its path there."""
    return re.fullmatch(_OF_PACKAGE, path) is not None


def package_files(folder: Path) -> dict[str, str]:
    """The files of the package in `folder`; those that are no UTF-8 text are left out, and all links.

    Raises `OSError`.
    """
    files: dict[str, str] = {}
    whole = folder.resolve()
    for path in sorted(each for below in ("*.yaml", "types/*", "messages/*/*/*") for each in folder.glob(below)):
        name = path.relative_to(folder).as_posix()
        is_file = is_of_package(name) and path.resolve() == whole / name and path.is_file()
        if is_file and (text := _text(name, path)) is not None:
            files[name] = text
    return files


def _text(name: str, path: Path) -> str | None:
    if is_binary(name) and path.stat().st_size > largest(name):
        return None
    return text_of(name, path.read_bytes())


def write_files(files: Files, folder: Path, stages: Path | None = None) -> None:
    """Make `folder` hold these files; `stages` is a model whose Python stages belong to them."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content_of(name, text))
    if stages is not None and (stages / STAGES).is_dir():
        shutil.copytree(stages / STAGES, folder / STAGES, dirs_exist_ok=True)


def put_in_place(files: Files, folder: Path) -> None:
    """Let the model in `folder` consist of these files. Whoever reads one of them finds the old or the new text, never
    a part. Other files of the folder stay. Raises `OSError`.
    """
    before = read_files(folder)
    for name, text in files.items():
        if before.get(name) != text:
            _put(folder / name, content_of(name, text))
    for name in before.keys() - files.keys():
        (folder / name).unlink(missing_ok=True)


def read_contents(folder: Path) -> dict[str, FileContent]:
    """All that a deployment may write or remove of the model in `folder`, as it is. Raises `OSError`."""
    return {
        name: FileContent(Path(entry.path).read_bytes(), stat.S_IMODE(entry.stat().st_mode))
        for name, entry in sorted(_found(folder), key=itemgetter(0))
    }


def write_contents(contents: Contents, folder: Path) -> None:
    """Make `folder` hold these files. Raises `OSError`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.data)
        path.chmod(content.mode)


def restore_contents(contents: Contents, folder: Path) -> None:
    """Let the model in `folder` consist of these files again, to the byte and with their modes; see `put_in_place`.
    Raises `OSError`.
    """
    now = read_contents(folder)
    for name, content in contents.items():
        if now.get(name) != content:
            _put(folder / name, content.data, content.mode)
    for name in now.keys() - contents.keys():
        (folder / name).unlink(missing_ok=True)


def forget_unfinished(folder: Path) -> None:
    """Take away what whoever was killed had not written to its end of the model in `folder`. Raises `OSError`."""
    for below in ("", *SEARCHED_FOLDERS):
        for path in (folder / below).rglob(f".*{_UNFINISHED}") if below else folder.glob(f".*{_UNFINISHED}"):
            path.unlink(missing_ok=True)


def _put(path: Path, content: bytes, mode: int | None = None) -> None:
    """Write a file at once, with this mode, or with that which it has."""
    target = path.resolve()  # a link stays a link
    target.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{target.name}.", suffix=_UNFINISHED, dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if mode is None:
            mode = stat.S_IMODE(target.stat().st_mode) if target.exists() else 0o644
        Path(name).chmod(mode)
        Path(name).replace(target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
