"""Orders in the database: what is asked for again and again is found by an index, however many there were."""

from __future__ import annotations

import random
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from sqlalchemy import Connection, event

from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.mes import orders, responses
from sequence_planner.mes.order import LONGEST_TITLE, JobOrder, OrderCommand, OrderContent, OrderState, title_of

ASKED: dict[str, Callable[[Connection], object]] = {
    "how many": orders.count_open,
    "open": orders.open_orders,
    "all": lambda connection: orders.page(connection, None, 5, 10),
    "ended": lambda connection: orders.page(connection, OrderState.ENDED, 5, 10),
    "responses": lambda connection: responses.page(connection, 5, 10),
    "newest responses": lambda connection: responses.latest(connection, None, 10),
}


def plans(connection: Connection, asked: Callable[[Connection], object]) -> list[str]:
    """How SQLite finds what is asked for."""
    said: list[tuple[str, tuple[object, ...]]] = []

    def note(connection: object, cursor: object, statement: str, parameters: tuple[object, ...], *_: object) -> None:
        said.append((statement, parameters))

    event.listen(connection, "before_cursor_execute", note)
    asked(connection)
    event.remove(connection, "before_cursor_execute", note)
    rows = [connection.exec_driver_sql(f"EXPLAIN QUERY PLAN {text}", values).all() for text, values in said]
    return [row.detail for each in rows for row in each if "job_" in row.detail]


def test_what_was_cleared_is_not_looked_at(tmp_path: Path) -> None:
    with closing(Database.open(f"sqlite:///{tmp_path}/orders.sqlite")) as database:
        database.upgrade()
        with database.reading() as connection:
            for name, asked in ASKED.items():
                found = plans(connection, asked)
                assert found, name
                assert all("_shown" in each for each in found), found


def test_the_response_to_an_order_that_is_cleared_is_not_shown(database: Database) -> None:
    with database.writing() as connection:
        for id in ("one", "two"):
            orders.store(connection, OrderContent(work_master="a"), SYSTEM, 1.0, id=id, start=True)
            orders.command(connection, id, OrderCommand.ABORT, SYSTEM, None, 2.0)
        orders.command(connection, "one", OrderCommand.CLEAR, SYSTEM, None, 3.0)
        assert [each.job_order for each in responses.page(connection, 0, 10)] == ["two"]
        assert [each.job_order for each in responses.latest(connection, None, 10)] == ["two"]
        assert responses.get(connection, "one") is None


def test_of_orders_that_are_known_only_what_has_changed_is_read(database: Database) -> None:
    chance = random.Random(1)
    known: list[JobOrder] = []
    for number in range(40):
        with database.writing() as connection:
            content = OrderContent(work_master="a", priority=number)
            orders.store(connection, content, SYSTEM, 1.0, id=f"order-{number}", start=chance.random() < 0.5)
            for each in chance.sample(known, min(len(known), 3)):
                given = each.allowed[0] if chance.random() < 0.8 else chance.choice(each.allowed)
                orders.command(connection, each.id, given, SYSTEM, None, 2.0)
        before = {each.number: each for each in known}
        with database.reading() as connection:
            known = orders.open_orders(connection, known)
            assert known == orders.open_orders(connection)
        kept = [each for each in known if before.get(each.number) == each]
        assert all(each is before[each.number] for each in kept)
    assert 5 < len(known) < 35


def test_however_many_orders_there_are_all_are_read(database: Database) -> None:
    with database.writing() as connection:
        for number in range(501):
            orders.store(connection, OrderContent(work_master="a"), SYSTEM, 1.0, id=str(number), start=True)
    with database.reading() as connection:
        assert [each.id for each in orders.open_orders(connection)] == [str(number) for number in range(501)]


def test_an_order_is_called_by_its_number_and_by_what_it_is_where_the_number_was_drawn() -> None:
    assert title_of("D13-4711", "Engine D13K 540") == "D13-4711"
    assert title_of("00f1a2b3c4d5e6f7", " Engine D13K 540 ") == "Engine D13K 540 · e6f7"
    assert title_of("00f1a2b3c4d5e6f7", " ") == "e6f7"
    assert len(title_of("00f1a2b3c4d5e6f7", "long" * 100)) == LONGEST_TITLE
