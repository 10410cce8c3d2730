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
