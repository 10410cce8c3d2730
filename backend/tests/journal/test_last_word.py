"""The last word of a station: whole whatever happens, one controller's at a time, and what follows from it."""

from __future__ import annotations

import asyncio
import resource
import subprocess
import sys
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.location import PostgresqlServer, SqliteFile, address
from sequence_planner.journal.entry import LONGEST_REASON, Entry
from sequence_planner.journal.hash_chain import ChainPosition
from sequence_planner.journal.last_accepted import LastEnding, LastWord, Word, ending, last_word_file, set_aside
from sequence_planner.journal.writer import RunWriter
from support.examples import examples

BEGUN = "begun"
OTHER = """
import sys
from pathlib import Path
from sequence_planner.journal.last_accepted import LastWord

LastWord.open(Path(sys.argv[1]))
"""


def word(number: int, mode: str = "paused", reason: str = "") -> Word:
    return Word(number=number, mode=mode, time=1.0, entry=Entry(actor=SYSTEM, action="set-mode", reason=reason))


def lives(path: Path) -> list[tuple[int, int | None]]:
    """Of each life that the file tells of, the newest first, the number of its first record and of its last word."""
    with closing(LastWord.open(path)) as opened:
        found = sorted(opened.lives, key=lambda each: -each.turn)
        return [(each.number, None if each.word is None else each.word.number) for each in found]


def test_what_was_said_is_there_after_a_new_start_beside_the_life_before(tmp_path: Path) -> None:
    path = tmp_path / "state" / "last-word"
    with closing(LastWord.open(path)) as opened:
        opened.start_life(ChainPosition(1, "a"), None)
        opened.say(word(5))
    assert path.stat().st_mode & 0o777 == 0o600
    with closing(LastWord.open(path)) as opened:
        opened.start_life(ChainPosition(9, "b"), 3)
    assert lives(path) == [(9, None), (1, 5)]
    with closing(LastWord.open(path)) as opened:
        assert [each.epoch for each in opened.lives if each.number == 9] == [3]
        opened.start_life(ChainPosition(9, "b"), 3)
        opened.say(word(12))
        opened.say(word(15))
    assert lives(path) == [(9, 15), (9, 12)]


def test_a_word_that_was_not_written_to_its_end_leaves_the_one_before(tmp_path: Path) -> None:
    path = tmp_path / "last-word"
    with closing(LastWord.open(path)) as opened:
        opened.start_life(ChainPosition(1, "a"), None)
        opened.say(word(5))
    whole = path.read_bytes()
    place = len(whole) // 2
    for cut in (0, 9, 40):
        path.write_bytes(whole[:cut] + b"\0" * (place - cut) + whole[place:])  # of the newer one
        assert lives(path) == [(1, None)]
    path.write_bytes(b"\xff" * len(whole))
    assert lives(path) == []


def test_it_needs_no_more_room_later_and_the_longest_texts_fit(tmp_path: Path) -> None:
    path = tmp_path / "last-word"
    with closing(LastWord.open(path)) as opened:
        size = path.stat().st_size
        blocks = path.stat().st_blocks
        assert blocks * 512 >= size, "room on the disk is its own"
        opened.start_life(ChainPosition(1, "a"), None)
        for number in range(2, 6):
            opened.say(word(number, reason="𝄞" * LONGEST_REASON))
        large = word(6)
        details = {"jobs": ["x" * 100] * 1000}
        opened.say(large.model_copy(update={"entry": large.entry.model_copy(update={"details": details})}))
        assert path.stat().st_size == size
    assert lives(path)[0] == (1, 6)


def test_what_cannot_be_written_is_told_and_the_word_before_stays(tmp_path: Path) -> None:
    path = tmp_path / "last-word"
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    with closing(LastWord.open(path)) as opened:
        opened.start_life(ChainPosition(1, "a"), None)
        opened.say(word(5))
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, before[1]))
        try:
            with pytest.raises(OSError, match="too large"):
                opened.say(word(6))
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
        opened.say(word(7))
    assert lives(path)[0] == (1, 7)


def test_two_controllers_never_have_it_at_once(tmp_path: Path) -> None:
    path = tmp_path / "last-word"
    with closing(LastWord.open(path)):
        other = subprocess.run([sys.executable, "-c", OTHER, path], capture_output=True, text=True, check=False)
        assert "another controller of this station runs already" in other.stderr
    subprocess.run([sys.executable, "-c", OTHER, path], check=True)


def test_the_words_of_a_station_that_is_no_more_are_set_aside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "home"))
    when = datetime(2026, 1, 31, 12, tzinfo=UTC)
    file, server = SqliteFile(tmp_path / "station.sqlite"), address("postgresql://press@db.example/press")
    assert isinstance(server, PostgresqlServer)
    said = [(file, last_word_file(file)), *((server, last_word_file(server, name)) for name in (None, "press-a"))]
    other = last_word_file(SqliteFile(tmp_path / "other.sqlite"))
    for path in (*(path for _, path in said), other):
        with closing(LastWord.open(path)) as opened:
            opened.start_life(ChainPosition(1, "a"), None)
            opened.say(word(5))
    for place in (file, server):
        moved = set_aside(place, when)
        assert [path for path, _ in moved] == sorted(path for of, path in said if of == place)
        for path, kept in moved:
            assert kept.name == f"{path.name}-aside-20260131T120000"
            assert not path.exists()
            assert lives(kept)[0] == (1, 5), "it is kept as it was"
        assert set_aside(place, when) == []
    assert other.exists()


def test_the_word_of_a_controller_that_runs_is_not_set_aside(tmp_path: Path) -> None:
    file = SqliteFile(tmp_path / "station.sqlite")
    with closing(LastWord.open(last_word_file(file))) as opened:
        opened.start_life(ChainPosition(1, "a"), None)
        code = (
            "from datetime import datetime; from pathlib import Path; "
            "from sequence_planner.journal.last_accepted import set_aside; "
            "from sequence_planner.db.location import SqliteFile; "
            f"set_aside(SqliteFile(Path({str(file.path)!r})), datetime.now())"
        )
        other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        assert "another controller of this station runs already" in other.stderr
    assert last_word_file(file).exists()


def test_a_folder_that_cannot_be_written_to_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(StorageError, match=r"the last word of the station, cannot be opened"):
        LastWord.open(tmp_path / "file" / "last-word")


class _Station:
    """A station that is killed again and again; `accepted` is the record of the last stop that was answered."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / "last-word"
        self.database = Database.open(f"sqlite:///{folder}/station.sqlite")
        self.database.upgrade()

    def ended(self) -> LastEnding:
        with closing(LastWord.open(self._path)) as opened, self.database.reading() as connection:
            return ending(connection, opened.lives, BEGUN)

    async def live(self, away: int, stops: list[int], number: int) -> tuple[int | None, int]:
        """A life of so many records, of which the last `away` do not become durable; stops are at some of them. The
        record of the last stop, and of the last that is durable.
        """
        with closing(LastWord.open(self._path)) as opened:
            held = False
            writer = RunWriter(self.database, lambda: None, lambda _: not held)
            writer.write(BEGUN, 1.0, "{}")
            opened.start_life(writer.end, None)
            if away <= number:
                writer.start()
            stopped = None
            for each in range(number):
                if each == number - away:
                    await writer.until_durable(writer.end.number, 10.0)
                    held = True  # nothing more is written
                writer.write("mode-changed" if each in stops else "ticked", 1.0, "{}")
                if each in stops:
                    opened.say(word(writer.end.number))
                    stopped = writer.end.number
            if not held and away <= number:
                await writer.until_durable(writer.end.number, 10.0)
            durable = writer.durable
            await writer.close()
            return stopped, durable


LIVES = st.lists(
    st.tuples(st.integers(0, 6), st.lists(st.integers(0, 5), max_size=3), st.integers(0, 6)), min_size=1, max_size=4
)


@given(LIVES)
@examples(25)
def test_no_stop_that_was_accepted_is_ever_unknown_and_what_is_recorded_is_certain(
    drawn: list[tuple[int, list[int], int]],
) -> None:
    with TemporaryDirectory() as folder:
        station = _Station(Path(folder))
        assert station.ended() == LastEnding(True), "nothing was ever there"
        for away, stops, number in drawn:
            unknown = not station.ended().is_certain
            stopped, durable = asyncio.run(station.live(away, stops, number))
            ended = station.ended()
            if stopped is not None and stopped > durable:
                assert not ended.is_certain
                assert ended.word is not None and ended.word.number == stopped
            elif away <= number:
                assert ended.is_certain, "all that was accepted is recorded, and it began at rest if it had to"
            else:
                assert not (unknown and ended.is_certain), "nothing was recorded of this life"
        station.database.close()


def test_a_word_that_the_journal_never_comes_to_again_counts_once(tmp_path: Path) -> None:
    """As after a backup was restored: the file knows of later records than the journal."""
    station = _Station(tmp_path)
    asyncio.run(station.live(0, [], 1))
    with closing(LastWord.open(tmp_path / "last-word")) as opened:
        opened.start_life(ChainPosition(5000, "a"), None)
        opened.say(word(5100))
    ended = station.ended()
    assert ended.word is not None and ended.word.number == 5100
    for _ in range(3):
        asyncio.run(station.live(0, [], 1))
        ended = station.ended()
        assert (ended.is_certain, ended.word) == (True, None)
    station.database.close()
