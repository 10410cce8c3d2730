"""The record of who did what, as operators and systems read it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from hypothesis import given

from core.choices import Choices, made_by
from sequence_planner.auth.roles import Role
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry, Outcome
from support.examples import examples
from support.server import serving, settings_in

from .test_acting import problem

AUDIT = "/api/v1/audit"
ACTIONS = ("set-mode", "acknowledge-task", "sign-in")
PEOPLE = ("0a", "0b")
MANY = 41


@pytest.fixture(scope="module")
def reader(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """The browser of an operator, at a server that has something to tell. There is no controller."""
    folder: Path = tmp_path_factory.mktemp("audit")
    with serving(settings_in(folder)) as server:
        with server.identity.database.writing() as connection:
            for number in range(MANY):
                person = PEOPLE[number % 3 == 0]
                actor = Actor(kind=ActorKind.PERSON, id=person, name=f"Person {person}", address="127.0.0.1")
                action, outcome = ACTIONS[number * number % 3], list(Outcome)[number % 4]
                entry = Entry(actor=actor, action=action, subject=f"task {number}", reason="to see it", outcome=outcome)
                audit.append(connection, entry, 1000.0 + number)
        with server.client(Role.OPERATOR) as reader:
            yield reader


def read(reader: httpx.Client, **question: object) -> dict[str, Any]:
    answer = reader.get(AUDIT, params={key: str(value) for key, value in question.items()})
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def pages(reader: httpx.Client, **question: object) -> Iterator[list[dict[str, Any]]]:
    """The pages that the cursor leads through."""
    page = read(reader, **question)
    yield page["records"]
    while page["next"] is not None:
        page = read(reader, **question, before=page["next"])
        yield page["records"]


def test_a_record_says_who_did_what_on_what_from_where_when_and_why(reader: httpx.Client) -> None:
    found = next(each for each in read(reader)["records"] if each["entry"]["subject"] == "task 7")
    assert found["time"] == 1007.0
    assert found["entry"] == {
        "actor": {"kind": "person", "id": "0a", "name": "Person 0a", "session": None, "address": "127.0.0.1"},
        "action": "acknowledge-task",
        "subject": "task 7",
        "details": {},
        "reason": "to see it",
        "outcome": "failed",
        "about": None,
    }


def test_records_come_newest_first_without_gaps(reader: httpx.Client) -> None:
    numbers = [each["number"] for each in read(reader, limit=200)["records"]]
    assert numbers == list(range(len(numbers), 0, -1))
    assert len(numbers) >= MANY


def questions(choices: Choices) -> tuple[int, dict[str, object]]:
    filters: dict[str, object] = {}
    if choices.chance(2):
        filters["action"] = choices.pick((*ACTIONS, "never-done"))
    if choices.chance(2):
        filters["actor"] = choices.pick((*PEOPLE, "nobody"))
    if choices.chance(2):
        filters["since"] = 1000.0 + choices.number(0, MANY)
    if choices.chance(2):
        filters["until"] = 1000.0 + choices.number(0, MANY)
    return choices.number(1, MANY + 2), filters


@examples(40)
@given(made_by(questions))
def test_the_cursor_leads_through_everything_that_was_asked_for(
    reader: httpx.Client, question: tuple[int, dict[str, object]]
) -> None:
    limit, filters = question
    everything = read(reader, limit=200)["records"]
    wanted = [
        each
        for each in everything
        if filters.get("action", each["entry"]["action"]) == each["entry"]["action"]
        and filters.get("actor", each["entry"]["actor"]["id"]) == each["entry"]["actor"]["id"]
        and filters.get("since", 0.0) <= each["time"] < filters.get("until", 1e12)
    ]
    found = list(pages(reader, limit=limit, **filters))
    assert [each for page in found for each in page] == wanted
    assert all(len(page) == limit for page in found[:-1])
    assert found[-1] or not wanted, "no page is empty for nothing"


@pytest.mark.parametrize(
    ("question", "field"),
    [
        ("before=0", "query.before"),
        ("before=x", "query.before"),
        ("before=9007199254740992", "query.before"),
        ("limit=0", "query.limit"),
        ("limit=201", "query.limit"),
        ("limit=1.5", "query.limit"),
        ("action=Set%20Mode", "query.action"),
        ("action=", "query.action"),
        ("actor=%00", "query.actor"),
        ("actor=", "query.actor"),
    ],
)
def test_a_wrong_question_is_told_where_it_is_wrong(reader: httpx.Client, question: str, field: str) -> None:
    found = problem(reader.get(f"{AUDIT}?{question}"), 422, "invalid-request")
    assert found["errors"][0]["field"] == field


@pytest.mark.parametrize("method", ["POST", "PUT", "PATCH", "DELETE"])
def test_nobody_can_change_the_record(reader: httpx.Client, method: str) -> None:
    before = read(reader, limit=200)
    problem(reader.request(method, AUDIT, json={}), 405, "method-not-allowed")
    assert reader.request(method, f"{AUDIT}/1", json={}).status_code == 404
    assert read(reader, limit=200) == before
