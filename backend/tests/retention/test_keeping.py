"""A pass of retention: by age and by size, what it leaves for later, and the limits of the archive."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import func, insert, select

from journal.acts import EVA
from journal.happened import happened
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import retention as cutting
from sequence_planner.journal import run_journal
from sequence_planner.journal.archive import Archive, verified
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.run_journal import RUN
from sequence_planner.journal.verify import verify
from sequence_planner.mes.tables import JOB_LEDGER
from sequence_planner.retention import retention
from sequence_planner.retention.retention import Blocks, Done, RetentionTask, run_blocks
from sequence_planner.retention.settings import MOST_DAYS, Retention
from support.examples import examples

KB = 1e-6  # GB
Pass = Callable[..., Done]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (made := tmp_path / "archive").mkdir()
    return made


@pytest.fixture
def pass_of(database: Database, database_url: str, folder: Path) -> Pass:
    """Does a pass with these settings; records are of 1970, and so are old unless these are not by age."""

    def done(everything: bool = True, **settings: float) -> Done:
        told = Retention(folder=folder, **settings)  # type: ignore[arg-type]
        return retention.do(RetentionTask(database_url, None, told, EVA, everything))

    return done


def first(database: Database) -> int:
    with database.reading() as connection:
        assert verify(connection).wrong == ()
        archive = Archive()
        assert list(verified(archive, archive.index(connection))) == []
        return run_journal.last_trimmed(connection).number + 1


def test_what_is_too_old_goes_and_little_waits_for_more(database: Database, pass_of: Pass) -> None:
    happened(database, range(1, 96))
    assert pass_of(journal_days=MOST_DAYS) == Done()
    assert first(database) == 1
    assert pass_of().records == 89
    assert first(database) == 90
    happened(database, range(96, 98))
    assert pass_of(everything=False) == Done()


def test_what_is_too_much_goes_whatever_its_age(database: Database, pass_of: Pass) -> None:
    happened(database, range(1, 1001))
    with database.reading() as connection:
        before = run_blocks(connection)
        content: int = connection.execute(select(func.sum(func.length(RUN.c.content)))).scalar_one()
    assert before.size == pytest.approx(content + 1000 * 150, rel=0.02)
    pass_of(journal_days=MOST_DAYS, journal_gb=60 * KB)
    with database.reading() as connection:
        after = run_blocks(connection)
        assert 55e3 < after.size <= 60e3 + 10 * 250
        assert len(WholeRun(connection).after(0, 2000)) == 1000


def test_what_is_still_to_be_read_for_orders_stays(database: Database, pass_of: Pass) -> None:
    happened(database, range(1, 96))
    with database.writing() as connection:
        connection.execute(insert(JOB_LEDGER), {"id": 1, "number": 45, "content": "{}"})
    pass_of()
    assert first(database) == 40


def test_one_pass_does_so_much_and_says_that_there_is_more(
    database: Database, pass_of: Pass, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cutting, "MOST_IN_FILE", 10)
    monkeypatch.setattr(retention, "MOST_FILES", 3)
    happened(database, range(1, 96))
    assert [(pass_of().more, first(database)) for _ in range(4)] == [(True, 30), (True, 60), (True, 90), (False, 90)]


def test_files_that_are_too_old_or_too_many_go_and_that_is_known(
    database: Database, pass_of: Pass, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cutting, "MOST_IN_FILE", 20)
    happened(database, range(1, 96))
    pass_of()
    files = sorted(folder.iterdir())
    size = sum(each.stat().st_size for each in files)
    assert pass_of(archive_gb=(size - 1) / 1e9).removed == 1
    assert sorted(folder.iterdir()) == files[1:]
    begin = int(files[0].name[17:29])
    with database.reading() as connection:
        run = WholeRun(connection)
        assert (run.last_trimmed.number, run.index.whole) == (begin, False)
        assert [each.number for each in run.after(0, 100)] == list(range(begin + 1, 96))
    assert first(database) == 90
    assert pass_of(archive_days=1.0).removed == len(files) - 1
    assert list(folder.iterdir()) == []
    assert first(database) == 90


def test_a_folder_that_is_gone_is_said_and_nothing_is_cut(database: Database, pass_of: Pass, folder: Path) -> None:
    happened(database, range(1, 96))
    folder.rmdir()
    with pytest.raises(StorageError, match="make or mount it"):
        pass_of()
    assert first(database) == 1


@examples(200)
@given(
    st.integers(0, 10**6),
    st.lists(st.floats(1, 1e5), min_size=1, max_size=16),
    st.floats(0, 1e12),
    st.data(),
)
def test_as_much_as_fits_stays(begin: int, means: list[float], most: float, data: st.DataObject) -> None:
    starts = sorted(data.draw(st.sets(st.integers(begin + 1, begin + 10**7), min_size=len(means), max_size=len(means))))
    starts[0] = begin + 1
    end = data.draw(st.integers(starts[-1], begin + 10**7 + 1))
    blocks = Blocks(begin, end, tuple(zip(starts, means, strict=True)))
    number = blocks.last_fitting(most)
    assert begin <= number <= end
    assert blocks.behind(number) <= most or number == end
    assert number == begin or blocks.behind(number - 1) > most
