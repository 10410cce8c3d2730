"""Sessions: good from the sign-in to the end, and not a moment longer."""

from __future__ import annotations

import pytest

from auth.situations import ADA, AGENT, BOTH, HERE, NOW, add, entries, everything_kept, is_good, signed_in
from sequence_planner.auth import sessions
from sequence_planner.auth.login import clear
from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.tables import SESSIONS
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.db.database import Database

HOUR = 3600.0


@BOTH
def test_a_session_says_who_acts_and_from_where(database: Database) -> None:
    eva = add(database, "Eva")
    token, opened = signed_in(database, eva)
    with database.reading() as connection:
        found = sessions.find_session(connection, token, NOW + 1)
    assert found == opened
    assert (opened.person, opened.address, opened.agent, opened.expires) == (eva, HERE, AGENT, NOW + 12 * HOUR)
    assert opened.actor("10.0.0.9") == Actor(
        kind=ActorKind.PERSON, id=eva.id, name="Eva", session=opened.session, address="10.0.0.9"
    )


def test_only_a_hash_of_the_token_is_kept(database: Database) -> None:
    token, opened = signed_in(database, add(database, "Eva"))
    assert len(token) == 43
    assert opened.session in everything_kept(database)
    assert token not in everything_kept(database)


@BOTH
def test_other_tokens_are_worth_nothing(database: Database) -> None:
    token, opened = signed_in(database, add(database, "Eva"))
    with database.reading() as connection:
        stored = connection.execute(SESSIONS.select()).one()
    for other in ("", token[:-1], token + "A", token.swapcase(), opened.session, stored.token_hash, "\0", "\ud800"):
        assert not is_good(database, other)


def test_it_ends_after_an_hour_without_use_and_after_twelve_in_any_case(database: Database) -> None:
    token, opened = signed_in(database, add(database, "Eva"))
    assert is_good(database, token, NOW + HOUR - 1)
    assert not is_good(database, token, NOW + HOUR)
    now = NOW
    while now < NOW + 12 * HOUR - 1000:
        now += 1000
        assert is_good(database, token, now)
        with database.writing() as connection:
            sessions.seen(connection, opened.session, now)
    assert is_good(database, token, NOW + 12 * HOUR - 1)
    assert not is_good(database, token, NOW + 12 * HOUR)


def test_one_of_a_clock_that_was_far_ahead_is_not_good_for_all_time(database: Database) -> None:
    person = add(database, "Eva")
    ahead, _ = signed_in(database, person, NOW + 365 * 86400.0)
    nearly, _ = signed_in(database, person, NOW + 600.0)
    assert not is_good(database, ahead)
    assert is_good(database, nearly)


def test_use_is_noted_at_most_once_a_minute_and_wakes_nothing_that_is_over(database: Database) -> None:
    token, opened = signed_in(database, add(database, "Eva"))

    def last_seen(now: float) -> float:
        with database.writing() as connection:
            sessions.seen(connection, opened.session, now)
            return float(connection.execute(SESSIONS.select()).one().last_seen)

    assert [opened.due(NOW + pause) for pause in (0, 59, 60)] == [False, False, True]
    assert last_seen(NOW + 59) == NOW
    assert last_seen(NOW + 60) == NOW + 60
    assert last_seen(NOW + 60 + HOUR) == NOW + 60
    assert not is_good(database, token, NOW + 60 + HOUR)


def test_signing_out(database: Database) -> None:
    eva = add(database, "Eva")
    (token, opened), (other, _) = signed_in(database, eva), signed_in(database, eva)
    for _ in range(2):
        with database.writing() as connection:
            sessions.end_session(connection, opened.session, opened.actor(HERE), NOW)
    assert not is_good(database, token)
    assert is_good(database, other)
    (entry,) = entries(database, "sign-out")
    assert (entry.actor, entry.subject) == (opened.actor(HERE), f"session {opened.session}")


def test_ending_all_sessions_of_a_person_but_one(database: Database) -> None:
    eva, adam = add(database, "Eva"), add(database, "Adam")
    hers = [signed_in(database, eva) for _ in range(3)]
    his, _ = signed_in(database, adam)
    with database.writing() as connection:
        assert sessions.end_sessions_of(connection, eva.id, ADA, NOW, but=hers[1][1].session) == 2
        assert sessions.live_sessions(connection, eva.id, NOW) == [hers[1][1]]
        assert sessions.live_counts(connection, NOW) == {eva.id: 1, adam.id: 1}
        assert sessions.end_sessions_of(connection, eva.id, ADA, NOW) == 1
    assert not is_good(database, hers[1][0])
    assert is_good(database, his)
    assert [entry.details["sessions_ended"] for entry in entries(database, "sessions-ended")] == [1, 2]


@BOTH
def test_a_person_has_at_most_twenty(database: Database) -> None:
    eva, adam = add(database, "Eva"), add(database, "Adam")
    his, _ = signed_in(database, adam)
    first, opened = signed_in(database, eva)
    second, _ = signed_in(database, eva, NOW + 1)
    with database.writing() as connection:
        sessions.seen(connection, opened.session, NOW + 100)
    for number in range(19):
        signed_in(database, eva, NOW + 200 + number)
    with database.reading() as connection:
        assert len(sessions.live_sessions(connection, eva.id, NOW + 300)) == 20
    assert [is_good(database, token, NOW + 300) for token in (first, second, his)] == [True, False, True]


def test_rows_of_sessions_that_are_over_are_cleared_away(database: Database) -> None:
    eva = add(database, "Eva")
    signed_in(database, eva)
    token, _ = signed_in(database, eva, NOW + 10)
    with database.writing() as connection:
        clear(connection, NOW + HOUR)
        assert len(connection.execute(SESSIONS.select()).all()) == 1
    assert is_good(database, token, NOW + HOUR)


def test_what_a_browser_calls_itself_is_kept_as_far_as_it_shows(database: Database) -> None:
    eva = add(database, "Eva")
    with database.writing() as connection:
        _, opened = sessions.open_session(
            connection, eva, NOW, kind=ActorKind.PERSON, address="x\0" * 500, agent="\ud800\n" * 500
        )
    assert (len(opened.agent), len(opened.address)) == (200, 200)
    assert opened.agent == "\ufffd" * 200


def test_an_act_in_a_session_that_has_ended_since_is_refused(database: Database) -> None:
    _, opened = signed_in(database, add(database, "Eva"))
    by = opened.actor(HERE)
    with database.writing() as connection:
        sessions.require_live(connection, by, NOW)
        sessions.require_live(connection, ADA, NOW)  # acts in no session
        sessions.end_session(connection, opened.session, ADA, NOW)
        with pytest.raises(IdentityRefused) as refused:
            sessions.require_live(connection, by, NOW)
    assert (refused.value.slug, refused.value.status) == ("signed-out", 401)
