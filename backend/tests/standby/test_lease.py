"""The lease of the command, on a real server: no two stations ever hold it, and it never stays lying for ever."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from threading import Thread

import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule, run_state_machine_as_test
from sqlalchemy import delete, event, select

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.standby.lease import (
    EVERY,
    LASTS,
    LEASE,
    LEAVES,
    MARGIN,
    STANDBYS,
    Lease,
    LeaseKeeper,
    LeaseLostError,
    open_lease,
)
from support.postgresql import Server

MODEL, OTHER = "1" * 64, "2" * 64
NAMES = ("press-a", "press-b", "press-c")
SLOW = st.floats(0.0, 2 * LASTS)


class Now:
    """A clock that stands still unless somebody lets time pass."""

    def __init__(self) -> None:
        self.seconds = 1000.0

    def __call__(self) -> float:
        return self.seconds


@pytest.fixture
def url(postgresql: Server) -> str:
    made = postgresql.new_database()
    database = Database.open(made)
    database.upgrade()
    database.close()
    return made


@contextmanager
def stations(url: str, models: dict[str, str], now: Now) -> Iterator[dict[str, Lease]]:
    opened = {name: open_lease(url, name, model) for name, model in models.items()}
    for each in opened.values():
        each.clock = now
    try:
        yield opened
    finally:
        for each in opened.values():
            each.close()


def test_who_comes_first_holds_it_and_the_next_takes_it_once_it_was_not_renewed(url: str) -> None:
    now = Now()
    with stations(url, dict.fromkeys(NAMES[:2], MODEL), now) as opened:
        first, second = opened.values()
        assert first.try_to_take() and first.held
        assert not second.try_to_take()
        now.seconds += LASTS - MARGIN
        assert not first.held, "it may be taken soon"
        assert first.renew() and first.held
        assert not second.try_to_take(), "it was renewed meanwhile"
        now.seconds += LASTS
        assert second.try_to_take() and second.held and not first.held
        assert not first.renew() and not first.is_ours


def test_a_station_stands_by_once_it_sees_another_renew_it_and_not_for_one_that_may_be_dead(url: str) -> None:
    now = Now()
    models = {NAMES[0]: MODEL, NAMES[1]: MODEL, NAMES[2]: OTHER}
    with stations(url, models, now) as opened:
        first, second, third = opened.values()
        assert first.try_to_take() and not first.is_elsewhere
        assert not second.try_to_take() and not second.is_elsewhere, "it may have died long ago"
        assert first.renew()
        assert not second.try_to_take() and second.is_elsewhere
        assert not third.try_to_take() and third.is_elsewhere, "it must never take it"
        now.seconds += LASTS
        assert second.try_to_take() and not second.is_elsewhere


def test_what_is_being_written_under_it_is_written_before_somebody_else_takes_it(url: str) -> None:
    now = Now()
    with stations(url, dict.fromkeys(NAMES[:2], MODEL), now) as opened, closing(Database.open(url)) as database:
        first, second = opened.values()
        assert first.try_to_take()
        assert not second.try_to_take()
        with database.writing() as connection:
            assert first.fence(connection)
            assert first.renew(), "what is written does not keep it from being renewed"
            assert not second.try_to_take()
            now.seconds += LASTS
            taking = Thread(target=second.try_to_take)
            taking.start()
            taking.join(0.3)
            assert not second.is_ours
        taking.join()
        assert second.is_ours
        with database.writing() as connection:
            assert not first.fence(connection)
            assert second.fence(connection)
        second.release()
        with database.writing() as connection:
            assert not second.fence(connection)


def test_a_writer_that_stands_still_does_not_keep_the_lease_for_ever(url: str) -> None:
    now = Now()
    with stations(url, dict.fromkeys(NAMES[:2], MODEL), now) as opened, closing(Database.open(url)) as database:
        first, second = opened.values()
        assert first.try_to_take()
        assert not second.try_to_take()
        now.seconds += LASTS
        with pytest.raises(StorageError), database.writing() as connection:
            assert first.fence(connection)
            while not second.is_ours:
                with suppress(StorageError):
                    second.try_to_take()
            connection.execute(select(LEASE))


def test_who_lets_go_of_it_keeps_nobody_waiting(url: str) -> None:
    with stations(url, dict.fromkeys(NAMES[:2], MODEL), Now()) as opened:
        first, second = opened.values()
        assert first.try_to_take()
        assert not second.try_to_take()
        first.release()
        assert not first.held
        assert second.try_to_take()


def test_another_model_takes_nothing_over_and_says_why(url: str) -> None:
    now = Now()
    with stations(url, {"press-a": MODEL, "press-b": OTHER}, now) as opened:
        first, second = opened.values()
        assert first.try_to_take()
        assert not second.try_to_take()
        now.seconds += 10 * LASTS
        assert not second.try_to_take()
        assert second.hindrance == "press-a runs another model: deploy the same one here"


def test_after_a_deployment_the_station_where_that_was_comes_back_first(url: str) -> None:
    now = Now()
    models = {"press-a": MODEL, "press-b": MODEL}
    with stations(url, models, now) as opened, stations(url, {"press-a": OTHER}, now) as later:
        first, second = opened.values()
        assert first.try_to_take()
        first.release(deployed=True)
        assert not second.try_to_take()
        assert second.hindrance == "another model was deployed at press-a: deploy it here too"
        assert later["press-a"].try_to_take()
        assert not second.try_to_take()
        assert second.hindrance == "press-a runs another model: deploy the same one here"


def test_who_stands_by_is_known_as_long_as_it_says_so(url: str) -> None:
    now = Now()
    with stations(url, {"press-a": MODEL, "press-b": MODEL, "press-c": OTHER}, now) as opened:
        first, second, third = opened.values()
        assert first.try_to_take()
        for _ in range(3):
            second.stand_by()
            third.stand_by()
            now.seconds += EVERY
            standing_by = first.standing_by()
        assert standing_by == ("press-b",), "who has another model would not take over"
        now.seconds += LASTS
        assert first.standing_by() == ()


def test_it_takes_a_database_that_several_machines_can_share(url: str) -> None:
    with pytest.raises(StorageError, match="a hot standby takes a database of PostgreSQL"):
        open_lease("sqlite:////tmp/station.sqlite", "press-a", MODEL)


def test_a_database_that_is_away_is_told(tmp_path: object) -> None:
    lease = open_lease(f"postgresql://nobody@/nothing?host={tmp_path}", "press-a", MODEL)
    with pytest.raises(StorageError, match="cannot be reached"):
        lease.try_to_take()
    assert not lease.held


def test_who_is_cut_off_for_long_leaves_the_network_to_others(url: str, tmp_path: object) -> None:
    now = Now()
    away = open_lease(f"postgresql://nobody@/nothing?host={tmp_path}", NAMES[0], MODEL)
    with stations(url, {NAMES[0]: MODEL}, now) as opened:
        (lease,) = opened.values()
        assert lease.try_to_take()
        there, lease.engine = lease.engine, away.engine

        async def cut_off() -> None:
            keeper = LeaseKeeper(lease)
            keeper.start()
            lost = asyncio.create_task(keeper.lost())
            now.seconds += LASTS
            done, _ = await asyncio.wait({lost}, timeout=3 * EVERY)
            assert not done, "the database may come back before anybody else is there"
            now.seconds += LEAVES
            with pytest.raises(LeaseLostError):
                await asyncio.wait_for(lost, 10.0)
            await keeper.end(deployed=False, settled=False)

        asyncio.run(cut_off())
        lease.engine = there
    away.close()


def test_who_takes_it_knows_whether_all_is_recorded_only_from_who_held_it(url: str) -> None:
    now = Now()
    with stations(url, dict.fromkeys(NAMES[:2], MODEL), now) as opened:
        first, second = opened.values()
        assert first.try_to_take() and not first.settled_before, "nobody knows what was before"
        assert not second.try_to_take()
        first.release(settled=True)
        assert second.try_to_take() and second.settled_before
        second.release()
        assert first.try_to_take() and not first.settled_before, "not all was recorded"
        assert not second.try_to_take()
        now.seconds += LASTS
        assert second.try_to_take() and not second.settled_before, "it fell silent"


def test_a_process_beside_one_that_has_died_says_that_all_is_recorded_and_lets_others_come_first(url: str) -> None:
    now = Now()
    with (
        stations(url, dict.fromkeys(NAMES[:2], MODEL), now) as opened,
        stations(url, {NAMES[0]: MODEL}, now) as later,
    ):
        first, second = opened.values()
        assert first.try_to_take() and first.epoch == 1
        assert not second.try_to_take()
        again = later[NAMES[0]]
        again.settle(1)
        assert not again.try_to_take(), "others come first"
        assert second.try_to_take() and second.settled_before
        now.seconds += LASTS
        assert not again.try_to_take()
        now.seconds += LASTS
        assert again.try_to_take() and not again.settled_before


def test_that_is_heard_also_by_who_has_taken_it_already(url: str) -> None:
    now = Now()
    with (
        stations(url, dict.fromkeys(NAMES[:2], MODEL), now) as opened,
        stations(url, {NAMES[0]: MODEL}, now) as later,
    ):
        first, second = opened.values()
        assert first.try_to_take()
        assert not second.try_to_take()
        now.seconds += LASTS
        assert second.try_to_take() and not second.settled_before
        later[NAMES[0]].settle(1)
        assert second.renew() and second.settled_before


def test_who_alone_knows_what_is_not_recorded_does_not_wait(url: str) -> None:
    now = Now()
    with (
        stations(url, dict.fromkeys(NAMES[:2], MODEL), now) as opened,
        stations(url, {NAMES[0]: MODEL}, now) as later,
    ):
        first, second = opened.values()
        assert first.try_to_take()
        assert not second.try_to_take()
        again = later[NAMES[0]]
        again.unsettled = 1
        assert again.try_to_take() and again.epoch == 2
        assert not second.try_to_take()


def test_the_database_was_away_so_its_holder_has_all_the_time_again(url: str) -> None:
    now = Now()
    with stations(url, dict.fromkeys(NAMES[:2], MODEL), now) as opened:
        first, second = opened.values()
        assert first.try_to_take()
        assert not second.try_to_take()
        now.seconds += 10 * LASTS
        second.look_anew()
        assert not second.try_to_take()
        assert first.renew()


class Rivals(RuleBasedStateMachine):
    """Three stations, each of which may stand still at any statement for longer than a lease lasts."""

    url: str

    @initialize()
    def begin(self) -> None:
        self.now = Now()
        self.delays: list[float] = []
        self.context = stations(self.url, dict.fromkeys(NAMES, MODEL), self.now)
        self.opened = self.context.__enter__()
        for each in self.opened.values():
            event.listen(each.engine, "before_cursor_execute", self._late)
        with next(iter(self.opened.values())).engine.begin() as connection:
            connection.execute(delete(LEASE))
            connection.execute(delete(STANDBYS))

    def _late(self, *_: object) -> None:
        if self.delays:
            self.now.seconds += self.delays.pop()

    @rule(name=st.sampled_from(NAMES), delays=st.lists(SLOW, max_size=4))
    def step(self, name: str, delays: list[float]) -> None:
        """What its keeper does again and again."""
        lease, self.delays = self.opened[name], delays
        if lease.is_ours:
            lease.renew()
        else:
            lease.try_to_take()
        self.delays = []

    @rule(name=st.sampled_from(NAMES))
    def let_go(self, name: str) -> None:
        self.opened[name].release()

    @rule(seconds=SLOW)
    def wait(self, seconds: float) -> None:
        self.now.seconds += seconds

    @invariant()
    def at_most_one_holds_it(self) -> None:
        if hasattr(self, "opened"):
            assert sum(each.held for each in self.opened.values()) <= 1

    def teardown(self) -> None:
        if hasattr(self, "opened"):
            for each in self.opened.values():
                each.release()
            self.now.seconds += 2 * LASTS
            assert any(each.try_to_take() for each in self.opened.values()), "it must not stay lying for ever"
            self.context.__exit__(None, None, None)


def test_no_two_ever_hold_it(url: str) -> None:
    Rivals.url = url
    limits = settings(max_examples=25, stateful_step_count=20, deadline=None, suppress_health_check=list(HealthCheck))
    run_state_machine_as_test(Rivals, settings=limits)
