"""Commands are recorded before their effect, with who and why; what cannot be is refused, but for pausing."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from sqlalchemy import text

from sequence_planner.controller.commands.audit import CommandAudit
from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.execution import SetMode, StartProduction, TakeControl
from sequence_planner.controller.commands.tasks import AcknowledgeTask
from sequence_planner.controller.views.station import TaskView
from sequence_planner.db.database import Database
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.journal.audit import read
from sequence_planner.journal.entry import Outcome, Record
from support.cell import Bench, bench
from support.people import ADAM, EVA

TASK = TaskView(
    revision=1,
    resource="operator",
    ability="operator.place",
    title="Place",
    text="",
    created=0.0,
    next_moves=[],
    movers=[],
    begins=[],
    instruction=None,
    problem=None,
)


@pytest.fixture
def database(tmp_path: Path) -> Database:
    database = Database.open(f"sqlite:///{tmp_path}/station.sqlite")
    database.upgrade()
    return database


def records(database: Database) -> list[Record]:
    """All, in order."""
    with database.reading() as connection:
        return read(connection)[::-1]


def recorded(database: Database, scenario: Callable[[CommandAudit], Awaitable[None]]) -> list[str | None]:
    """Run the scenario; the troubles it was told of."""
    told: list[str | None] = []

    async def whole() -> None:
        recording = CommandAudit(database, told.append)
        await scenario(recording)
        await recording.close()

    asyncio.run(whole())
    return told


def nothing() -> dict[str, TaskView]:
    return {}


def test_a_command_is_recorded_before_its_effect_and_with_its_outcome(database: Database) -> None:
    async def act(command: Command) -> None:
        (before,) = records(database)
        assert before.entry.outcome is Outcome.REQUESTED

    async def scenario(recording: CommandAudit) -> None:
        command = SetMode(actor=EVA, mode=Mode.AUTOMATIC, reason="the cell is clear")
        await recording.carry_out(command, nothing, act)

    recorded(database, scenario)
    asked, done = records(database)
    assert (asked.entry.action, asked.entry.details) == ("set-mode", {"mode": "automatic"})
    assert (asked.entry.actor, asked.entry.reason) == (EVA, "the cell is clear")
    assert asked.entry.actor.address == "127.0.0.1"
    assert (done.entry.outcome, done.entry.about) == (Outcome.DONE, asked.number)


def test_a_refusal_and_a_failure_are_outcomes_too(database: Database) -> None:
    async def refuse(command: Command) -> None:
        raise CommandRefused("production-started", "It is.")

    async def fail(command: Command) -> None:
        raise RuntimeError("a fault")

    async def scenario(recording: CommandAudit) -> None:
        with pytest.raises(CommandRefused, match="It is"):
            await recording.carry_out(StartProduction(actor=EVA), nothing, refuse)
        with pytest.raises(RuntimeError):
            await recording.carry_out(StartProduction(actor=EVA), nothing, fail)

    recorded(database, scenario)
    outcomes = [record.entry.outcome for record in records(database)]
    assert outcomes == [Outcome.REQUESTED, Outcome.REFUSED, Outcome.REQUESTED, Outcome.FAILED]
    assert records(database)[1].entry.details["because"] == "production-started"


def test_what_was_acknowledged_is_told_in_words(database: Database) -> None:
    async def act(command: Command) -> None:
        return

    async def scenario(recording: CommandAudit) -> None:
        await recording.carry_out(AcknowledgeTask(actor=ADAM, task="a-1", revision=1), lambda: {"a-1": TASK}, act)

    recorded(database, scenario)
    entry = records(database)[0].entry
    assert (entry.subject, entry.details["title"], entry.details["revision"]) == ("task a-1", "Place", 1)


def test_what_cannot_be_recorded_is_refused_and_pausing_is_not(database: Database) -> None:
    done: list[str] = []

    async def act(command: Command) -> None:
        done.append(command.kind)

    async def scenario(recording: CommandAudit) -> None:
        with database.writing() as connection:
            connection.execute(text("ALTER TABLE audit RENAME TO elsewhere"))
        with pytest.raises(CommandRefused) as refused:
            await recording.carry_out(TakeControl(actor=EVA), nothing, act)
        assert (refused.value.slug, refused.value.status) == ("not-recorded", 503)
        assert done == []
        await recording.carry_out(SetMode(actor=EVA, mode=Mode.PAUSED), nothing, act)
        assert done == ["set-mode"]
        with database.writing() as connection:
            connection.execute(text("ALTER TABLE elsewhere RENAME TO audit"))
        await recording.carry_out(TakeControl(actor=EVA), nothing, act)

    told = recorded(database, scenario)
    assert told[0] is not None
    assert "audit" in told[0]
    assert told[-1] is None
    assert done == ["set-mode", "take-control"]


def test_a_pause_does_not_wait_for_the_database(database: Database) -> None:
    async def act(command: Command) -> None:
        return

    async def scenario(recording: CommandAudit) -> None:
        with database.writing():  # nobody else can write meanwhile
            async with asyncio.timeout(1):
                await recording.carry_out(SetMode(actor=EVA, mode=Mode.PAUSED), nothing, act)

    recorded(database, scenario)
    (record,) = records(database)
    assert (record.entry.action, record.entry.outcome) == ("set-mode", Outcome.DONE)


def test_nothing_that_was_asked_for_before_a_pause_happens_after_it(database: Database) -> None:
    done: list[str] = []

    async def act(command: Command) -> None:
        done.append(command.mode if isinstance(command, SetMode) else command.kind)

    async def scenario(recording: CommandAudit) -> None:
        asked = (
            SetMode(actor=EVA, mode=Mode.AUTOMATIC),
            StartProduction(actor=EVA),
            AcknowledgeTask(actor=ADAM, task="a-1", revision=1),
        )
        with database.writing():  # nobody else can write meanwhile
            waiting = [asyncio.create_task(recording.carry_out(each, nothing, act)) for each in asked]
            await asyncio.sleep(0)
            await recording.carry_out(SetMode(actor=ADAM, mode=Mode.PAUSED), nothing, act)
        for each in waiting[:2]:
            with pytest.raises(CommandRefused) as refused:
                await each
            assert (refused.value.slug, refused.value.status) == ("command-overtaken", 409)
        await waiting[2]
        await recording.carry_out(asked[0], nothing, act)

    recorded(database, scenario)
    assert done == ["paused", "acknowledge-task", "automatic"]
    outcomes = [record.entry.outcome for record in records(database) if record.entry.action == "start-production"]
    assert outcomes == [Outcome.REQUESTED, Outcome.REFUSED]


def test_an_alarm_says_that_commands_cannot_be_recorded() -> None:
    async def scenario(on: Bench) -> None:
        on.controller.records.unrecorded = "database or disk is full"
        assert "database or disk is full" in on.controller.view().alarms["unrecorded"].text
        on.controller.records.unrecorded = None
        assert on.controller.view().alarms["unrecorded"].ended is not None
        assert on.controller.view().production is Production.WAITING

    async def whole() -> None:
        async with bench() as on:
            await scenario(on)

    asyncio.run(whole())


def test_a_database_that_does_not_answer_in_time_is_told(database: Database, monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []

    async def act(command: Command) -> None:
        done.append(command.kind)

    async def scenario(recording: CommandAudit) -> None:
        monkeypatch.setattr("sequence_planner.controller.commands.audit.PATIENCE", 0.2)
        with database.writing(), pytest.raises(CommandRefused, match="pausing is possible"):
            await recording.carry_out(TakeControl(actor=EVA), nothing, act)

    told = recorded(database, scenario)
    assert told == ["the database does not answer within 0.2 s"]
    assert done == []
