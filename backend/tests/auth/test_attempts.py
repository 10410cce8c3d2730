"""How often somebody may be wrong."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import HealthCheck, given, settings
from sqlalchemy import delete

from auth.situations import BOTH, NOW
from core.choices import Choices, made_by
from sequence_planner.auth import rate_limit
from sequence_planner.auth.login import clear
from sequence_planner.auth.rate_limit import AttemptKind, Counter, of_address, of_name
from sequence_planner.auth.tables import ATTEMPTS
from sequence_planner.db.database import Database
from support.examples import examples


def wrong(database: Database, counters: tuple[Counter, ...], now: float) -> float:
    """An attempt that is wrong, if it is let through; else the seconds to wait."""
    with database.writing() as connection:
        waiting = rate_limit.waiting(connection, counters, now)
        if waiting is None:
            rate_limit.count(connection, counters, now)
            return 0.0
        return waiting.seconds


def right(database: Database, counters: tuple[Counter, ...], now: float) -> None:
    assert wrong(database, counters, now) == 0.0
    with database.writing() as connection:
        rate_limit.forgive(connection, counters)


@BOTH
def test_a_name_waits_after_five_in_a_row_and_then_ever_longer(database: Database) -> None:
    eva, now = (of_name("Eva"),), NOW
    for _ in range(4):
        right(database, eva, now)
        assert wrong(database, eva, now) == 0
    right(database, eva, now)
    for _ in range(5):
        assert wrong(database, eva, now) == 0
    for wait in (60, 120, 240, 480, 900, 900, 900):
        assert wrong(database, eva, now) == wait
        assert wrong(database, (of_name("  EVA "),), now + wait - 1) == 1
        now += wait
        assert wrong(database, eva, now) == 0
    right(database, eva, now + 900)
    assert wrong(database, eva, now + 900) == 0


def test_an_address_waits_until_the_minute_is_over(database: Database) -> None:
    here = (of_address(AttemptKind.ADDRESS, "10.0.0.7"),)
    for number in range(10):
        assert wrong(database, here, NOW + number) == 0
    assert wrong(database, here, NOW + 20) == 40
    assert wrong(database, (of_address(AttemptKind.ADDRESS, "10.0.0.8"),), NOW + 20) == 0
    assert wrong(database, here, NOW + 60) == 0


def test_knowing_one_password_gives_no_more_attempts_at_others(database: Database) -> None:
    here, own = of_address(AttemptKind.ADDRESS, "10.0.0.7"), of_name("Mallory")
    for number in range(10):
        assert wrong(database, (here, of_name(f"person {number}")), NOW) == 0
        if number < 9:
            right(database, (here, own), NOW)
    assert wrong(database, (here, own), NOW) == 60


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("2001:db8:1:2::1", "2001:db8:1:2:ffff::9", True),
        ("2001:db8:1:2::1", "2001:db8:1:3::1", False),
        ("::ffff:10.0.0.7", "10.0.0.7", True),
        ("fe80::1%eth0", "fe80::2%eth1", True),
        ("10.0.0.7", "10.0.0.8", False),
        ("", "", True),
        ("testclient", "10.0.0.7", False),
    ],
)
def test_addresses_of_one_host(one: str, other: str, same: bool) -> None:
    assert (of_address(AttemptKind.ADDRESS, one) == of_address(AttemptKind.ADDRESS, other)) is same


@BOTH
def test_however_many_try_at_once_no_more_are_let_through(database: Database) -> None:
    eva = (of_name("Eva"),)
    with ThreadPoolExecutor(16) as pool:
        waits = list(pool.map(lambda _: wrong(database, eva, NOW), range(40)))
    assert waits.count(0.0) == 5
    addresses = [(of_address(AttemptKind.ADDRESS, "10.0.0.7"), of_name(f"person {number}")) for number in range(40)]
    with ThreadPoolExecutor(16) as pool:
        waits = list(pool.map(lambda each: wrong(database, each, NOW), addresses))
    assert waits.count(0.0) == 10


def test_a_clock_that_was_put_back_locks_nobody_out(database: Database) -> None:
    eva = (of_name("Eva"),)
    for _ in range(5):
        wrong(database, eva, NOW)
    assert wrong(database, eva, NOW - 30) == 90
    assert wrong(database, eva, NOW - 86400) == 0


def test_old_ones_are_forgotten(database: Database) -> None:
    wrong(database, (of_name("Eva"),), NOW)
    with database.writing() as connection:
        clear(connection, NOW + rate_limit.FORGOTTEN_AFTER)
        assert connection.execute(ATTEMPTS.select()).first() is not None
        clear(connection, NOW + rate_limit.FORGOTTEN_AFTER + 1)
        assert connection.execute(ATTEMPTS.select()).first() is None


def a_day(choices: Choices) -> list[tuple[float, str, bool]]:
    """Attempts in order: how long after the one before, at whose name, and whether right."""
    return [
        (float(choices.pick((0, 1, 59, 60, 61, 300))), choices.pick(("Eva", "Adam")), choices.chance(4))
        for _ in range(choices.number(1, 25))
    ]


@given(made_by(a_day))
@settings(examples(60), suppress_health_check=list(HealthCheck))
def test_limits_by_their_definition(database: Database, day: list[tuple[float, str, bool]]) -> None:
    with database.writing() as connection:
        connection.execute(delete(ATTEMPTS))
    here = of_address(AttemptKind.ADDRESS, "10.0.0.7")
    now, row, until = NOW, dict.fromkeys(("Eva", "Adam"), 0), dict.fromkeys(("Eva", "Adam"), 0.0)
    begun, inside = NOW, 0
    for pause, name, is_right in day:
        now += pause
        begun, inside = (begun, inside) if now < begun + 60 else (now, 0)
        let_through = now >= until[name] and inside < 10
        counters = (here, of_name(name))
        assert (wrong(database, counters, now) == 0) is let_through
        if not let_through:
            continue
        if is_right:
            with database.writing() as connection:
                rate_limit.forgive(connection, counters)
            row[name], until[name] = 0, 0.0
        else:
            begun = now if inside == 0 else begun
            inside += 1
            row[name] += 1
            until[name] = now + min(60 * 2 ** (row[name] - 5), 900) if row[name] >= 5 else 0.0
