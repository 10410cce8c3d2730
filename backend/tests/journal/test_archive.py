"""What is cut goes to the archive first, and is read from there as if it were still in the database."""

from __future__ import annotations

import gzip
import os
import random
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import text

from journal.acts import EVA
from journal.happened import content, happened, kind
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import audit, retention, run_journal
from sequence_planner.journal.archive import Archive, ArchiveError, ArchiveFullError, broken_at, verified
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.hash_chain import START
from sequence_planner.journal.hash_chain import broken_at as chain_broken_at
from sequence_planner.journal.retention import trim
from sequence_planner.journal.run_journal import RecordQuery, RunRecord
from sequence_planner.journal.verify import verify
from support.commands import command
from support.databases import with_tables
from support.examples import examples, rounds


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (made := tmp_path / "archive").mkdir()
    return made


def whole(database: Database, archive: Archive | None = None) -> list[RunRecord]:
    """All records, of which nothing may be missing or changed."""
    with database.reading() as connection:
        assert verify(connection).wrong == ()
        run = WholeRun(connection, archive)
        found = run.after(0, 100_000)
        assert chain_broken_at(found, START, run_journal.end(connection)) is None
    return found


def within(database: Database) -> list[int]:
    """The numbers of the records that are in the database."""
    with database.reading() as connection:
        return [each.number for each in run_journal.after(connection, 0, 100_000)]


def files(folder: Path) -> list[str]:
    return sorted(each.name for each in folder.iterdir())


def test_archive_and_database_are_the_whole_run(
    database: Database, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(retention, "MOST_IN_FILE", 25)
    happened(database, range(1, 96))
    before = whole(database)
    trimmed = trim(database, 78.0, EVA, folder)
    assert (trimmed.begin, trimmed.removed) == (69, 69)
    assert within(database) == list(range(70, 96))
    assert whole(database) == before
    made = files(folder)
    assert [each[:29] for each in made] == [f"run-{a:012}-{b:012}" for a, b in ((1, 19), (20, 39), (40, 59), (60, 69))]
    assert {(folder / each).stat().st_mode & 0o777 for each in made} == {0o600}
    with database.reading() as connection:
        acts = audit.read(connection)
    assert [each.entry.details["file"] for each in reversed(acts)] == made
    assert {(each.entry.action, each.entry.actor) for each in acts} == {("journal-trimmed", EVA)}


def test_a_file_is_the_export_and_can_be_verified_by_itself(database: Database, folder: Path) -> None:
    happened(database, range(1, 36))
    before = [each.line() for each in whole(database)]
    trim(database, 28.0, EVA, folder)
    [file] = folder.iterdir()
    first, *lines = gzip.decompress(file.read_bytes()).decode().splitlines()
    assert first.startswith('{"archive":"run","first":1,"last":19,"before":""')
    assert lines == before[:19]


@examples(25)
@given(data=st.data())
def test_whatever_is_cut_all_is_found_as_before(tmp_path_factory: pytest.TempPathFactory, data: st.DataObject) -> None:
    tmp = tmp_path_factory.mktemp("law")
    (folder := tmp / "archive").mkdir()
    database = Database.open(with_tables(tmp / "station.sqlite"))
    try:
        written = 0
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(retention, "MOST_IN_FILE", data.draw(st.integers(1, 40)))
            for _ in range(data.draw(st.integers(1, 4))):
                more = data.draw(st.integers(1, 60))
                happened(database, range(written + 1, written + more + 1))
                written += more
                trim(database, data.draw(st.floats(0, written + 1)), EVA, folder)
        found = whole(database)
        expected = [(each, kind(each), content(each)) for each in range(1, written + 1)]
        assert [(each.number, each.kind, each.content) for each in found] == expected
        with database.reading() as connection:
            run = WholeRun(connection)
            number, limit = data.draw(st.integers(0, written + 1)), data.draw(st.integers(1, 30))
            kinds = data.draw(st.sampled_from([None, {"snapshot"}, {"alarm", "snapshot"}]))
            chosen = [each for each in found if kinds is None or each.kind in kinds]
            assert run.after(number, limit, kinds) == [each for each in chosen if each.number > number][:limit]
            backwards = [each for each in reversed(chosen) if each.number < number]
            assert run.before(number, limit, kinds) == backwards[:limit]
            assert run.get(number) == next((each for each in found if each.number == number), None)
            moment = data.draw(st.floats(-1, written + 2))
            assert run.at(moment) == sum(each.time <= moment for each in found)
            sought = RecordQuery(texts=(f'"number": {number}'[:11],))
            fitting = [each for each in reversed(found) if sought.texts[0] in each.content.lower()]
            assert run.before(None, limit, None, sought) in ([], fitting[:limit])
            assert run.index.whole
    finally:
        database.close()


@pytest.mark.parametrize("harm", ["gone", "changed", "cut short", "another"])
def test_a_file_that_is_not_as_it_was_is_named(database: Database, database_url: str, folder: Path, harm: str) -> None:
    happened(database, range(1, 36))
    trim(database, 18.0, EVA, folder)
    trim(database, 28.0, EVA, folder)
    file = folder / files(folder)[0]
    content_ = file.read_bytes()
    match harm:
        case "gone":
            file.unlink()
        case "changed":
            file.write_bytes(content_[:60] + bytes([content_[60] ^ 1]) + content_[61:])
        case "cut short":
            file.write_bytes(content_[:-20])
        case "another":
            file.write_bytes(gzip.compress(gzip.decompress(content_).replace(b"bolt_pair", b"bolt_part")))
    with pytest.raises(ArchiveError, match=str(file)):
        whole(database, Archive())
    with database.reading() as connection:
        archive = Archive()
        assert WholeRun(connection, archive).get(15) is not None, "the other file is read all the same"
        [wrong] = verified(archive, archive.index(connection))
    assert wrong.startswith("records 1 to 9 of what happened: ")
    assert str(file) in wrong
    code, out, _ = command("journal", "--database", database_url, "--verify")
    assert (code, out.splitlines()) == (1, [wrong])
    (copies := folder.parent / "copies").mkdir()
    (copies / file.name).write_bytes(content_)
    code, out, _ = command("journal", "--database", database_url, "--verify", "--archive", copies)
    assert code == 0
    assert "archive: records 1 to 19 in 2 files, all as they were written" in out


def test_export_list_and_verify_read_the_archive(database: Database, database_url: str, folder: Path) -> None:
    happened(database, range(1, 36))
    _, before, _ = command("journal", "export", "--database", database_url)
    trim_ = ("journal", "trim", "--database", database_url, "--older-than", 1, "--archive-folder", folder)
    code, out, _ = command(*trim_)
    assert (code, out) == (
        0,
        f"29 records were taken out; the database begins with record 30; what was cut is in {folder}\n",
    )
    assert command("journal", "export", "--database", database_url)[1] == before
    [file] = folder.iterdir()
    code, out, _ = command("journal", "archive", "--database", database_url)
    assert out.startswith(f"{file}  0.0 MB  records 1 to 29, 1970-01-01 00:00:01 UTC to ")
    file.unlink()
    assert command("journal", "archive", "--database", database_url)[1].endswith("IS NOT THERE\n")


def test_what_was_cut_without_an_archive_is_gone_and_known_to_be(database: Database, folder: Path) -> None:
    happened(database, range(1, 36))
    trim(database, 18.0, EVA)
    trim(database, 28.0, EVA, folder)
    with database.reading() as connection:
        run = WholeRun(connection)
        assert (run.last_trimmed.number, run.index.whole) == (9, False)
        assert [each.number for each in run.after(0, 100)] == list(range(10, 36))


def test_a_damaged_record_is_not_cut(database: Database, folder: Path) -> None:
    happened(database, range(1, 36))
    with database.writing() as connection:
        sqlite = connection.dialect.name == "sqlite"
        connection.execute(text("DROP TRIGGER run_no_update" if sqlite else "ALTER TABLE run DISABLE TRIGGER ALL"))
        connection.execute(text("UPDATE run SET content = '{}' WHERE number = 7"))
    with pytest.raises(StorageError, match="record 7 of the journal is missing, or is not as it was written"):
        trim(database, 28.0, EVA, folder)
    assert (files(folder), len(within(database))) == ([], 35)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device is always full here")
def test_a_full_disk_loses_nothing_and_says_what_to_do(
    database: Database, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    happened(database, range(1, 36))
    opened = os.open

    def full(path: str | Path, flags: int, mode: int = 0o777) -> int:
        descriptor = opened(path, flags, mode)
        if str(path).endswith(".partial"):
            os.dup2(device := opened("/dev/full", os.O_WRONLY), descriptor)
            os.close(device)
        return descriptor

    with monkeypatch.context() as patch:
        patch.setattr(os, "open", full)
        with pytest.raises(ArchiveFullError, match=r"no room on the disk of .*archive: make room, .* nothing is lost"):
            trim(database, 28.0, EVA, folder)
    assert (files(folder), len(within(database))) == ([], 35)
    trim(database, 28.0, EVA, folder)
    assert len(whole(database)) == 35


def test_a_folder_that_is_gone_or_closed_says_so(database: Database, folder: Path) -> None:
    happened(database, range(1, 36))
    with pytest.raises(ArchiveError, match=r"there is no folder .*nowhere: make or mount it"):
        trim(database, 28.0, EVA, folder / "nowhere")
    assert len(within(database)) == 35


TRIM_UNTIL_KILLED = """
import os, signal, sys, time
from pathlib import Path
from journal.acts import EVA
from sequence_planner.journal import retention
from sequence_planner.db.database import Database
from support.databases import with_tables
retention.MOST_IN_FILE, retention._AT_ONCE, retention._BREATH = 40, 20, 0.001
for line in sys.stdin:
    older_than, seconds = map(float, line.split())
    began = time.monotonic()
    if (child := os.fork()) == 0:
        retention.trim(Database.open(sys.argv[1]), older_than, EVA, Path(sys.argv[2]))
        os._exit(0)
    if seconds:
        time.sleep(seconds)
        os.kill(child, signal.SIGKILL)  # of which nobody else has the number before it is waited for
    _, status = os.waitpid(child, 0)
    print(os.waitstatus_to_exitcode(status), time.monotonic() - began, flush=True)
"""
KILLS, MORE = rounds(12, 4), 150


def test_killed_at_any_moment_it_has_lost_nothing(database: Database, database_url: str, folder: Path) -> None:
    draw, written, killed = random.Random(23), 0, 0
    with subprocess.Popen(
        [sys.executable, "-c", TRIM_UNTIL_KILLED, database_url, str(folder)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={"PYTHONPATH": ":".join(sys.path)},
    ) as program:

        def trim_in_child(seconds: float) -> tuple[int, float]:
            """Trim what was added, killed after so many seconds unless that is 0: its exit code, how long it took."""
            assert program.stdin is not None
            assert program.stdout is not None
            program.stdin.write(f"{written - 10} {seconds}\n")
            program.stdin.flush()
            code, took = program.stdout.readline().split()
            return int(code), float(took)

        def more() -> list[RunRecord]:
            nonlocal written
            happened(database, range(written + 1, written + MORE + 1))
            written += MORE
            return whole(database)

        before = more()
        code, longest = trim_in_child(0.0)
        assert (code, whole(database)) == (0, before)
        for _ in range(4 * KILLS):
            before = more()
            code, took = trim_in_child(draw.uniform(0.001, longest))
            assert code in (0, -signal.SIGKILL)
            assert whole(database) == before, "also where it was faster than the kill"
            killed += code != 0
            if killed == KILLS:
                break
            if code == 0:
                longest = min(longest, took)  # the first may have had to wait for the processor
        assert program.stdin is not None
        program.stdin.close()
    assert killed == KILLS
    trim(database, written - 10, EVA, folder)
    retention.clear(database, folder)
    assert within(database) == list(range(written - 20, written + 1))
    assert whole(database) == before
    with database.reading() as connection:
        archive = Archive()
        index = archive.index(connection)
        assert [broken_at(archive, each) for each in index.segments] == [None] * len(index.segments)
        assert [each.file for each in index.segments] == files(folder), "nothing else is left"


def test_a_file_that_nothing_counts_goes_only_where_all_of_it_is_elsewhere(
    database: Database, tmp_path: Path, folder: Path
) -> None:
    happened(database, range(1, 96))
    trim(database, 38.0, EVA, folder)
    [counted] = folder.iterdir()
    another = Database.open(f"sqlite:///{tmp_path}/another.sqlite")
    try:
        another.upgrade()
        happened(another, [1])
        happened(another, range(2, 96))
        trim(another, 58.0, EVA, folder)
    finally:
        another.close()
    [double] = {*folder.iterdir()} - {counted}  # as of a pass that was killed, when more was old enough
    (strange := folder / "run-000000000001-000000000029-11111111.jsonl.gz").write_bytes(b"what is this")
    (part := folder / f".{double.name}.partial").write_bytes(b"half")
    retention.clear(database, folder)
    assert {*folder.iterdir()} == {counted, strange}
    assert not part.exists()
    assert len(whole(database)) == 95
