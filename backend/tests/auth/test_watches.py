"""Watches: paired with a code that works once, let in by somebody who sees them, and out when they are revoked."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest

from auth.situations import ADA, AGENT, BOTH, HERE, NOW, entries, everything_kept
from sequence_planner.auth import watches
from sequence_planner.auth import watches as pairing
from sequence_planner.auth.login import clear
from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.watches import DAY, PairingOffer, Watch, WatchState
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.journal.entry import Outcome


def offer(database: Database, name: str = "Watch 1", now: float = NOW) -> tuple[str, PairingOffer]:
    with database.writing() as connection:
        return pairing.offer(connection, name, "operator", ADA, now)


def redeem(database: Database, code: str, now: float = NOW, address: str = HERE) -> tuple[str, Watch] | str:
    try:
        return pairing.redeem(database, code, now, address=address, agent=AGENT)
    except IdentityRefused as refused:
        return f"{refused.status} {refused.slug}"


def waiting(database: Database, name: str = "Watch 1") -> tuple[str, Watch]:
    answer = redeem(database, offer(database, name)[0])
    assert not isinstance(answer, str)
    return answer


def confirm(database: Database, id: str, now: float = NOW) -> Watch | str:
    try:
        with database.writing() as connection:
            return watches.confirm(connection, id, ADA, now)
    except IdentityRefused as refused:
        return f"{refused.status} {refused.slug}"


def found(database: Database, token: str, now: float = NOW) -> Watch | None:
    with database.reading() as connection:
        return watches.find_watch(connection, token, now)


def states(database: Database, now: float) -> list[str]:
    with database.reading() as connection:
        return [watch.state.value for watch in watches.all_watches(connection, now)]


@BOTH
def test_from_the_offer_to_the_end(database: Database) -> None:
    code, made = offer(database)
    assert len(code) == 8
    assert code.isdigit()
    with database.reading() as connection:
        assert pairing.offers(connection, NOW) == [made]
    answer = redeem(database, f" {code[:4]} {code[4:]}", NOW + 100, "10.0.0.9")
    assert not isinstance(answer, str)
    token, watch = answer
    assert (watch.name, watch.resource, watch.state) == ("Watch 1", "operator", WatchState.WAITING)
    assert (watch.address, watch.agent, watch.paired_by) == ("10.0.0.9", AGENT, "Ada")
    assert found(database, token, NOW + 100) == watch
    with database.reading() as connection:
        assert pairing.offers(connection, NOW + 100) == []
    active = confirm(database, watch.id, NOW + 219)
    assert isinstance(active, Watch)
    assert (active.state, active.expires) == (WatchState.ACTIVE, NOW + 219 + 90 * DAY)
    assert found(database, token, NOW + 300) == active
    assert active.actor(HERE) == Actor(kind=ActorKind.WATCH, id=watch.id, name="Watch 1", address=HERE)
    assert found(database, token, active.expires - 1) is not None
    assert found(database, token, active.expires) is None
    assert states(database, active.expires) == ["expired"]
    recorded = [entries(database, f"watch-{each}")[0] for each in ("offered", "redeemed", "confirmed")]
    assert [entry.actor.kind for entry in recorded] == [ActorKind.PERSON, ActorKind.WATCH, ActorKind.PERSON]
    assert {entry.subject for entry in recorded} == {"watch Watch 1"}
    kept = everything_kept(database)
    assert token not in kept
    assert f"'{code}'" not in kept


def test_a_code_works_once(database: Database) -> None:
    code, _ = offer(database)
    assert not isinstance(redeem(database, code), str)
    assert redeem(database, code) == "403 wrong-code"
    assert len(states(database, NOW)) == 1


@BOTH
def test_a_code_works_once_also_for_many_at_once(database: Database) -> None:
    code, _ = offer(database)
    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(lambda each: redeem(database, code, address=f"10.0.0.{each}"), range(16)))
    assert answers.count("403 wrong-code") == 15


def test_a_code_works_for_two_minutes(database: Database) -> None:
    code, _ = offer(database)
    assert redeem(database, code, NOW + 120) == "403 wrong-code"
    assert not isinstance(redeem(database, code, NOW + 119), str)


def test_an_offer_is_withdrawn(database: Database) -> None:
    code, made = offer(database)
    with database.writing() as connection:
        pairing.withdraw_offer(connection, made.id, ADA, NOW)
    assert redeem(database, code) == "403 wrong-code"
    for id in (made.id, "", "\0", "\ud800"):
        with pytest.raises(IdentityRefused) as refused, database.writing() as connection:
            pairing.withdraw_offer(connection, id, ADA, NOW)
        assert (refused.value.slug, refused.value.status) == ("no-offer", 404)


def test_few_guesses_are_allowed_from_one_address(database: Database) -> None:
    code, _ = offer(database)
    wrong = f"{(int(code) + 1) % 10**8:08}"
    assert [redeem(database, wrong, address="10.0.0.6") for _ in range(5)] == ["403 wrong-code"] * 5
    assert redeem(database, code, address="10.0.0.6") == "429 too-many-attempts"
    assert not isinstance(redeem(database, code, address="10.0.0.7"), str)
    assert len([each for each in entries(database, "watch-redeemed") if each.outcome is Outcome.REFUSED]) == 5


@BOTH
def test_few_guesses_are_allowed_altogether(database: Database) -> None:
    code, _ = offer(database)
    wrong = f"{(int(code) + 1) % 10**8:08}"
    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(lambda each: redeem(database, wrong, address=f"10.0.0.{each}"), range(60)))
    assert sorted(map(str, answers)) == ["403 wrong-code"] * 30 + ["429 too-many-attempts"] * 30
    assert redeem(database, code, address="10.0.1.0") == "429 too-many-attempts"
    assert not isinstance(redeem(database, code, NOW + 61, "10.0.1.0"), str)


@pytest.mark.parametrize("code", ["", "0", "1234567", "123456789", "\0", "\ud800", "١٢٣٤٥٦٧٨"])
def test_what_is_no_code(database: Database, code: str) -> None:
    offer(database)
    assert redeem(database, code) == "403 wrong-code"


def test_a_watch_that_nobody_lets_in_is_gone_after_two_minutes(database: Database) -> None:
    token, watch = waiting(database)
    assert found(database, token, NOW + 119) is not None
    assert found(database, token, NOW + 120) is None
    assert states(database, NOW + 120) == []
    assert confirm(database, watch.id, NOW + 120) == "404 no-wearable"
    offer(database, now=NOW + 120)


def test_a_watch_is_let_in_once(database: Database) -> None:
    _, watch = waiting(database)
    assert isinstance(confirm(database, watch.id), Watch)
    assert confirm(database, watch.id) == "409 wearable-not-waiting"
    for id in ("", "0" * 16, "\0", "\ud800"):
        assert confirm(database, id) == "404 no-wearable"


@pytest.mark.parametrize("confirmed", [False, True])
def test_a_watch_is_revoked_at_once_and_for_good(database: Database, confirmed: bool) -> None:
    token, watch = waiting(database)
    other, _ = waiting(database, "Watch 2")
    if confirmed:
        confirm(database, watch.id)
    for _ in range(2):
        with database.writing() as connection:
            watches.revoke(connection, watch.id, ADA, NOW)
    assert found(database, token) is None
    assert found(database, other) is not None
    assert confirm(database, watch.id) == "409 wearable-not-waiting"
    assert len(entries(database, "watch-revoked")) == 1


@BOTH
def test_no_two_watches_of_one_name(database: Database) -> None:
    def refused(name: str) -> bool:
        with pytest.raises(IdentityRefused) as answer:
            offer(database, name)
        return (answer.value.slug, answer.value.status) == ("wearable-exists", 409)

    _, made = offer(database)
    assert refused("watch 1 ")
    with database.writing() as connection:
        pairing.withdraw_offer(connection, made.id, ADA, NOW)
    _, watch = waiting(database)
    assert refused("Watch  1")
    confirm(database, watch.id)
    assert refused("WATCH 1")
    with database.writing() as connection:
        watches.revoke(connection, watch.id, ADA, NOW)
    waiting(database)


def test_few_offers_at_once(database: Database) -> None:
    for number in range(10):
        offer(database, f"Watch {number}")
    with pytest.raises(IdentityRefused) as refused:
        offer(database, "Watch 10")
    assert (refused.value.slug, refused.value.status) == ("too-many-offers", 409)
    offer(database, "Watch 10", NOW + 120)


def test_use_is_noted_at_most_once_a_minute(database: Database) -> None:
    _, watch = waiting(database)

    def last_seen(now: float) -> float:
        with database.writing() as connection:
            watches.seen(connection, watch.id, now)
            (only,) = watches.all_watches(connection, now)
            return only.last_seen

    assert [watch.due(NOW + pause) for pause in (59, 60)] == [False, True]
    assert [last_seen(NOW + pause) for pause in (59, 60)] == [NOW, NOW + 60]


def test_watches_that_work_no_more_are_listed_for_ninety_days(database: Database) -> None:
    _, watch = waiting(database)
    waiting(database, "Watch 2")
    confirm(database, watch.id)
    with database.writing() as connection:
        watches.revoke(connection, watch.id, ADA, NOW)
        clear(connection, NOW + 90 * DAY - 1)
    assert states(database, NOW + 1000) == ["revoked"]
    with database.writing() as connection:
        clear(connection, NOW + 90 * DAY)
    assert states(database, NOW + 1000) == []
