"""What is still to be delivered: nothing is forgotten, and nothing is tried without end."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import select

from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.journal import audit
from sequence_planner.mes import events
from sequence_planner.mes.events import EventKind
from sequence_planner.mes.order import OrderRefused
from sequence_planner.mes.webhooks import deliveries
from sequence_planner.mes.webhooks import endpoints as webhooks
from sequence_planner.mes.webhooks.deliveries import Pace
from sequence_planner.mes.webhooks.endpoints import MOST_WEBHOOKS, Seal, UnreadableSecretError, Webhook, key_file
from sequence_planner.mes.webhooks.tables import WEBHOOK_DELIVERIES, WEBHOOKS
from support.databases import with_tables
from support.examples import examples

PACE = Pace(first=2.0, longest=60.0, longest_hold=8.0, attempts=3)
URL = "https://mes.example/events"


def happen(database: Database, number: int = 1, kind: EventKind = EventKind.ENDED) -> None:
    with database.writing() as connection:
        for _ in range(number):
            events.append(connection, kind, "order-1", 1.0, {"made": 1})


def make(
    database: Database, kinds: Sequence[EventKind] = (), after: int | None = None, now: float = 0.0
) -> tuple[str, Webhook]:
    with database.writing() as connection:
        return webhooks.make(connection, Seal(key_file(database.place)), "MES", URL, kinds, after, SYSTEM, now)


def found(database: Database, id: str) -> Webhook:
    with database.reading() as connection:
        return webhooks.get(connection, id)


def attempt(database: Database, id: str, now: float, trouble: str = "") -> int | None:
    """Look at new events and try what is due, as the deliverer does; which event that was."""
    with database.writing() as connection:
        if id not in deliveries.waiting(connection, now):
            return None
        deliveries.queue(connection, id, now)
        due = deliveries.due(connection, id, now)
        if due is None:
            return None
        if trouble:
            deliveries.failed(connection, due, trouble, PACE, now)
        else:
            deliveries.delivered(connection, due, now)
        return due.event.number


def test_what_happens_is_delivered_in_order_to_who_asked_for_it(database: Database) -> None:
    happen(database, 2)
    _, new = make(database)
    _, all_of_it = make(database, after=0)
    _, aborted = make(database, kinds=[EventKind.ABORTED], after=99)
    assert (new.position, all_of_it.position, aborted.position) == (2, 0, 2)
    happen(database, 2)
    happen(database, kind=EventKind.ABORTED)
    assert [attempt(database, new.id, 1.0) for _ in range(4)] == [3, 4, 5, None]
    assert [attempt(database, all_of_it.id, 1.0) for _ in range(6)] == [1, 2, 3, 4, 5, None]
    assert [attempt(database, aborted.id, 1.0) for _ in range(2)] == [5, None]
    after = found(database, all_of_it.id)
    assert (after.delivered, after.waiting, after.given_up, after.last_delivered, after.trouble) == (5, 0, 0, 1.0, None)


def test_what_fails_holds_the_others_back_a_while_and_is_given_up_in_the_end(database: Database) -> None:
    _, webhook = make(database)
    happen(database, 2)
    assert attempt(database, webhook.id, 10.0, "no") == 1
    held = found(database, webhook.id)
    assert (held.failures, held.waiting, held.trouble) == (1, 2, "no")
    assert 11.0 <= held.held_until <= 12.0
    assert attempt(database, webhook.id, held.held_until - 0.01) is None
    assert attempt(database, webhook.id, 12.0) == 1, "the oldest that is due"
    assert found(database, webhook.id).failures == 0
    now = 12.0
    for number in range(3):
        now += 100
        assert attempt(database, webhook.id, now, f"no {number}") == 2
    dead = found(database, webhook.id)
    assert (dead.waiting, dead.given_up, dead.failures) == (0, 1, 3)
    assert attempt(database, webhook.id, now + 1000) is None
    with database.reading() as connection:
        (letter,) = deliveries.dead_letters(connection, webhook.id, 0, 10)
        assert deliveries.dead_letters(connection, webhook.id, letter.event.number, 10) == []
    assert (letter.event.number, letter.attempts, letter.died, letter.trouble) == (2, 3, now, "no 2")


def test_what_was_given_up_can_be_sent_again(database: Database) -> None:
    _, webhook = make(database)
    happen(database, 3)
    for _ in range(9):
        for step in range(9):
            attempt(database, webhook.id, 100.0 * step, "no")
    assert found(database, webhook.id).given_up == 3
    with database.writing() as connection:
        assert deliveries.send_again(connection, webhook.id, [2, 7], SYSTEM, 2000.0) == 1
        assert deliveries.send_again(connection, webhook.id, [2], SYSTEM, 2000.0) == 0
    assert attempt(database, webhook.id, 2000.0) == 2
    with database.writing() as connection:
        assert deliveries.send_again(connection, webhook.id, None, SYSTEM, 2000.0) == 2
    assert [attempt(database, webhook.id, 2000.0) for _ in range(3)] == [1, 3, None]


def test_no_more_wait_than_there_is_room_for_and_none_is_lost(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(deliveries, "MOST_WAITING", 2)
    _, webhook = make(database)
    happen(database, 5)
    assert attempt(database, webhook.id, 1.0) == 1
    assert (found(database, webhook.id).position, found(database, webhook.id).waiting) == (2, 1)
    assert [attempt(database, webhook.id, 1.0) for _ in range(5)] == [2, 3, 4, 5, None]


def test_one_that_is_gone_is_told_of_nothing(database: Database) -> None:
    _, webhook = make(database)
    happen(database, 2)
    attempt(database, webhook.id, 1.0, "no")
    with database.reading() as connection:
        due = deliveries.due(connection, webhook.id, 100.0)
    assert due is not None
    with database.writing() as connection:
        webhooks.remove(connection, webhook.id, SYSTEM, 2.0)
        deliveries.failed(connection, due, "it was under way", PACE, 3.0)
        deliveries.delivered(connection, due, 3.0)
        deliveries.queue(connection, webhook.id, 3.0)
        assert connection.execute(select(WEBHOOK_DELIVERIES)).all() == []
        assert deliveries.waiting(connection, 1e9) == []
        assert webhooks.everyone(connection) == []
        for id in (webhook.id, "x'; --", ""):
            with pytest.raises(OrderRefused, match="no webhook with this id"):
                webhooks.get(connection, id)
        recorded = [each.entry for each in audit.read(connection)]
    assert [each.action for each in recorded] == ["webhook-deleted", "webhook-created"]
    assert "mes.example" in str(recorded[1]), "it is recorded where it leads"
    assert "/events" not in str(recorded), "a path may be a secret, and more people read the journal than webhooks"


def test_there_are_not_too_many(database: Database) -> None:
    for _ in range(MOST_WEBHOOKS):
        make(database)
    with pytest.raises(OrderRefused, match="Delete one"):
        make(database)


def test_a_secret_is_of_no_use_without_the_key_beside_the_database(database: Database, tmp_path: Path) -> None:
    secret, webhook = make(database)
    other, _ = make(database)
    assert secret != other
    file = key_file(database.place)
    assert file.stat().st_mode & 0o777 == 0o600
    with database.reading() as connection:
        sealed = connection.execute(select(WEBHOOKS.c.secret).where(WEBHOOKS.c.id == webhook.id)).scalar_one()
    assert secret not in sealed
    seal = Seal(file)
    assert seal.open(sealed, webhook.id) == secret
    for box, whose in ((seal, "another"), (Seal(tmp_path / "none"), webhook.id)):
        with pytest.raises(UnreadableSecretError):
            box.open(sealed, whose)
    moved = file.rename(tmp_path / "moved.key")
    assert Seal(file).open(Seal(file).seal("x", "y"), "y") == "x", "a new key is made"
    with pytest.raises(UnreadableSecretError, match="another key"):
        Seal(file).open(sealed, webhook.id)
    moved.rename(file)


@examples(12)
@given(st.lists(st.tuples(st.integers(0, 3), st.booleans(), st.floats(0.0, 30.0)), max_size=40))
def test_every_event_is_delivered_once_or_given_up(steps: list[tuple[int, bool, float]]) -> None:
    taken: Counter[int] = Counter()
    with (
        tempfile.TemporaryDirectory() as folder,
        closing(Database.open(with_tables(Path(folder) / "s.sqlite"))) as database,
    ):
        _, webhook = make(database)
        now, happened = 0.0, 0
        for number, fails, seconds in steps:
            now += seconds
            if number:
                happen(database, number)
                happened += number
            event = attempt(database, webhook.id, now, "no" if fails else "")
            if event is not None and not fails:
                taken[event] += 1
        with database.reading() as connection:
            dead = [each.event.number for each in deliveries.dead_letters(connection, webhook.id, 0, 1000)]
            assert all(each.attempts == PACE.attempts for each in deliveries.dead_letters(connection, webhook.id, 0, 9))
        now += 1000
        while (event := attempt(database, webhook.id, now)) is not None:
            taken[event] += 1
        assert sorted([*taken.elements(), *dead]) == list(range(1, happened + 1))


def test_what_fails_again_is_tried_ever_later_and_not_all_at_once() -> None:
    pace = Pace()
    waits = [[pace.after(failures, pace.longest) for _ in range(50)] for failures in range(1, 40)]
    assert 1.0 <= min(waits[0]) < max(waits[0]) <= 2.0
    assert len(set(waits[5])) > 40
    assert all(1800.0 <= each <= 3600.0 for each in waits[-1])
