"""Files of recordings of ROS 2 traffic, as `ros2 bag record` makes them, laid out so that each can be opened.

They come from elsewhere: nothing of their names and lengths is believed, and nothing in them is executed.
"""

from __future__ import annotations

import errno
import json
import os
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Final, NamedTuple

from sequence_planner.core.immutable import Immutable
from sequence_planner.model.paths import EditError
from sequence_planner.texts.message import Message, message

MB: Final = 1_000_000
MOST_FILES: Final = 1000  # in an archive, or named by its metadata
MOST_METADATA: Final = 16 * MB
METADATA: Final = "metadata.yaml"
LAYOUT: Final = "layout.json"
PIECE: Final = 1 << 20  # bytes that are read at once

_MCAP, _SQLITE, _ZIP, _ZSTD = b"\x89MCAP0\r\n", b"SQLite format 3\0", b"PK\x03\x04", b"\x28\xb5\x2f\xfd"
_EMPTY_ZIP, _ROS_1 = b"PK\x05\x06", b"#ROSBAG V"
_FORMS: Final = {_MCAP: "mcap", _SQLITE: "db3", _ZIP: "zip", _EMPTY_ZIP: "zip", _ZSTD: "zstd", _ROS_1: "ros1"}
_STORED: Final = (".mcap", ".db3", ".mcap.zstd", ".db3.zstd")


class RecordingError(EditError):
    """A recording that cannot be read; the text says `why`, where, and what to do."""


class StoredFile(Immutable):
    """A file of messages: where it lies, what it was called, and whether each message is packed for itself."""

    path: Path
    name: str
    packed: bool


class _Allowance:
    """The bytes that may still be unpacked of what is called `name`."""

    def __init__(self, name: str, most: int) -> None:
        self._name, self._most, self._left = name, most, most

    def use(self, number: int) -> None:
        """Take so many. Raises `RecordingError` where there are not so many."""
        self._left -= number
        if self._left < 0:
            raise RecordingError(message("recording.unpacked", file=self._name, most=f"{self._most // MB}"))


class _Metadata(NamedTuple):
    """The part of `metadata.yaml` that matters: the files in their order, and how they are packed."""

    files: tuple[str, ...] | None
    packed: str  # "", "file" or "message"


def lay_out(source: Path, name: str, folder: Path, most: int) -> None:
    """Lay a recording out in an empty folder: a file of messages, a folder of them, or a zip of the folder.

    At most so many bytes are unpacked. Raises `RecordingError`.
    """
    allowance = _Allowance(name, most)
    with reading(name):
        if source.is_dir():
            files, packed = _of_folder(source, name)
        elif (form := form_of(source)) == "zip":
            within = folder / "unpacked"
            _unzip(source, name, within, allowance)
            files, packed = _of_folder(within, name)
        elif form in ("mcap", "db3", "zstd"):
            files, packed = [(source, name)], ""
        else:
            raise RecordingError(_unusable(source, form, name))
        stored = [
            _placed(file, called, folder / str(number), packed == "message", allowance)
            for number, (file, called) in enumerate(files)
        ]
    written = [{"path": each.path.name, "name": each.name, "packed": each.packed} for each in stored]
    (folder / LAYOUT).write_text(json.dumps(written), encoding="utf-8")


def laid_out(folder: Path) -> tuple[StoredFile, ...]:
    """The files of a recording that was laid out there."""
    written = json.loads((folder / LAYOUT).read_text(encoding="utf-8"))
    return tuple(StoredFile(folder / each["path"], each["name"], each["packed"]) for each in written)


def form_of(file: Path) -> str | None:
    """Return what a file is by its first bytes, whatever it is called."""
    with file.open("rb") as opened:
        begin = opened.read(16)
    return next((form for magic, form in _FORMS.items() if begin.startswith(magic)), None)


@contextmanager
def reading(name: str) -> Iterator[None]:
    """Tell what goes wrong with a file of this name as a `RecordingError`, whatever a library makes of it."""
    try:
        yield
    except RecordingError:
        raise
    except MemoryError:
        raise RecordingError(message("recording.memory", file=name)) from None
    except ImportError as error:
        raise RecordingError(message("recording.library", library=error.name or str(error))) from error
    except Exception as error:
        if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
            raise RecordingError(message("recording.no-room", file=name, why=str(error.strerror))) from None
        raise RecordingError(message("recording.broken", file=name, why=_plain(error, name))) from error


def _plain(error: Exception, name: str = "") -> str:
    """Return what a library says of a file, without where that lies here."""
    said = str(error).strip() or type(error).__name__
    words = [name if word.strip("'\"").startswith("/") else word for word in said.split()]
    return " ".join(filter(None, words))[:300].rstrip(".:")


def _unusable(file: Path, form: str | None, name: str) -> Message:
    if not file.stat().st_size:
        return message("recording.no-bytes", file=name)
    if form == "ros1":
        return message("recording.ros-1", file=name)
    with file.open("rb") as opened:
        begin = opened.read(1024)
    if b"rosbag2_bagfile_information" in begin:
        return message("recording.only-metadata", file=name)
    return message("recording.form", file=name)


def _of_folder(folder: Path, name: str) -> tuple[list[tuple[Path, str]], str]:
    """The files of messages of a folder, each with its name, and how they are packed."""
    metadata = folder / METADATA
    told = _metadata(metadata) if metadata.is_file() else _Metadata(None, "")
    if told.files is None:
        names = sorted(each.name for each in folder.iterdir() if each.name.endswith(_STORED) and each.is_file())
        if not names:
            raise RecordingError(message("recording.no-files", file=name))
        return [(folder / each, each) for each in names], told.packed
    missing = [each for each in told.files if not (folder / each).is_file()]
    if missing:
        raise RecordingError(message("recording.missing", file=name, names=missing[:5], metadata=METADATA))
    return [(folder / each, each) for each in told.files], told.packed


def _metadata(file: Path) -> _Metadata:
    from ruamel.yaml import YAML  # noqa: PLC0415 - most recordings are a single file
    from ruamel.yaml.error import YAMLError  # noqa: PLC0415

    if file.stat().st_size > MOST_METADATA:
        raise RecordingError(message("recording.metadata-large", file=METADATA, most=MOST_METADATA // MB))
    try:
        written = YAML(typ="safe").load(file.read_text(encoding="utf-8"))
        told = written["rosbag2_bagfile_information"]
        # Names alone count: what is elsewhere is no part of the recording.
        files = tuple(PurePosixPath(str(each)).name for each in told["relative_file_paths"])
        mode = str(told.get("compression_mode") or "").lower()
        form = str(told.get("compression_format") or "").lower()
    except (YAMLError, UnicodeDecodeError, KeyError, TypeError, AttributeError, RecursionError) as error:
        why = f"{type(error).__name__}: {_plain(error)}"
        raise RecordingError(message("recording.metadata", file=METADATA, why=why)) from None
    if len(files) > MOST_FILES:
        raise RecordingError(message("recording.many-files", file=METADATA, most=MOST_FILES))
    packed = mode if mode in ("file", "message") else ""
    if packed and form != "zstd":
        raise RecordingError(message("recording.compression", file=METADATA, form=form or "none"))
    return _Metadata(files, packed)


def _unzip(archive: Path, name: str, folder: Path, allowance: _Allowance) -> None:
    """Unpack the files of one recording out of an archive, under their names alone."""
    folder.mkdir()
    try:
        with zipfile.ZipFile(archive) as opened:
            members = opened.infolist()
            if len(members) > MOST_FILES:
                raise RecordingError(message("recording.many-files", file=name, most=MOST_FILES))
            wanted = list(_members(members, name))
            for member, within in wanted:
                with opened.open(member) as packed, (folder / within.name).open("xb") as plain:
                    _copy(packed.read, plain.write, allowance)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError) as error:
        # RuntimeError and NotImplementedError: it is encrypted, or packed in a way that Python does not know.
        raise RecordingError(message("recording.zip", file=name, why=_plain(error))) from None


def _members(members: Iterable[zipfile.ZipInfo], name: str) -> Iterator[tuple[zipfile.ZipInfo, PurePosixPath]]:
    """Yield the files of an archive that belong to its one recording."""
    folders: set[PurePosixPath] = set()
    for member in members:
        path = PurePosixPath(member.filename)
        if path.is_absolute() or ".." in path.parts or "\\" in member.filename or ":" in path.parts[:1]:
            raise RecordingError(message("recording.zip-path", file=name, path=member.filename[:200]))
        is_hidden = any(part.startswith((".", "__MACOSX")) for part in path.parts)
        if member.is_dir() or is_hidden or not (path.name == METADATA or path.name.endswith(_STORED)):
            continue
        folders.add(path.parent)
        if len(folders) > 1:
            raise RecordingError(message("recording.several", file=name, folders=sorted(map(str, folders))))
        yield member, path


def _placed(file: Path, name: str, place: Path, packed: bool, allowance: _Allowance) -> StoredFile:
    """A file of messages at a place by which each library opens it, unpacked where the whole of it was packed."""
    form = form_of(file)
    if form == "zstd":
        from backports import zstd  # noqa: PLC0415 - most are not packed

        whole = place.with_suffix(".whole")
        with zstd.open(file, "rb") as compressed, whole.open("xb") as plain:
            _copy(compressed.read, plain.write, allowance)
        file, form = whole, form_of(whole)
    if form not in ("mcap", "db3"):
        raise RecordingError(_unusable(file, form, name))
    if form == "mcap":
        _check_end(file, name)
    target = place.with_suffix(f".{form}")
    target.symlink_to(file.resolve())
    return StoredFile(target, name, packed)


def _check_end(file: Path, name: str) -> None:
    """Raises `RecordingError` where the end is missing, as it is after whoever recorded was killed."""
    with file.open("rb") as opened:
        opened.seek(-min(len(_MCAP), file.stat().st_size), os.SEEK_END)
        if opened.read() != _MCAP:
            raise RecordingError(message("recording.cut-off", file=name))


def _copy(read: Callable[[int], bytes], write: Callable[[bytes], object], allowance: _Allowance) -> None:
    while piece := read(PIECE):
        allowance.use(len(piece))
        write(piece)
