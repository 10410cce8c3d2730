"""Job orders that are over long enough go to the archive; nothing else does, and what was missed is said."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from sqlalchemy import update

from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import archive, audit
from sequence_planner.mes import events, orders, responses
from sequence_planner.mes.events import EventKind
from sequence_planner.mes.order import OrderCommand, OrderContent, OrderRefused
from sequence_planner.mes.responses import nothing_made
from sequence_planner.mes.retention import CUT, cut_orders, order_files, wrong_files
from sequence_planner.mes.tables import JOB_BEGIN
from sequence_planner.mes.webhooks import deliveries
from sequence_planner.mes.webhooks import endpoints as webhooks
from sequence_planner.mes.webhooks.endpoints import Seal, key_file

OLD, LATER, NOW = 100.0, 500.0, 1000.0


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (made := tmp_path / "archive").mkdir()
    return made


def store(database: Database, id: str, now: float) -> None:
    with database.writing() as connection:
        orders.store(connection, OrderContent(work_master="engine"), SYSTEM, now, id=id, start=False)


def end(database: Database, id: str, now: float) -> None:
    """Abort an order, and write its response."""
    with database.writing() as connection:
        orders.command(connection, id, OrderCommand.ABORT, SYSTEM, None, now)
        if responses.get(connection, id) is None:
            responses.write(connection, nothing_made(orders.get(connection, id)), now)


def filled(database: Database) -> None:
    """Three that were over long ago, one that is not over, and one that was over lately."""
    for id in ("a", "b", "c"):
        store(database, id, OLD)
        end(database, id, OLD + 1)
    with database.writing() as connection:
        orders.command(connection, "c", OrderCommand.CLEAR, SYSTEM, None, LATER)
    store(database, "open", OLD + 2)
    store(database, "late", OLD + 3)
    end(database, "late", LATER)


def ids(database: Database) -> list[str]:
    with database.reading() as connection:
        return [each.id for each in orders.page(connection, None, 0, 100)]


def test_what_is_over_long_enough_goes_and_nothing_else(database: Database, folder: Path) -> None:
    filled(database)
    with database.reading() as connection:
        told = events.after(connection, 0, 100)
        made = responses.page(connection, 0, 100)
    assert cut_orders(database, 400.0, SYSTEM, NOW, folder) == 6
    assert ids(database) == ["open", "late"]
    [file] = folder.iterdir()
    header, *lines = map(json.loads, archive.lines(file))
    assert (header["orders"], header["events"], header["responses"]) == (3, 6, 3)
    assert [line["order"]["id"] for line in lines[:3]] == ["a", "b", "c"]
    archived = [line["event"]["number"] for line in lines if "event" in line]
    with database.reading() as connection:
        kept = [each.number for each in events.after(connection, 0, 100)]
        assert archived + kept == [each.number for each in told]
        assert [each.job_order for each in responses.page(connection, 0, 100)] == ["late"]
        [act] = audit.read(connection, action=CUT)
        assert act.entry.details["file"] == file.name
        assert [each.file for each in order_files(connection)] == [file.name]
        assert list(wrong_files(order_files(connection))) == []
    assert len(made) == 3, "that of what was cleared is not shown, and is archived all the same"
    assert cut_orders(database, 400.0, SYSTEM, NOW, folder) == 0
    file.write_bytes(file.read_bytes()[:-3])
    with database.reading() as connection:
        [wrong] = wrong_files(order_files(connection))
    assert wrong.startswith(f"3 job orders: {file} is damaged")


def test_numbers_and_ids_never_come_again(database: Database, folder: Path) -> None:
    for id in ("a", "b"):
        store(database, id, OLD)
        end(database, id, OLD)
    assert cut_orders(database, 400.0, SYSTEM, NOW, folder)
    with database.reading() as connection:
        assert (
            events.last(connection),
            events.last_trimmed_event(connection),
            responses.last_trimmed_response(connection),
        ) == (4, 4, 2)
    with pytest.raises(OrderRefused) as refused:
        store(database, "a", NOW)
    assert refused.value.slug == "job-order-exists"
    store(database, "c", NOW)
    end(database, "c", NOW)
    with database.reading() as connection:
        assert orders.get(connection, "c").number == 3
        assert [each.number for each in events.after(connection, 0, 10)] == [5, 6]
        assert [each.number for each in responses.page(connection, 0, 10)] == [3]
        with pytest.raises(OrderRefused) as gone:
            orders.get(connection, "a")
    assert (gone.value.slug, gone.value.status) == ("job-order-gone", 410)


def test_who_has_read_less_than_is_kept_is_told(database: Database, folder: Path) -> None:
    filled(database)
    cut_orders(database, 400.0, SYSTEM, NOW, folder)
    with database.reading() as connection:
        begin = events.last_trimmed_event(connection)
        events.require_kept(connection, begin)
        responses.require_kept(connection, responses.last_trimmed_response(connection))
        with pytest.raises(OrderRefused, match=f"the events after {begin}") as gone:
            events.require_kept(connection, begin - 1)
        assert (gone.value.slug, gone.value.status) == ("events-gone", 410)
        with pytest.raises(OrderRefused, match="Read those after 3"):
            responses.require_kept(connection, 2)
    with database.writing() as connection, pytest.raises(OrderRefused, match="kept no more"):
        seal = Seal(key_file(database.place))
        webhooks.make(connection, seal, "MES", "https://mes.example/", [], begin - 1, SYSTEM, NOW)


def test_what_a_webhook_was_not_told_is_said(database: Database, folder: Path) -> None:
    with database.writing() as connection:
        seal = Seal(key_file(database.place))
        _, hook = webhooks.make(connection, seal, "MES", "https://mes.example/", [], 0, SYSTEM, OLD)
    for number in range(5):
        with database.writing() as connection:
            events.append(connection, EventKind.MODE_CHANGED, None, OLD if number < 3 else LATER, {})
    with database.writing() as connection:
        deliveries.queue(connection, hook.id, OLD)
    cut_orders(database, 400.0, SYSTEM, NOW, folder)
    with database.reading() as connection:
        found = webhooks.get(connection, hook.id)
        due = deliveries.due(connection, hook.id, NOW)
        [act] = audit.read(connection, action=CUT)
    assert found.trouble == "3 events were not delivered in time, and are kept no more"
    assert act.entry.details["undelivered"] == {"MES": 3}
    assert due is not None
    assert due.event.number == 4, "what is kept is still delivered"


def test_little_waits_for_more_and_nothing_goes_without_a_file(database: Database, folder: Path) -> None:
    filled(database)
    assert cut_orders(database, 400.0, SYSTEM, NOW, folder, least_until=OLD - 1) == 0
    with pytest.raises(StorageError, match="make or mount it"):
        cut_orders(database, 400.0, SYSTEM, NOW, folder / "nowhere")
    assert len(ids(database)) == 4
    assert cut_orders(database, 400.0, SYSTEM, NOW, None) == 6
    assert list(folder.iterdir()) == []


def test_two_at_once_take_nothing_out_twice(database: Database, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    filled(database)

    def meanwhile(*_: object) -> object:
        with database.writing() as connection:
            connection.execute(update(JOB_BEGIN).values(events=1))
        return written(*_)  # type: ignore[arg-type]

    written = archive.write
    monkeypatch.setattr(archive, "write", meanwhile)
    with pytest.raises(StorageError, match="somebody else"):
        cut_orders(database, 400.0, SYSTEM, NOW, folder)
    assert len(ids(database)) == 4
