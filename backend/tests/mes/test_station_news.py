"""What events tell of the station, read from records of the run as the controller writes them."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from journal.happened import with_writer
from mes.test_ledger import MASTERS, job
from sequence_planner.controller.commands.audit import StandingNotes
from sequence_planner.controller.views.station import PackML
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.journal.writer import RunWriter
from sequence_planner.mes import events, orders
from sequence_planner.mes.events import JobEvent
from sequence_planner.mes.order import OrderContent
from sequence_planner.mes.tracker import OrderTracker, StationStanding
from support.examples import examples

BEGUN: dict[str, Any] = {"values": {}, "senses": {}, "memory": {}, "jobs": {}, "mode": "automatic"}
Written = tuple[str, dict[str, Any]]


def mode(name: str) -> Written:
    return "mode-changed", {"what": {"mode": name, "by": "Eva"}, "mode": name}


def alarm(key: str, event: str, ended: float | None = None) -> Written:
    about = {"priority": "medium", "text": "It stands", "consequence": "Nothing", "action": "Look", "count": 1}
    return "alarm", {"alarm": key, "event": event, "ended": ended, **about}


def packml(state: str) -> Written:
    return "packml", {"state": state, "since": 7.0}


def waits(name: str, *texts: str) -> Written:
    return "job-waits", {"job": name, "waits_for": list(texts), "since": 8.0}


def write(database: Database, *records: Written) -> None:
    async def writing(writer: RunWriter) -> None:
        for number, (kind, content) in enumerate(records):
            writer.write(kind, 100.0 + number, json.dumps(content))

    with_writer(database, writing)


def read(database: Database, follower: OrderTracker | None = None) -> list[JobEvent]:
    (follower or OrderTracker(database)).read_on(MASTERS)
    with database.reading() as connection:
        return events.after(connection, 0, 1000)


def order(database: Database) -> None:
    with database.writing() as connection:
        stored = orders.store(connection, OrderContent(work_master="a"), SYSTEM, 1.0, id="a", start=True)
        orders.hand_over(connection, stored, 1.0)


def test_stops_faults_and_what_an_order_waits_for_are_told(database: Database) -> None:
    write(database, ("begun", BEGUN), mode("hold"))
    assert read(database) == [], "what was before nobody asked to be told of"
    order(database)
    write(
        database,
        mode("automatic"),
        ("production-started", {"what": {}}),
        ("ticked", {"jobs": {"a": job("a", "running")}}),
        packml("execute"),
        alarm("overdue:x", "came"),
        alarm("overdue:x", "acknowledged"),
        waits("a", "x, which has not finished within 40 s"),
        waits("a", "x, which has not finished within 40 s"),
        waits("strange", "nobody"),
        alarm("overdue:x", "ended", 9.0),
        mode("automatic"),
        mode("paused"),
        packml("held"),
        waits("a"),
    )
    told = read(database)
    assert [each.number for each in told] == list(range(1, len(told) + 1))
    assert [(str(each.kind), each.job_order) for each in told] == [
        ("job-order-stored", "a"),
        ("station-mode-changed", None),
        ("station-production-started", None),
        ("job-order-running", "a"),
        ("station-packml-changed", None),
        ("alarm-raised", None),
        ("job-order-waits", "a"),
        ("alarm-ended", None),
        ("station-mode-changed", None),
        ("station-packml-changed", None),
        ("job-order-waits", "a"),
    ]
    assert told[1].content == {"mode": "automatic", "before": "hold", "by": "Eva"}
    assert told[4].content == {"state": "execute", "before": None}
    assert told[4].time == 7.0
    assert told[5].content["alarm"] == "overdue:x"
    assert told[6].content == {"waits_for": ["x, which has not finished within 40 s"]}
    assert told[8].content == {"mode": "paused", "before": "automatic", "by": "Eva"}
    assert told[10].content == {"waits_for": []}


def test_a_controller_that_is_started_anew_has_no_alarm_of_before(database: Database) -> None:
    write(database, ("begun", BEGUN))
    read(database)
    write(database, alarm("silent:robot", "came"), packml("held"), ("begun", {**BEGUN, "mode": "paused"}))
    write(database, alarm("silent:robot", "came"), packml("held"))
    assert [(str(each.kind), each.content.get("alarm") or each.content.get("state")) for each in read(database)] == [
        ("alarm-raised", "silent:robot"),
        ("station-packml-changed", "held"),
        ("station-controller-started", None),
        ("alarm-ended", "silent:robot"),
        ("alarm-raised", "silent:robot"),
        ("station-packml-changed", "held"),
    ]


def test_an_order_that_is_over_waits_for_nothing(database: Database) -> None:
    write(database, ("begun", BEGUN))
    read(database)
    order(database)
    records = [("ticked", {"jobs": {"a": job("a", state, ended=None)}}) for state in ("running", "aborted")]
    records[1][1]["jobs"]["a"]["ended"] = {"epoch": 5.0, "monotonic": 0.0}
    write(database, records[0], waits("a", "a plan"), records[1], waits("a"))
    assert [str(each.kind) for each in read(database)][-2:] == ["job-order-waits", "job-order-aborted"]


RECORDS = st.lists(
    st.sampled_from(
        [
            ("begun", BEGUN),
            *map(mode, ("automatic", "paused", "hold")),
            *map(packml, ("execute", "held")),
            *(alarm(key, "came") for key in "kl"),
            *(alarm(key, "returned", 1.0) for key in "kl"),
            *(waits("a", *texts) for texts in ((), ("x",), ("y",))),
        ]
    ),
    max_size=12,
)


@examples(300)
@given(RECORDS)
def test_what_was_told_is_how_it_stands(written: list[Written]) -> None:
    """Whoever has read all events knows what the records say, and no event says what was known."""
    standing, alarms, known = StationStanding(), set[str](), dict[str, object]()
    for number, (kind, content) in enumerate(written):
        standing, told = standing.after(RunRecord(number, float(number), kind, json.dumps(content), ""))
        for each in told:
            match str(each.kind):
                case "alarm-raised":
                    assert each.content["alarm"] not in alarms
                    alarms.add(str(each.content["alarm"]))
                case "alarm-ended":
                    alarms.remove(str(each.content["alarm"]))
                case "station-controller-started":
                    known |= {"mode": each.content["mode"], "packml": None}
                case "station-mode-changed":
                    assert each.content["before"] == known.get("mode") != each.content["mode"]
                    known["mode"] = each.content["mode"]
                case "station-packml-changed":
                    assert each.content["before"] == known.get("packml") != each.content["state"]
                    known["packml"] = each.content["state"]
                case "job-order-waits":
                    assert known.get("waits", []) != each.content["waits_for"]
                    known["waits"] = each.content["waits_for"]
    assert alarms == set(standing.alarms)
    assert known.get("mode") == standing.mode
    assert known.get("packml") == standing.packml
    assert known.get("waits", []) == standing.waits.get("a", [])


@pytest.mark.parametrize("each_time_anew", [True, False])
def test_however_often_the_server_is_killed_each_is_told_once(database: Database, each_time_anew: bool) -> None:
    write(database, ("begun", BEGUN))
    follower = OrderTracker(database)
    read(database, follower)
    order(database)
    records = [
        ("ticked", {"jobs": {"a": job("a", "running")}}),
        mode("hold"),
        alarm("k", "came"),
        waits("a", "a plan"),
        ("begun", {**BEGUN, "jobs": {"a": job("a", "running")}}),
        alarm("k", "came"),
        waits("a", "a plan"),
        waits("a"),
    ]
    for record in records:
        write(database, record)
        told = read(database, None if each_time_anew else follower)
    kinds = [str(each.kind) for each in told]
    assert [each.number for each in told] == list(range(1, len(told) + 1))
    assert kinds == [
        "job-order-stored",
        "job-order-running",
        "station-mode-changed",
        "alarm-raised",
        "job-order-waits",
        "station-controller-started",
        "alarm-ended",
        "alarm-raised",
        "job-order-waits",
    ]


def test_what_lasts_for_a_moment_is_not_noted() -> None:
    noted: list[Written] = []
    notes = StandingNotes(lambda kind, content: noted.append((kind, dict(content))))

    def look(seconds: float, state: PackML, **waits: list[str]) -> None:
        notes.look(state, waits, Timestamp(1000.0 + seconds, seconds))

    look(0, PackML.EXECUTE, a=[])
    look(1, PackML.EXECUTE, a=[])
    assert noted == [("packml", {"state": "execute", "since": 1000.0, "monotonic": 1.0})]
    look(2, PackML.SUSPENDED, a=["a plan"])
    look(2.5, PackML.EXECUTE, a=[])
    look(6, PackML.EXECUTE, a=["x"])
    look(10, PackML.EXECUTE, a=["x"])
    assert len(noted) == 1
    look(11, PackML.EXECUTE, a=["x"])
    assert noted[1:] == [("job-waits", {"job": "a", "waits_for": ["x"], "since": 1006.0})]
    look(12, PackML.EXECUTE)
    look(13, PackML.HELD, a=["x"])
    look(18, PackML.HELD, a=["x"])
    assert [each[0] for each in noted[2:]] == ["packml", "job-waits"], "a job that was paused is told of again"
