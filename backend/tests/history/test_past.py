"""The journal of a station that has worked: replayed, restored, looked back on, branched from."""

from __future__ import annotations

import asyncio
import dataclasses
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from sqlalchemy import text

from history.journalled import NOW, life, worked
from sequence_planner.automaton.automaton import Kind, VariableDeclaration
from sequence_planner.controller.restore import beginning
from sequence_planner.controller.views.station import StepStatus
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.execution.events import Confirmed
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.codec import BEGUN, SNAPSHOT, HistoryError, kind_of
from sequence_planner.execution.record.recorder import model_digest
from sequence_planner.execution.record.replay import Player, Replayed, replay
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.history.simulation import branch
from sequence_planner.history.state_at import looking_back, moment_view
from sequence_planner.history.timeline import line
from sequence_planner.journal import run_journal
from sequence_planner.journal.archive import ArchiveError
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.retention import trim
from sequence_planner.language.types import EnumerationType
from sequence_planner.version import VERSION
from support.commands import command
from support.databases import journal
from support.places import BOLT_TIGHTENING, TESTS
from support.simulated import ready

Worked = tuple[Database, Executor]
STATION, SUPERVISOR, _ = ready(BOLT_TIGHTENING)
AUTOMATON = STATION.automaton


@pytest.fixture(scope="module")
def past() -> Iterator[Worked]:
    """Thirty seconds of work."""
    with worked(30.0) as made:
        yield made


def replayed(database: Database, from_: int = 1, to: int | None = None) -> list[Replayed]:
    with database.reading() as connection:
        return list(replay(WholeRun(connection), AUTOMATON, SUPERVISOR, from_, to))


def test_the_work_is_replayed_bit_for_bit(past: Worked) -> None:
    database, execution = past
    found = replayed(database)
    assert [each.difference for each in found if each.difference] == []
    kinds = [each.record.kind for each in found]
    assert kinds[0] == BEGUN
    assert kinds.count(SNAPSHOT) >= 2
    assert found[-1].execution.state == execution.state
    assert found[-1].execution.plan.order == execution.plan.order
    assert any(json.loads(each.record.content).get("started") for each in found), "it has worked"


def test_what_is_in_the_archive_is_replayed_as_before(tmp_path: Path) -> None:
    (folder := tmp_path / "archive").mkdir()
    with worked(40.0) as (database, execution):
        before = replayed(database)
        trimmed = trim(database, NOW.epoch + 40.0, SYSTEM, folder)
        assert 0 < trimmed.begin < len(before)
        after = replayed(database)
        assert [each.record for each in after] == [each.record for each in before]
        assert [each.difference for each in after if each.difference] == []
        assert after[-1].execution.state == execution.state
        with database.reading() as connection:
            run = WholeRun(connection)
            for number in (2, trimmed.begin, trimmed.begin + 1):
                moment = looking_back(run, AUTOMATON, SUPERVISOR, number)
                assert moment.record == before[number - 1].record
        next(folder.iterdir()).unlink()
        with database.reading() as connection, pytest.raises(ArchiveError, match="is not there: put it back"):
            looking_back(WholeRun(connection), AUTOMATON, SUPERVISOR, 2)


def test_another_process_replays_it_too(past: Worked) -> None:
    """Sets of texts have another order in each process."""
    database, _ = past
    code = (
        "import sys\n"
        "from support.places import BOLT_TIGHTENING\n"
        "from support.simulated import ready\n"
        "from sequence_planner.execution.record.replay import replay\n"
        "from sequence_planner.journal.full_run import WholeRun\n"
        "from sequence_planner.db.database import Database\n"
        "station, supervisor, _ = ready(BOLT_TIGHTENING)\n"
        "database = Database.open(sys.argv[1], create=False)\n"
        "with database.reading() as connection:\n"
        "    found = list(replay(WholeRun(connection), station.automaton, supervisor))\n"
        "assert not found[-1].difference, found[-1].difference\n"
        "print(len(found))\n"
    )
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(TESTS)}
        arguments = [sys.executable, "-c", code, f"sqlite:///{database.place}"]
        done = subprocess.run(arguments, env=environment, capture_output=True, text=True, check=False, timeout=120)
        assert done.returncode == 0, done.stderr
        assert int(done.stdout) == len(replayed(database))


def test_a_part_of_it_is_replayed_from_the_snapshot_before(past: Worked) -> None:
    database, _ = past
    numbers = [each.record.number for each in replayed(database, 120, 130)]
    assert numbers[-1] == 130
    assert 120 - 52 < numbers[0] <= 120
    assert numbers == list(range(numbers[0], 131))


def test_what_does_not_come_to_what_was_written_is_named(past: Worked) -> None:
    database, _ = past
    with database.reading() as connection:
        records = run_journal.after(connection, 0, 1000)
    player = Player(AUTOMATON, SUPERVISOR)
    for record in records:
        if '"started"' in record.content:
            content = json.loads(record.content)
            name = next(iter(content["changes"]))
            content["changes"][name] = "somewhere else"
            difference = player.play(dataclasses.replace(record, content=json.dumps(content | {"digest": "0" * 16})))
            assert difference is not None
            assert f"record {record.number} (ticked)" in difference
            assert name in difference
            return
        assert player.play(record) is None
    pytest.fail("nothing was started")


def test_another_model_is_refused_in_words(past: Worked) -> None:
    database, _ = past
    other = replace(AUTOMATON, title="another")
    with database.reading() as connection, pytest.raises(HistoryError, match="another model of the station") as refused:
        list(replay(WholeRun(connection), other, SUPERVISOR))
    assert refused.value.slug == "model-changed"


def test_what_another_version_has_written_and_cannot_be_done_again_is_said_with_what_can() -> None:
    """Version 0.1.0 did not remember what was confirmed, so its digests are others from there on."""
    with journal() as database:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("sequence_planner.execution.record.recorder.VERSION", "0.1.0")
            patch.setattr("sequence_planner.execution.executor.answered", lambda *_: {})
            confirm = partial(Executor.confirm, names=frozenset({"bolts[bolt_pair_1]"}), by="Eva", now=NOW)
            asyncio.run(life(database, BOLT_TIGHTENING, 3.0, then=confirm))
        with database.reading() as connection:
            confirmed = run_journal.before(connection, None, 1, {kind_of(Confirmed)})[0].number
            known = beginning(connection, AUTOMATON, NOW)
        assert known is not None
        asyncio.run(life(database, BOLT_TIGHTENING, 3.0, known=known.beginning))
        with database.reading() as connection:
            begun = run_journal.before(connection, None, 1, {BEGUN})[0].number
        with pytest.raises(HistoryError) as refused:
            replayed(database)
        assert refused.value.slug == "other-version"
        said = str(refused.value)
        assert said.startswith(f"record {confirmed} (confirmed) ")
        assert f"another version of the program, 0.1.0, and this is {VERSION}: that one replays it" in said
        assert said.endswith(f"; this one goes on from record {begun}")
        assert replayed(database, to=confirmed - 1), "what can be done again is"
        assert replayed(database, from_=begun)[-1].difference is None
        code, _, err = command("journal", "replay", BOLT_TIGHTENING, "--database", f"sqlite:///{database.place}")
        assert (code, "another version of the program, 0.1.0" in err) == (2, True)


def test_the_digest_of_a_model_is_that_of_what_it_says() -> None:
    assert model_digest(AUTOMATON) == model_digest(replace(AUTOMATON, places={}))
    reversed_ = dict(reversed(list(AUTOMATON.abilities.items())))
    assert model_digest(AUTOMATON) != model_digest(replace(AUTOMATON, abilities=reversed_)), "order counts"


def test_every_moment_can_be_looked_at(past: Worked) -> None:
    database, _ = past
    found = replayed(database)
    with database.reading() as connection:
        for number in (1, 60, 101, len(found)):
            moment = looking_back(WholeRun(connection), AUTOMATON, SUPERVISOR, number)
            shown = moment_view(WholeRun(connection), moment)
            assert shown.record.number == number
            content = json.loads(moment.record.content)
            for name, value in content.get("changes", {}).items():
                assert shown.past.values[name] == value
        assert moment.now.epoch <= NOW.epoch + 31
        with pytest.raises(HistoryError, match="no record"):
            looking_back(WholeRun(connection), AUTOMATON, SUPERVISOR, len(found) + 1)


def test_a_plan_of_the_past_has_its_own_starts_and_says_which_were_called_off() -> None:
    at = 14.0
    held = Timestamp(NOW.epoch + at + 1, NOW.monotonic + at + 1)
    with journal() as database:
        execution = asyncio.run(
            life(database, BOLT_TIGHTENING, at, then=lambda running: running.change_mode(Mode.HOLD, "Eva", held))
        )
        with database.reading() as connection:
            run = WholeRun(connection)
            number = run.at(held.epoch)
            before, after = (
                moment_view(run, looking_back(run, AUTOMATON, SUPERVISOR, each)).past.plan.steps
                for each in (number - 1, number)
            )
    plan = execution.plan.order.plan
    assert plan is not None
    assert [each.ability for each in after] == [name for _, name in plan.starts], "nothing of earlier plans"
    assert len(execution.plan.order.past) + len(execution.plan.order.ahead) > len(plan.starts), (
        "there were earlier ones"
    )
    assert [each.ability for each in after if each.called_off] == ["nutrunner.run_nut"]
    assert [each.ability for each in before if each.status is StepStatus.RUNNING] == ["nutrunner.run_nut"]
    assert not any(each.called_off for each in before)
    assert [each.operations for each in before if each.status is StepStatus.RUNNING] == [
        ["tighten_bolt_pair(bolt_pair_1)"]
    ]


def test_an_ability_that_only_does_something_at_its_start_is_over_with_it(past: Worked) -> None:
    database, _ = past
    with database.reading() as connection:
        run = WholeRun(connection)
        contents = [json.loads(each.content) for each in run.after(0, 1000)]
        (brought_in,) = [each for each in contents if each.get("at_once")]
        assert brought_in["at_once"] == ["engine.next_engine"]
        assert "engine.next_engine" in brought_in["started"]
        seen = line(run, NOW.epoch + 29.5, NOW.epoch + 40)
    assert seen is not None
    assert "engine.next_engine" not in seen.running


def test_what_was_believed_comes_back(past: Worked) -> None:
    database, execution = past
    with database.reading() as connection:
        found = beginning(connection, AUTOMATON, Timestamp(1.9e9, 7.0))
        last = run_journal.before(connection, None, 1)[0]
    assert found is not None
    assert found.left_out == ()
    kept = (*AUTOMATON.names(Kind.ESTIMATED), *AUTOMATON.names(Kind.OUTPUT))
    assert found.beginning.values == {name: execution.state[name] for name in kept}
    assert found.beginning.unconfirmed_since == last.time


def test_what_no_longer_fits_the_model_is_left_out_and_said(past: Worked) -> None:
    database, _ = past
    name = AUTOMATON.names(Kind.ESTIMATED)[0]
    gone = AUTOMATON.names(Kind.OUTPUT)[0]
    variables = {key: each for key, each in AUTOMATON.variables.items() if key != gone}
    variables[name] = VariableDeclaration(name, EnumerationType(("new",)), Kind.ESTIMATED, "new", None)
    with database.reading() as connection:
        found = beginning(connection, replace(AUTOMATON, variables=variables), NOW)
    assert found is not None
    assert not found.beginning.values.keys() & {name, gone}
    assert len(found.left_out) == 2
    assert any(name in each and "{new}" in each for each in found.left_out)
    assert any(gone in each for each in found.left_out)


def test_a_second_life_begins_with_what_the_first_has_left() -> None:
    with worked(10.0) as (database, first):
        with database.reading() as connection:
            found = beginning(connection, AUTOMATON, NOW)
        assert found is not None
        asyncio.run(life(database, BOLT_TIGHTENING, 5.0, known=found.beginning))
        lives = replayed(database)
        assert not lives[-1].difference
        begun = [each.record.number for each in lives if each.record.kind == BEGUN]
        assert len(begun) == 2
        with database.reading() as connection:
            second = looking_back(WholeRun(connection), AUTOMATON, SUPERVISOR, begun[1]).execution
        for name in AUTOMATON.names(Kind.ESTIMATED):
            assert second.state[name] == first.state[name]
        assert second.revision >= first.revision > 0, "what was looked at in one life is never decided on in the next"


def without_protection(database: Database) -> None:
    """Whoever owns the database can take out what keeps records from being changed."""
    with database.writing() as connection:
        names = connection.execute(text("SELECT name FROM sqlite_master WHERE type = 'trigger'")).scalars().all()
        for name in names:
            connection.execute(text(f"DROP TRIGGER {name}"))


def test_what_was_changed_in_the_journal_is_not_believed_in_silence() -> None:
    with worked(3.0) as (database, _):
        without_protection(database)
        with database.writing() as connection:
            last = run_journal.before(connection, None, 1)[0].number
            change = {"number": last, "content": '{"changes":{"bolts[bolt_pair_1]":"tightened"}}'}
            connection.execute(text("UPDATE run SET content = :content WHERE number = :number"), change)
        with database.reading() as connection:
            found = beginning(connection, AUTOMATON, NOW)
        assert found is not None
        assert any(f"record {last} " in each for each in found.left_out)
        assert found.beginning.unconfirmed_since is not None


def test_a_snapshot_that_was_changed_is_noticed_too() -> None:
    with worked(3.0) as (database, _):
        without_protection(database)
        with database.writing() as connection:
            found = run_journal.before(connection, None, 1, (BEGUN, SNAPSHOT))[0]
            change = {"number": found.number, "content": found.content.replace('"empty"', '"tightened"')}
            connection.execute(text("UPDATE run SET content = :content WHERE number = :number"), change)
        with database.reading() as connection:
            known = beginning(connection, AUTOMATON, NOW)
        assert known is not None
        assert any(f"record {found.number} " in each for each in known.left_out)


@pytest.mark.parametrize("content", ["{", "[]", '{"values": []}', '{"unconfirmed": [], "values": {}}'])
def test_a_journal_that_cannot_be_read_says_so_and_what_to_do(content: str) -> None:
    with worked(3.0) as (database, _):
        without_protection(database)
        with database.writing() as connection:
            whole = "UPDATE run SET content = :content WHERE kind IN ('begun', 'snapshot')"
            connection.execute(text(whole), {"content": content})
        with database.reading() as connection, pytest.raises(StorageError, match=r"journal --verify"):
            beginning(connection, AUTOMATON, NOW)


def test_nothing_comes_back_where_nothing_was() -> None:
    with journal() as database, database.reading() as connection:
        assert beginning(connection, AUTOMATON, NOW) is None
        with pytest.raises(HistoryError, match="nothing has happened yet"):
            list(replay(WholeRun(connection), AUTOMATON, SUPERVISOR))


def test_a_branch_goes_on_from_the_past_without_touching_it(past: Worked) -> None:
    database, _ = past
    with database.reading() as connection:
        before = run_journal.end(connection)
        found = branch(WholeRun(connection), STATION, SUPERVISOR, 60, 20.0, {}, 60.0)
        assert run_journal.end(connection) == before
    assert found.seconds == 20.0
    started = [name for each in found.records for name in json.loads(each.content).get("started", ())]
    assert started, "production goes on"
    assert found.records[0].kind == BEGUN


def test_a_branch_may_begin_with_a_correction(past: Worked) -> None:
    database, _ = past
    name = AUTOMATON.names(Kind.ESTIMATED)[0]
    with database.reading() as connection:
        now = looking_back(WholeRun(connection), AUTOMATON, SUPERVISOR, 60).execution.state[name]
        other = next(value for value in AUTOMATON.variables[name].type.domain if value != now)
        found = branch(WholeRun(connection), STATION, SUPERVISOR, 60, 1.0, {name: other}, 60.0)
        assert json.loads(found.records[1].content)["changes"] == {name: other}
        with pytest.raises(HistoryError, match="no estimated variable"):
            branch(WholeRun(connection), STATION, SUPERVISOR, 60, 1.0, {AUTOMATON.names(Kind.OUTPUT)[0]: True}, 60.0)
        with pytest.raises(HistoryError, match="ranges over"):
            branch(WholeRun(connection), STATION, SUPERVISOR, 60, 1.0, {name: "nonsense"}, 60.0)


def test_a_branch_ends_when_its_time_is_over(past: Worked) -> None:
    database, _ = past
    with database.reading() as connection:
        found = branch(WholeRun(connection), STATION, SUPERVISOR, 60, 600.0, {}, 0.5)
    assert found.seconds < 600.0
