"""Messages of a recording, one after the other in the order of their times, as bytes."""

from __future__ import annotations

import heapq
from collections.abc import Collection, Generator, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple, Self

from sequence_planner.core.immutable import Immutable
from sequence_planner.editor.recordings.files import MB, RecordingError, StoredFile, laid_out, reading
from sequence_planner.ros.types.definitions import as_uint8, carried
from sequence_planner.texts.message import message

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.rosbag2 import Reader

MOST_CHUNK: Final = 512 * MB  # bytes that belong together in a file, unpacked
MOST_MESSAGE: Final = 64 * MB  # bytes of a message that is packed for itself
NS: Final = 1_000_000_000  # in a second


class RecordedTopic(Immutable):
    """A topic as it was recorded; `type_hash` is that of its definition, where the recording has that and it can be
    read.
    """

    name: str
    type_name: str
    encoding: str
    type_hash: str | None
    messages: int


class RecordedMessage(NamedTuple):
    """A message: its bytes, or why there are none, and when it came, in nanoseconds since the epoch."""

    topic: str
    at: int
    data: bytes
    trouble: str = ""


class Bag:
    """A recording that was laid out in a folder, open as a context. Raises `RecordingError`, whatever is done."""

    def __init__(self, folder: Path) -> None:
        self._files = laid_out(folder)
        self._readers: list[tuple[Reader, StoredFile]] = []
        self._stack = ExitStack()
        self.topics: tuple[RecordedTopic, ...] = ()
        self.begin = self.end = 0  # in nanoseconds since the epoch: of the first message, and of the last
        self.messages = 0

    def __enter__(self) -> Self:
        try:
            self._open()
        except BaseException:
            self._stack.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def messages_of(self, topics: Collection[RecordedTopic]) -> Generator[RecordedMessage]:
        """Yield the messages of topics."""
        wanted = {(each.name, each.type_name) for each in topics}
        streams = [self._of_file(reader, file, wanted) for reader, file in self._readers]
        yield from heapq.merge(*streams, key=lambda each: each.at)

    def _open(self) -> None:
        found: dict[tuple[str, str], RecordedTopic] = {}
        begins, ends = [], []
        for file in self._files:
            with reading(file.name):
                # Imported when a recording is read: it brings libraries that nothing else has a use for.
                from rosbags.rosbag2 import Reader  # noqa: PLC0415

                reader = Reader(file.path)
                self._stack.enter_context(reader)
                _check_chunks(reader, file.name)
                for connection in reader.connections:
                    topic = _topic(connection)
                    before = found.get((topic.name, topic.type_name))
                    count = topic.messages + (0 if before is None else before.messages)
                    kept = topic if before is None else before
                    found[topic.name, topic.type_name] = RecordedTopic(
                        kept.name, kept.type_name, kept.encoding, kept.type_hash or topic.type_hash, count
                    )
                if reader.message_count:
                    begins.append(reader.start_time)
                    ends.append(reader.end_time - 1)
                    self.messages += reader.message_count
                self._readers.append((reader, file))
        self.topics = tuple(sorted(found.values(), key=lambda each: each.name))
        if not self.messages:
            raise RecordingError(message("recording.empty", file=self._files[0].name if self._files else ""))
        self.begin, self.end = min(begins), max(ends)

    def _of_file(
        self, reader: Reader, file: StoredFile, wanted: Collection[tuple[str, str]]
    ) -> Iterator[RecordedMessage]:
        with reading(file.name):
            connections = [each for each in reader.connections if (each.topic, each.msgtype) in wanted]
            if not connections:
                return
            last = self.begin
            for connection, at, data in reader.messages(connections):
                last = max(last, at)  # as it was heard: a clock that was set back makes nothing come before
                yield (
                    _unpacked(connection.topic, last, data)
                    if file.packed
                    else RecordedMessage(connection.topic, last, data)
                )


def _check_chunks(reader: Reader, name: str) -> None:
    """Raises `RecordingError` for what would take too much memory, as far as the file says so."""
    for chunk in getattr(reader.storage, "chunks", ()):
        if chunk.uncompressed_size > MOST_CHUNK:
            raise RecordingError(message("recording.chunk", file=name, most=MOST_CHUNK // MB))


def _unpacked(topic: str, at: int, data: bytes) -> RecordedMessage:
    from backports import zstd  # noqa: PLC0415 - most recordings are not packed

    unpacking = zstd.ZstdDecompressor()
    try:
        plain = unpacking.decompress(data, max_length=MOST_MESSAGE)
    except zstd.ZstdError as error:
        return RecordedMessage(topic, at, b"", f"it cannot be unpacked: {error}")
    if not unpacking.eof:
        return RecordedMessage(topic, at, b"", f"unpacked it has more than {MOST_MESSAGE // MB} MB, or it is cut off")
    return RecordedMessage(topic, at, plain)


def _topic(connection: Connection) -> RecordedTopic:
    encoding = str(getattr(connection.ext, "serialization_format", "cdr"))
    digest = connection.digest if connection.digest.startswith("RIHS01_") else None
    return RecordedTopic(
        connection.topic, connection.msgtype, encoding, digest or _hash(connection), connection.msgcount
    )


def _hash(connection: Connection) -> str | None:
    """Return the hash of the definition that a recording has of a type; None where it cannot be told.

    The text is read, and no class is made of it.
    """
    from rosbags.interfaces import MessageDefinitionFormat  # noqa: PLC0415 - see above
    from rosbags.typesys import get_types_from_idl, get_types_from_msg  # noqa: PLC0415
    from rosbags.typesys.store import Typestore  # noqa: PLC0415

    form, text = connection.msgdef.format, connection.msgdef.data
    try:
        if form == MessageDefinitionFormat.MSG:
            types = get_types_from_msg(text, connection.msgtype)
        elif form == MessageDefinitionFormat.IDL:
            types = get_types_from_idl(text)
        else:
            return None
        store = Typestore()
        for name, (_, fields) in types.items():
            store.fielddefs[name] = ([], as_uint8(carried(fields), {"char"}))
        return store.hash_rihs01(connection.msgtype)
    except (MemoryError, RecordingError):
        raise
    except Exception:  # whatever it is that cannot be read: the messages are, then, as the draft declares them
        return None
