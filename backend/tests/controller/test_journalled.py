"""What devices are told, and when: never before it is durable, and after a start of the controller only by a person."""

from __future__ import annotations

import asyncio
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.execution import SetMode, TakeControl, TakeStep
from sequence_planner.controller.commands.recovery import ConfirmEstimates, DecideOutputs
from sequence_planner.controller.features.automatic_start import go_on, start_when_alone
from sequence_planner.controller.previous_run import what_is_known
from sequence_planner.controller.views.station import OperationView
from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.db.location import SqliteFile
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.journal import run_journal
from sequence_planner.ros.transports.memory import MemoryNetwork
from support.cell import Arm, Bench, bench, cell
from support.databases import journal
from support.people import EVA
from support.waiting import until_async


@contextmanager
def locked(database: Database) -> Iterator[None]:
    """Nobody else can write meanwhile."""
    assert isinstance(database.place, SqliteFile)
    holder = sqlite3.connect(database.place.path, isolation_level=None)
    holder.execute("BEGIN IMMEDIATE")
    try:
        yield
    finally:
        holder.rollback()
        holder.close()


def value(on: Bench, name: str) -> object:
    return on.controller.execution.state[name]


async def at_home(on: Bench) -> None:
    await on.until(lambda: value(on, "arm.pose") == "home")


def test_nothing_is_commanded_as_long_as_it_is_not_in_the_journal_and_an_alarm_says_so() -> None:
    async def scenario() -> None:
        async with bench() as on:
            arm = Arm(on.network)
            with arm.saying("home"):
                await at_home(on)
                with locked(on.database):
                    await on.start()
                    await on.until(lambda: "unjournalled" in on.controller.view().alarms)
                    assert arm.commands == []
                    assert value(on, "arm.goto") == "home", "nor is anything started"
                await on.until(lambda: "out" in arm.commands)
                assert arm.commands[0] == "home", "what waited comes first"

    asyncio.run(scenario())


def test_every_command_was_durable_before_it_was_sent() -> None:
    async def scenario() -> None:
        async with bench() as on:
            arm = Arm(on.network)
            with arm.saying("home"):
                await at_home(on)
                await on.start()
                await on.until(lambda: "out" in arm.commands)
                with on.database.reading() as connection:
                    records = run_journal.after(connection, 0, 1000)
                assert any('"started":["arm.move(out)"]' in each.content for each in records), "it is there by then"

    asyncio.run(scenario())


async def commanded_out(network: MemoryNetwork, database: Database, arm: Arm) -> None:
    """A first life of the controller, which ends when it has sent the arm out and the arm has not gone yet."""
    with arm.saying("home"):
        async with bench(network, database) as on:
            await at_home(on)
            await on.start()
            await on.until(lambda: "out" in arm.commands)
    arm.commands.clear()


def test_after_a_start_nothing_is_published_and_a_person_decides_where_devices_would_move() -> None:
    async def scenario(database: Database) -> None:
        network = MemoryNetwork()
        arm = Arm(network)
        await commanded_out(network, database, arm)
        with arm.saying("home"):
            async with bench(network, database) as on:
                await at_home(on)
                assert value(on, "arm.goto") == "out", "it has come back"
                undecided = on.controller.view().undecided
                assert undecided["arm.goto"].value == "out"
                assert undecided["arm.goto"].quiet == ["home"]
                await on.controller.command(TakeControl(actor=EVA))
                with pytest.raises(CommandRefused) as refused:
                    await on.start()
                assert refused.value.slug == "outputs-unconfirmed"
                await asyncio.sleep(0.5)
                assert arm.commands == []
                await on.controller.command(
                    DecideOutputs(actor=EVA, reason="it stands at home", values={"arm.goto": "home"})
                )
                await asyncio.sleep(0.2)
                assert arm.commands == []
                await on.start()
                await until_async(lambda: arm.commands[:1] == ["home"])

    with journal() as database:
        asyncio.run(scenario(database))


def test_production_does_not_start_by_itself_while_something_is_undecided() -> None:
    """Nor is it tried again and again: each try would be in the record of who did what, for as long as it takes."""

    async def scenario(database: Database) -> None:
        network = MemoryNetwork()
        arm = Arm(network)
        await commanded_out(network, database, arm)
        tried: list[Command] = []
        with arm.saying("home"):
            async with bench(network, database) as on:

                async def handle(command: Command) -> None:
                    tried.append(command)
                    await on.controller.command(command)

                await at_home(on)
                starting = asyncio.create_task(start_when_alone(on.controller, handle, look_every=0.02))
                await asyncio.sleep(0.5)
                assert on.controller.execution.production is Production.WAITING
                assert tried == []
                await on.controller.command(TakeControl(actor=EVA))
                await on.controller.command(DecideOutputs(actor=EVA, reason="it stays", values={"arm.goto": "home"}))
                await asyncio.wait_for(starting, 5)
                assert len(tried) == 1

    with journal() as database:
        asyncio.run(scenario(database))


def test_after_a_takeover_production_goes_on_by_itself_once_nobody_has_anything_to_decide() -> None:
    async def scenario(database: Database) -> None:
        network = MemoryNetwork()
        arm = Arm(network)
        await commanded_out(network, database, arm)
        assert what_is_known(database, cell()[0].automaton).produced
        async with bench(network, database) as on:
            going_on = asyncio.create_task(go_on(on.controller, on.controller.command, "press-a", look_every=0.02))
            await asyncio.sleep(0.3)
            assert on.controller.execution.production is Production.WAITING, "the arm is not heard"
            with arm.saying("home"):
                await at_home(on)
                await asyncio.sleep(0.3)
                assert on.controller.execution.production is Production.WAITING, "it is not decided where it shall go"
                await on.controller.command(TakeControl(actor=EVA))
                await on.controller.command(DecideOutputs(actor=EVA, reason="it stays", values={"arm.goto": "home"}))
                await asyncio.wait_for(going_on, 5)
                assert on.controller.view().production == "started"
        async with bench(network, database):
            pass
        assert what_is_known(database, cell()[0].automaton).produced is False, "nobody has started it in its last life"

    with journal() as database:
        asyncio.run(scenario(database))


def test_what_came_back_and_moves_nothing_needs_no_decision() -> None:
    async def scenario(database: Database) -> None:
        network = MemoryNetwork()
        arm = Arm(network)
        await commanded_out(network, database, arm)
        with arm.saying("out"):
            async with bench(network, database) as on:
                await on.until(lambda: value(on, "arm.pose") == "out")
                assert on.controller.view().undecided == {}
                await on.start()
                await until_async(lambda: arm.commands[:1] == ["out"])

    with journal() as database:
        asyncio.run(scenario(database))


def test_estimates_come_back_unconfirmed_until_a_person_has_seen_them() -> None:
    async def scenario(database: Database) -> None:
        network = MemoryNetwork()
        with Arm(network).saying("home"):
            async with bench(network, database) as on:
                await at_home(on)
                execution = on.controller.execution
                execution.correct({"parts[left]": "full"}, "Eva", "seen", Timestamp.now())
            async with bench(network, database) as on:
                await at_home(on)
                view = on.controller.view()
                assert value(on, "parts[left]") == "full"
                assert view.unconfirmed
                belief = view.variables["parts[left]"].belief
                assert belief is not None
                assert belief.unconfirmed_since is not None
                seen: dict[str, bool | int | str] = {"parts[left]": "full", "parts[right]": "empty"}
                await on.controller.command(ConfirmEstimates(actor=EVA, values=seen, reason="I looked"))
                assert not on.controller.view().unconfirmed

    with journal() as database:
        asyncio.run(scenario(database))


def test_who_has_held_the_station_finds_it_held_after_a_start() -> None:
    async def scenario(database: Database) -> None:
        network = MemoryNetwork()
        with Arm(network).saying("home"):
            async with bench(network, database) as on:
                await on.controller.command(SetMode(actor=EVA, mode=Mode.HOLD))
            async with bench(network, database) as on:
                assert on.controller.view().mode is Mode.HOLD

    with journal() as database:
        asyncio.run(scenario(database))


def test_pausing_is_possible_while_nothing_can_be_journalled() -> None:
    async def scenario() -> None:
        async with bench() as on:
            with Arm(on.network).saying("home"):
                await at_home(on)
                await on.start()
                with locked(on.database):
                    await on.controller.command(SetMode(actor=EVA, mode=Mode.PAUSED))
                    assert on.controller.view().mode is Mode.PAUSED

    asyncio.run(scenario())


def test_holding_is_possible_while_nothing_can_be_journalled_and_starts_nothing_later() -> None:
    """The arm was about to be sent out: it must not go when the database is there again."""

    async def scenario() -> None:
        async with bench() as on:
            arm = Arm(on.network)
            with arm.saying("home"):
                await at_home(on)
                on.controller.execution.set_stepping(True)
                await on.start()
                await on.until(lambda: "home" in arm.commands and bool(on.controller.execution.plan.order.ahead), 90)
                await asyncio.sleep(0.2)
                with locked(on.database):
                    await on.controller.command(TakeControl(actor=EVA))
                    await on.controller.command(TakeStep(actor=EVA))
                    await on.until(lambda: value(on, "arm.goto") == "out")
                    await on.controller.command(SetMode(actor=EVA, mode=Mode.HOLD))
                    assert on.controller.view().mode is Mode.HOLD
                await asyncio.sleep(1)
                assert set(arm.commands) == {"home"}
                await on.controller.command(SetMode(actor=EVA, mode=Mode.AUTOMATIC))
                await until_async(lambda: "out" in arm.commands)

    asyncio.run(scenario())


def test_after_a_start_operations_are_as_far_as_they_were() -> None:
    """What was done was done then, and what is active has been so since it was asked for, not since the start."""

    def fetch(on: Bench) -> OperationView:
        return on.controller.view().operations["fetch(left)"]

    async def scenario(database: Database) -> None:
        network = MemoryNetwork()
        arm = Arm(network)
        before = Timestamp.now().epoch
        await commanded_out(network, database, arm)
        after = Timestamp.now().epoch
        async with bench(network, database) as on:
            assert (fetch(on).active, fetch(on).active_since) == (False, None), "production has not started"
            with arm.saying("home"):
                await at_home(on)
                await on.controller.command(TakeControl(actor=EVA))
                await on.controller.command(DecideOutputs(actor=EVA, reason="free", values={"arm.goto": "out"}))
                await on.start()
                await on.until(lambda: fetch(on).active)
            with arm.saying("out"):
                await on.until(lambda: fetch(on).completed == 1)
            done = fetch(on)
            assert done.began is not None
            assert done.ended is not None
            assert before < done.began < after < done.ended
        with arm.saying("out"):
            async with bench(network, database) as on:
                assert (fetch(on).completed, fetch(on).began, fetch(on).ended) == (1, done.began, done.ended)
                assert fetch(on).work == done.work

    with journal() as database:
        asyncio.run(scenario(database))
