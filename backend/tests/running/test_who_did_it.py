"""A shift at a station that runs as real processes, and what its journal and who is in control say of it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from typing import Any

import httpx
import pytest
from websockets.sync.client import connect

from running.hall import Hall, opened
from support.station import finished
from support.waiting import until

Record = dict[str, Any]


@pytest.fixture(scope="module")
def hall(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hall]:
    with opened(tmp_path_factory.mktemp("hall")) as hall:
        yield hall


@pytest.fixture
def ada(hall: Hall) -> Iterator[httpx.Client]:
    """An administrator."""
    with hall.signed_in("Ada") as browser:
        yield browser


@pytest.fixture
def bo(hall: Hall) -> Iterator[httpx.Client]:
    """An operator."""
    with hall.signed_in("Bo") as browser:
        yield browser


def session(browser: httpx.Client) -> str:
    found: str = browser.get("session").json()["session"]
    return found


def production(browser: httpx.Client) -> str | None:
    """None while the controller is not heard."""
    found: str | None = browser.get("station").json().get("production")
    return found


def done(answer: httpx.Response) -> None:
    assert answer.status_code == 204, answer.text


def nobody_is_in_control(browser: httpx.Client) -> bool:
    """Control can be taken from nobody only where nobody has it; it is given up at once."""
    if browser.put("control-lock", json={"over": None}).status_code != 204:
        return False
    done(browser.delete("control-lock"))
    return True


def work_with_a_watch(hall: Hall, ada: httpx.Client, what: Callable[[], bool]) -> None:
    """Pair a watch, and acknowledge on it whatever it shows until all is done."""
    offer = ada.post("wearables/offers", json={"name": "Bo's watch", "resource": "operator"}).json()
    with hall.browser() as watch:
        answer = watch.post("wearables/pairing", json={"code": offer["code"]})
        assert answer.status_code == 201, answer.text
        done(ada.post(f"wearables/{answer.json()['id']}/confirmation", json={}))
        cookie = "; ".join(f"{name}={value}" for name, value in watch.cookies.items())
        address = f"ws://127.0.0.1:{hall.station.port}/api/v1/wearables/stream"
        with connect(address, additional_headers={"Cookie": cookie}) as stream:

            def acknowledged() -> bool:
                shown = json.loads(stream.recv(timeout=5))
                for identifier, task in shown.get("tasks", {}).items():
                    watch.post(f"tasks/{identifier}/acknowledgement", json={"revision": task["revision"]})
                return what()

            until(acknowledged)


def journal(browser: httpx.Client) -> list[Record]:
    """All records, in order."""
    found: list[Record] = []
    address: str | None = "audit?limit=200"
    while address is not None:
        answer = browser.get(address).raise_for_status().json()
        found += answer["records"]
        address = None if answer["next"] is None else f"audit?limit=200&before={answer['next']}"
    return found[::-1]


def told(record: Record) -> tuple[str, str, str, str, str | None]:
    entry = record["entry"]
    return entry["actor"]["name"], entry["action"], entry["subject"], entry["outcome"], entry["reason"]


def test_the_journal_tells_of_a_shift_who_did_what_when_where_and_why(
    hall: Hall, ada: httpx.Client, bo: httpx.Client
) -> None:
    began, last = time.time(), journal(ada)[-1]["number"]
    tighten = "tighten_bolt_pair(bolt_pair_{})"
    done(bo.put("control-lock", json={"over": None, "reason": "the morning shift"}))
    done(bo.post("production/start", json={"reason": "the first engine"}))
    done(bo.put("mode", json={"mode": "paused", "reason": "the tool sticks"}))
    done(bo.put("mode", json={"mode": "automatic", "reason": "it is free again"}))
    done(bo.put("overrides/robot.speed", json={"fields": {"speed_scaling": 0.1}, "reason": "somebody is near"}))
    done(bo.delete("overrides/robot.speed"))
    work_with_a_watch(hall, ada, lambda: any(hall.station.completed(tighten.format(pair)) for pair in (1, 2, 3)))
    done(ada.put("control-lock", json={"over": session(bo), "reason": "the shift ends"}))
    refused = bo.put("mode", json={"mode": "automatic", "reason": "but it was mine"})
    assert (refused.status_code, refused.json()["type"]) == (409, "/problems/control-needed")

    records = [each for each in journal(ada) if each["number"] > last]
    by_watch = [each for each in records if each["entry"]["action"] == "acknowledge-task"]
    others = [told(each) for each in records if each not in by_watch]
    assert others == [
        ("Bo", "take-control", "", "requested", "the morning shift"),
        ("Bo", "take-control", "", "done", "the morning shift"),
        ("Bo", "start-production", "", "requested", "the first engine"),
        ("Bo", "start-production", "", "done", "the first engine"),
        ("Bo", "set-mode", "", "done", "the tool sticks"),  # pausing does not wait for its record
        ("Bo", "set-mode", "", "requested", "it is free again"),
        ("Bo", "set-mode", "", "done", "it is free again"),
        ("Bo", "set-override", "override robot.speed", "requested", "somebody is near"),
        ("Bo", "set-override", "override robot.speed", "done", "somebody is near"),
        ("Bo", "clear-override", "override robot.speed", "requested", None),
        ("Bo", "clear-override", "override robot.speed", "done", None),
        ("Ada", "watch-offered", "watch Bo's watch", "done", None),
        ("Bo's watch", "watch-redeemed", "watch Bo's watch", "done", None),
        ("Ada", "watch-confirmed", "watch Bo's watch", "done", None),
        ("Ada", "take-control", "", "requested", "the shift ends"),
        ("Ada", "take-control", "", "done", "the shift ends"),
        ("Bo", "set-mode", "", "requested", "but it was mine"),
        ("Bo", "set-mode", "", "refused", "but it was mine"),
    ]
    assert {(each["entry"]["actor"]["kind"], each["entry"]["actor"]["name"]) for each in by_watch} == {
        ("watch", "Bo's watch")
    }
    assert "Place bolt pair 1" in {each["entry"]["details"].get("title") for each in by_watch}
    assert all(each["entry"]["actor"]["address"] == "127.0.0.1" for each in records)
    times = [each["time"] for each in records]
    assert times == sorted(times)
    assert began <= times[0] <= times[-1] <= time.time()
    by_number = {each["number"]: each["entry"] for each in records}
    for number, entry in by_number.items():
        if entry["about"] is not None:
            asked = by_number[entry["about"]]
            assert entry["about"] < number
            assert (asked["outcome"], asked["actor"], asked["action"], asked["subject"]) == (
                "requested",
                entry["actor"],
                entry["action"],
                entry["subject"],
            )


def test_the_journal_on_the_command_line_is_the_same_and_is_whole(hall: Hall, ada: httpx.Client) -> None:
    lines = [json.loads(line) for line in finished("journal", str(hall.model), "--jsonl").stdout.splitlines()]
    verified = finished("journal", str(hall.model), "--verify")
    assert verified.returncode == 0, verified.stderr
    who, what = verified.stdout.splitlines()[:2]
    assert who.startswith("who did what: ")
    assert what.startswith("what happened: ")
    assert all(", all as they were written; " in each for each in (who, what))
    number, records = int(who.removeprefix("who did what: ").split()[0]), journal(ada)
    assert len(lines) <= number <= len(records)  # the station goes on meanwhile
    assert records[number - 1]["hash"] in who
    written = [(each["number"], each["hash"]) for each in records]
    assert [(each["number"], each["hash"]) for each in lines] == written[: len(lines)]


def test_who_is_signed_out_loses_control_within_two_seconds(hall: Hall, ada: httpx.Client, bo: httpx.Client) -> None:
    until(lambda: bo.put("control-lock", json={"over": None}).status_code == 204, seconds=5)
    assert not nobody_is_in_control(ada)
    [person] = [each["id"] for each in ada.get("users").json()["people"] if each["name"] == "Bo"]
    done(ada.delete(f"users/{person}/sessions"))
    until(lambda: nobody_is_in_control(ada), seconds=2)
    assert bo.get("station").status_code == 401
    [withdrawn] = [each for each in journal(ada) if each["entry"]["action"] == "withdraw-control"][-1:]
    assert withdrawn["entry"]["actor"]["kind"] == "system"


def test_after_a_controller_that_was_killed_nobody_is_in_control(
    hall: Hall, ada: httpx.Client, bo: httpx.Client
) -> None:
    until(lambda: bo.put("control-lock", json={"over": None}).status_code == 204, seconds=5)
    hall.killed("controller")
    # The view of the one that was killed is shown a little longer, and the next one prepares the station first.
    until(lambda: production(ada) == "waiting" and bo.post("production/start", json={}).status_code != 503)
    refused = bo.post("production/start", json={})
    assert (refused.status_code, refused.json()["type"]) == (409, "/problems/control-needed")
    assert nobody_is_in_control(ada)


def test_after_a_server_that_was_killed_people_are_still_signed_in(hall: Hall, bo: httpx.Client) -> None:
    until(lambda: bo.put("control-lock", json={"over": None}).status_code == 204, seconds=5)
    before = session(bo)
    hall.killed("server")
    assert session(bo) == before
    done(bo.put("mode", json={"mode": "automatic"}))  # what control is needed for
