"""The past as operators, engineers and systems read it, from a server whose station is not even running."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest

from history.journalled import life
from sequence_planner.auth.roles import Role
from sequence_planner.automaton.automaton import Kind
from sequence_planner.journal import checkpoints, run_journal
from server.test_acting import problem
from support.places import BOLT_TIGHTENING
from support.server import Server, serving, settings_in
from support.simulated import ready

HISTORY = "/api/v1/history"
AUTOMATON = ready(BOLT_TIGHTENING)[0].automaton
PATIENCE = 120.0  # seconds; the process that looks back prepares the station first


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server over the journal of twelve seconds of work."""
    folder: Path = tmp_path_factory.mktemp("history")
    with serving(replace(settings_in(folder), model=BOLT_TIGHTENING)) as server:
        asyncio.run(life(server.identity.database, BOLT_TIGHTENING, 12.0))
        yield server


@pytest.fixture(scope="module")
def reader(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.OPERATOR) as client:
        client.timeout = httpx.Timeout(PATIENCE)
        yield client


@pytest.fixture(scope="module")
def engineer(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.ENGINEER) as client:
        client.timeout = httpx.Timeout(PATIENCE)
        yield client


def read(reader: httpx.Client, address: str = "", **question: object) -> dict[str, Any]:
    answer = reader.get(f"{HISTORY}{address}", params={key: str(value) for key, value in question.items()})
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_the_pages_have_everything_once_and_the_newest_first(server: Server, reader: httpx.Client) -> None:
    numbers: list[int] = []
    page: dict[str, Any] = {"next": None}
    while numbers == [] or page["next"] is not None:
        page = read(reader, limit=50, **({"before": page["next"]} if numbers else {}))
        numbers += [each["number"] for each in page["records"]]
    with server.identity.database.reading() as connection:
        end = run_journal.end(connection)
    assert end is not None
    assert numbers == list(range(end.number, 0, -1))


def test_only_some_kinds_are_told_where_these_are_named(reader: httpx.Client) -> None:
    records = read(reader, kinds="begun,production-started")["records"]
    assert [each["kind"] for each in records] == ["production-started", "begun"]
    assert "memory" not in records[1]["content"]
    assert records[1]["content"]["values"]
    problem(reader.get(HISTORY, params={"kinds": "Begun"}), 422, "invalid-request")


def test_records_are_sought_by_what_they_name(reader: httpx.Client) -> None:
    everything = read(reader, limit=200)["records"]
    started = next(each for each in everything if each["content"].get("started"))["content"]["started"][0]
    found = read(reader, name=started, kinds="ticked,answered", limit=200)["records"]
    assert [each["number"] for each in found] == [
        each["number"]
        for each in everything
        if each["kind"] in ("ticked", "answered") and f'"{started}' in json.dumps(each["content"])
    ]
    assert 0 < len(found) < len(everything)
    assert read(reader, text=started.upper(), name=started, kinds="ticked,answered", limit=200)["records"] == found
    assert [each["number"] for each in read(reader, kinds="begun", parts="started,plan", limit=200)["records"]] == [
        each["number"]
        for each in everything
        if each["kind"] == "begun" or "started" in each["content"] or "plan" in each["content"]
    ]
    assert read(reader, text="100%")["records"] == read(reader, who="Eva")["records"] == []


def test_the_time_line_has_all_that_happened_between_two_times(reader: httpx.Client) -> None:
    everything = read(reader, limit=200)["records"]
    newest, oldest = everything[0], everything[-1]
    line = read(reader, "/line", since=oldest["time"] - 1, until=newest["time"])
    assert line["whole"]
    assert (line["last"]["number"], line["end"], line["first"]["number"]) == (newest["number"], newest["number"], 1)
    marked = {each["number"]: each["content"] for each in line["marks"]}
    for each in everything:
        for part in ("started", "ended", "plan"):
            assert marked.get(each["number"], {}).get(part) == each["content"].get(part)
    assert any("plan" in content for content in marked.values())
    assert sum(line["bins"]) == newest["number"]


def test_the_time_line_says_what_ran_when_it_begins(reader: httpx.Client) -> None:
    everything = read(reader, limit=200)["records"]
    middle = everything[len(everything) // 2]
    line = read(reader, "/line", since=middle["time"], until=everything[0]["time"])
    moment = read(reader, f"/{line['begin']}")["past"]
    assert sorted(line["running"]) == moment["running"]
    assert sorted(line["active"]) == moment["active"]
    assert line["mode"] == moment["mode"]
    assert min(each["number"] for each in line["marks"]) > line["begin"]


def test_a_time_has_its_record(reader: httpx.Client) -> None:
    everything = read(reader, limit=200)["records"]
    middle = everything[len(everything) // 2]
    found = read(reader, "/at", time=middle["time"])
    assert found["time"] == middle["time"]
    assert found["number"] >= middle["number"]
    assert read(reader, "/at", time=0) == {"number": 1, "time": everything[-1]["time"]}
    problem(reader.get(f"{HISTORY}/at", params={"time": "nan"}), 422, "invalid-request")


def test_an_export_ends_where_it_is_asked_to(reader: httpx.Client) -> None:
    lines = reader.get(f"{HISTORY}/export", params={"after": 3, "to": 5}).text.splitlines()
    assert [json.loads(each)["number"] for each in lines] == [4, 5]


def test_the_export_has_each_record_as_it_is_verified(server: Server, reader: httpx.Client) -> None:
    answer = reader.get(f"{HISTORY}/export", params={"after": 3})
    assert answer.headers["content-type"] == "application/x-ndjson"
    with server.identity.database.reading() as connection:
        records = run_journal.after(connection, 3, 10_000)
    assert answer.text.splitlines() == [each.line() for each in records]
    assert json.loads(answer.text.splitlines()[0])["number"] == 4


def test_a_moment_of_the_past_is_shown_with_its_plan(reader: httpx.Client) -> None:
    (started,) = [each for each in read(reader, limit=200)["records"] if each["content"].get("started")][-1:]
    moment = read(reader, f"/{started['number']}")
    assert moment["record"] == started
    past = moment["past"]
    assert past["mode"] == "automatic"
    assert past["packml"] == "execute"
    assert past["values"].keys() == AUTOMATON.variables.keys()
    done = [each["ability"] for each in past["plan"]["steps"] if each["status"] in ("done", "running")]
    assert done[-len(started["content"]["started"]) :] == started["content"]["started"]
    problem(reader.get(f"{HISTORY}/999999"), 404, "no-record")


def test_a_branch_is_simulated_and_leaves_no_trace(server: Server, engineer: httpx.Client) -> None:
    with server.identity.database.reading() as connection:
        before = run_journal.end(connection)
    answer = engineer.post(f"{HISTORY}/20/branch", json={"seconds": 5})
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert found["seconds"] == 5.0
    assert [each["number"] for each in found["records"]] == list(range(1, len(found["records"]) + 1))
    assert any(each["content"].get("started") for each in found["records"])
    assert found["end"]["tick"] > 0
    with server.identity.database.reading() as connection:
        assert run_journal.end(connection) == before


def test_a_branch_corrects_estimates_only(engineer: httpx.Client) -> None:
    output, estimate = AUTOMATON.names(Kind.OUTPUT)[0], AUTOMATON.names(Kind.ESTIMATED)[0]
    for name, slug in ((output, "not-estimated"), (estimate, "not-in-domain")):
        body = {"seconds": 1, "corrections": {name: "nonsense"}}
        told = problem(engineer.post(f"{HISTORY}/20/branch", json=body), 422, slug)
        assert name in told["detail"]
    problem(engineer.post(f"{HISTORY}/20/branch", json={"seconds": 601}), 422, "invalid-request")


def test_an_operator_takes_no_branch(reader: httpx.Client) -> None:
    problem(reader.post(f"{HISTORY}/20/branch", json={"seconds": 5}), 403, "role-too-low")


def test_the_newest_checkpoint_is_told(server: Server, reader: httpx.Client) -> None:
    problem(reader.get(f"{HISTORY}/checkpoint"), 404, "no-checkpoint")
    made = checkpoints.make(server.identity.database, 1.8e9)
    assert read(reader, "/checkpoint") == made.model_dump()
