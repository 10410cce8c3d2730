"""The time line of a journal of which each record is known."""

from __future__ import annotations

import json

from journal.happened import with_writer
from sequence_planner.db.database import Database
from sequence_planner.history import timeline
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.writer import RunWriter


def alarm(time: float, key: str, event: str) -> tuple[str, float, str]:
    return "alarm", time, json.dumps({"alarm": key, "event": event, "resources": ["tool"]})


def test_the_time_line_says_which_alarms_stood_when_it_begins(database: Database) -> None:
    async def write(writer: RunWriter) -> None:
        for record in (
            alarm(0, "of an earlier controller", "came"),
            ("begun", 1, json.dumps({"values": {}, "memory": {"order.past": [], "active": []}, "mode": "paused"})),
            alarm(2, "stands", "came"),
            alarm(3, "over", "came"),
            alarm(4, "stands", "acknowledged"),
            alarm(5, "over", "returned"),
            alarm(6, "again", "came"),
            alarm(7, "again", "returned"),
            alarm(8, "again", "came again"),
            alarm(20, "later", "came"),
        ):
            writer.write(*record)

    with_writer(database, write)
    with database.reading() as connection:
        line = timeline.line(WholeRun(connection), 10, 30)
    assert line is not None
    assert [(each.time, each.content["alarm"]) for each in line.alarms] == [(2, "stands"), (8, "again")]
    assert [each.content["alarm"] for each in line.marks] == ["later"]


WORDS = {"id": "as-it-was", "arguments": {"text": "The tool has stalled"}}


def told(time: float, key: str, event: str, **content: object) -> tuple[str, float, str]:
    """A record of an alarm with all that is said of it."""
    about = {
        "kind": "overdue",
        "subject": "tool.run",
        "group": "device",
        "priority": "medium",
        "state": "unacknowledged",
        "text": "The tool has stalled",
        "consequence": "",
        "action": "",
        "messages": {"text": WORDS, "consequence": None, "action": None, "parts": []},
        "resources": ["tool"],
        "topics": [],
        "since": time,
        "ended": None,
        "by": None,
        "until": None,
        "why": None,
        "count": 1,
        "parts": [],
    }
    return "alarm", time, json.dumps({"alarm": key, "event": event, **about, **content})


def test_the_alarms_of_a_moment_are_those_that_stood_as_they_were_told_last(database: Database) -> None:
    async def write(writer: RunWriter) -> None:
        for record in (
            ("begun", 1, json.dumps({"values": {}, "memory": {"order.past": [], "active": []}, "mode": "paused"})),
            told(2, "urgent", "came"),
            told(3, "part", "came"),
            told(4, "seen later", "came"),
            told(5, "again", "came"),
            told(6, "seen later", "returned", ended=6.0),
            told(7, "seen later", "acknowledged", ended=6.0),
            told(8, "part", "became part of another"),
            told(9, "again", "returned", ended=9.0),
            told(10, "urgent", "became more urgent", priority="high"),
            told(11, "again", "came again"),
            alarm(12, "of an older program", "came"),
            told(12, "in words of another program", "came", messages={"text": {"id": "of-old", "arguments": {}}}),
            told(20, "later", "came"),
        ):
            writer.write(*record)

    with_writer(database, write)
    with database.reading() as connection:
        run = WholeRun(connection)
        stood = timeline.standing_alarms(run, run.at(12))
        line = timeline.line(run, 12, 30)
    assert {key: (each.priority, each.since) for key, each in stood.items()} == {
        "again": ("medium", 11),
        "urgent": ("high", 10),
    }
    assert line is not None
    assert "seen later" not in [each.content["alarm"] for each in line.alarms], "what is over is over, seen or not"


def test_what_was_called_off_before_the_line_begins_does_not_run_in_it(database: Database) -> None:
    def record(time: float, kind: str, **content: object) -> tuple[str, float, str]:
        return kind, time, json.dumps(content)

    async def write(writer: RunWriter) -> None:
        for each in (
            record(1, "begun", values={}, memory={"order.past": [], "active": []}, mode="automatic"),
            record(
                2, "ticked", started=["tool.run", "robot.move", "robot.wait", "engine.next"], at_once=["engine.next"]
            ),
            record(3, "mode-changed", what={"mode": "hold"}, called_off=["tool.run"]),
            record(4, "ticked", started=["press.close"]),
            record(5, "errand-stopped", called_off=["press.close"]),
            record(6, "ticked", ended=["robot.wait"]),
        ):
            writer.write(*each)

    with_writer(database, write)
    with database.reading() as connection:
        line = timeline.line(WholeRun(connection), 10, 30)
    assert line is not None
    assert line.running == ["robot.move"]
