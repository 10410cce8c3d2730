"""Events reach whoever asked for them, whatever the other end and the server go through."""

from __future__ import annotations

import asyncio
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from mes.receiver import Receiver, breaks_off, hangs, receiving, status
from mes.test_webhook_deliveries import found, happen
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.mes import events
from sequence_planner.mes.webhooks import deliveries, delivery
from sequence_planner.mes.webhooks import endpoints as webhooks
from sequence_planner.mes.webhooks.deliveries import Pace
from sequence_planner.mes.webhooks.delivery import Deliverer, Patience, Sender
from sequence_planner.mes.webhooks.endpoints import Seal, Webhook, key_file
from sequence_planner.mes.webhooks.targets import Targets
from support.places import TESTS
from support.waiting import PATIENCE, until

PACE = Pace(first=0.02, longest=0.1, longest_hold=0.05, attempts=7)


@pytest.fixture
def receiver() -> Iterator[Receiver]:
    with receiving() as receiver:
        yield receiver


@pytest.fixture(autouse=True)
def _soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(delivery, "LOOK_EVERY", 0.02)


def made(database: Database, receiver: Receiver) -> tuple[str, Webhook]:
    with database.writing() as connection:
        seal = Seal(key_file(database.place))
        return webhooks.make(connection, seal, "MES", receiver.url(), (), None, SYSTEM, time.time())


IMPATIENT = Patience(connecting=0.5, reading=0.3, all=0.5)  # with whoever never answers


def deliver(
    database: Database, *receivers: Receiver, until: Callable[[], bool], patience: Patience = Patience()
) -> None:
    """Deliver until that is so."""

    async def live() -> None:
        targets = Targets(frozenset(("127.0.0.1", each.port) for each in receivers), loopback=True)
        sender = Sender(targets, patience)
        running = asyncio.create_task(Deliverer(database, sender, PACE).run())
        try:
            async with asyncio.timeout(PATIENCE):
                while not until():
                    assert not running.done()
                    await asyncio.sleep(0.01)
        finally:
            running.cancel()
            with suppress(asyncio.CancelledError):
                await running

    asyncio.run(live())


def idle(database: Database, *ids: str) -> bool:
    with database.reading() as connection:
        newest = events.last(connection)
    return all(each.position == newest and not each.waiting for each in (found(database, id) for id in ids))


def test_every_event_arrives_signed_though_the_other_end_fails_again_and_again(
    database: Database, receiver: Receiver
) -> None:
    over = threading.Event()
    receiver.answers += [status(500), breaks_off, hangs(over), status(302), status(200), status(503)]
    secret, webhook = made(database, receiver)
    happen(database, 6)
    deliver(database, receiver, until=lambda: idle(database, webhook.id), patience=IMPATIENT)
    over.set()
    told = [each.verified(secret) for each in receiver.received]
    assert {each["number"] for each in told} == set(range(1, 7))
    assert {each["job_order"] for each in told} == {"order-1"}
    assert len(receiver.received) >= 6 + 5
    assert found(database, webhook.id).delivered == 6


def test_one_that_takes_nothing_holds_up_no_other_and_has_its_dead_letters(
    database: Database, receiver: Receiver
) -> None:
    with receiving() as refusing:
        refusing.answers += [status(410)] * 14
        secret, good = made(database, receiver)
        _, bad = made(database, refusing)
        happen(database, 2)
        deliver(database, receiver, refusing, until=lambda: idle(database, good.id, bad.id))
        assert sorted(receiver.numbers) == [1, 2]
        assert Counter(refusing.numbers) == {1: 7, 2: 7}
        after = found(database, bad.id)
        assert (after.given_up, after.delivered, after.trouble) == (2, 0, "it was answered with status 410")
        with database.writing() as connection:
            deliveries.send_again(connection, bad.id, None, SYSTEM, time.time())
        deliver(database, receiver, refusing, until=lambda: idle(database, bad.id))
        assert found(database, bad.id).delivered == 2
    assert receiver.received[0].verified(secret)


def test_a_secret_that_cannot_be_read_holds_events_and_gives_none_up(database: Database, receiver: Receiver) -> None:
    secret, webhook = made(database, receiver)
    happen(database)
    file = key_file(database.place)
    moved = file.rename(file.with_suffix(".moved"))
    deliver(database, receiver, until=lambda: found(database, webhook.id).failures > 2)
    assert receiver.received == []
    assert found(database, webhook.id).trouble == "its secret cannot be read; it is written in the server's log why"
    moved.rename(file)
    deliver(database, receiver, until=lambda: idle(database, webhook.id))
    receiver.received[0].verified(secret)


@contextmanager
def another(url: str, receiver: Receiver) -> Iterator[subprocess.Popen[bytes]]:
    """A process that delivers."""
    command = [sys.executable, "-m", "mes.delivering", url, "127.0.0.1", str(receiver.port)]
    with subprocess.Popen(command, cwd=TESTS, stdout=subprocess.DEVNULL) as process:
        try:
            yield process
        finally:
            process.kill()


def test_after_kill_9_it_goes_on_where_it_was_and_loses_nothing(tmp_path: Path, receiver: Receiver) -> None:
    url = f"sqlite:///{tmp_path}/station.sqlite"
    database = Database.open(url)
    database.upgrade()
    secret, webhook = made(database, receiver)
    happen(database, 12)
    over = threading.Event()
    receiver.answers += [status(200)] * 5 + [hangs(over)]
    with another(url, receiver) as first:
        until(lambda: len(receiver.received) == 6)
        first.kill()  # while the sixth is under way
        first.wait()
    with another(url, receiver):
        until(lambda: idle(database, webhook.id))
    over.set()
    heard = Counter(each.verified(secret)["number"] for each in receiver.received)
    assert set(heard) == set(range(1, 13))
    assert {number for number, times in heard.items() if times > 1} == {6}
    assert found(database, webhook.id).delivered == 12
    database.close()
