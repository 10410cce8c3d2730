"""Deployments over REST upon a station that runs as real processes with emulated devices."""

from __future__ import annotations

import asyncio
import shutil
import threading
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import quote

from running.workshops import NEVER_GIVEN, ROBOT, SINGLE_BOLT, STATION, EditedStation, edited
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.startup.station_process import UNUSABLE
from support.network import free_port
from support.places import REPOSITORY
from support.station import finished, foreign_node, signed_in
from support.waiting import PATIENCE, until

TITLED = (STATION, "title: A single bolt", "title: Another title")
OTHER_TOPIC = (ROBOT, "/robot/state:", "/robot/other_state:")
LOOSE = (STATION, "bolt: {type: bolt_state", "bolt: {type: bolt_stat")


def title(station: EditedStation) -> str:
    return str(station.station()["station"]["title"])


def deployed(station: EditedStation, *replacements: tuple[str, str, str], name: str, **more: object) -> str:
    """Change the draft and deploy it; the id of the revision. What becomes of it is still to be seen."""
    station.change(*replacements)
    assert [each for each in station.checked()["findings"] if each["severity"] == "error"] == []
    revision = station.save(name)
    answer = station.deploy(revision, **more)
    assert answer.status_code == 204, answer.text
    return revision


def alarms(station: EditedStation) -> dict[str, str]:
    return {key: each["text"] for key, each in station.get("alarms").items()}


def begin(station: EditedStation) -> None:
    """Start production, on which nobody has to decide anything once all devices are heard: till then it is not known
    what they would do.
    """
    until(lambda: station.get("undecided", "station") == {})
    station.asked("POST", "production/start", {})


def test_a_revision_that_cannot_be_emulated_is_found_and_not_deployed(tmp_path: Path) -> None:
    with edited(tmp_path, "--emulator") as station:
        until(station.up)
        station.control()
        station.change(NEVER_GIVEN)
        (finding,) = [each for each in station.checked()["findings"] if each["severity"] == "error"]
        assert (finding["file"], finding["line"]) == (ROBOT, 10)
        assert "nowhere" in finding["message"]
        refused = station.deploy(station.save("Nowhere"))
        assert (refused.status_code, refused.json()["type"]) == (409, "/problems/check-found-errors")
        assert f"{ROBOT}:10:{finding['column']}: " in refused.json()["detail"]
        transfer = station.asked("GET", "model/transfer")
        assert (transfer["legal"], f"{transfer['obstacle']}.") == (False, refused.json()["detail"])
        assert station.up()


@contextmanager
def somebody_on(topic: str, type_name: str) -> Iterator[None]:
    """Another device that reports on a topic, on the station's network."""
    over, there = threading.Event(), threading.Event()

    async def speak() -> None:
        async with foreign_node(SINGLE_BOLT / "messages") as (transport, _):
            transport.advertise(topic, type_name, QualityOfService.RELIABLE)
            there.set()
            await asyncio.to_thread(over.wait)

    speaking = threading.Thread(target=lambda: asyncio.run(speak()))
    speaking.start()
    there.wait()
    try:
        yield
    finally:
        over.set()
        speaking.join()


def test_a_start_that_fails_brings_the_model_before_back(tmp_path: Path) -> None:
    """What only the network shows: beside a real device none is emulated."""
    with edited(tmp_path, "--emulator") as station:
        until(station.up)
        station.control()
        before = (station.model / ROBOT).read_text()
        with somebody_on("/robot/other_state", "bolt_msgs/msg/RobotState"):
            revision = deployed(station, OTHER_TOPIC, name="Other topic")
            outcome = station.outcome(revision)
        assert (outcome["state"], outcome["name"]) == ("undone", "Other topic")
        assert "the emulated devices would fight with it" in outcome["why"]
        assert (station.model / ROBOT).read_text() == before
        assert station.station()["control"] is not None
        until(lambda: "could not be started, and the model before is back" in alarms(station)["deployment-undone"])
        entries = station.asked("GET", "audit?limit=20")
        assert "undo-deployment" in str(entries)
        assert station.asked("GET", "model")["files"][ROBOT]["state"] == "changed", "what was deployed is lost"
        assert station.get("production", "station") == "waiting"
        # Nobody is in the way any more.
        assert station.deploy(revision).status_code == 204
        until(lambda: station.outcome(revision)["state"] == "runs")
        begin(station)
        until(lambda: "deployment-undone" not in alarms(station))
        # Whoever puts the files of before there now, once it went well, has changed the model: nothing was undone.
        assert station.asked("GET", "model")["files"][ROBOT]["state"] == "same"
        (station.model / ROBOT).write_text(before)
        assert station.asked("GET", f"model/files?path={ROBOT}")["files"][ROBOT]["text"] == before
        assert station.asked("GET", "model")["files"][ROBOT]["state"] == "same"


def test_a_model_that_was_broken_while_nothing_ran_is_repaired_on_its_page(tmp_path: Path) -> None:
    with edited(tmp_path, "--emulator") as station:
        until(station.up)
        station.asked("GET", "model")
        model = station.model
    path, whole, broken = LOOSE
    (model / path).write_text((model / path).read_text().replace(whole, broken))
    with edited(tmp_path, "--emulator", model=model) as station:
        seen = station.station()
        assert seen["production"] == "preparing"
        assert list(alarms(station)) == ["model-unusable"]
        assert "bolt_stat" in alarms(station)["model-unusable"]
        (finding,) = station.get("analysis")["findings"]
        assert (finding["file"].rpartition("/")[2], finding["severity"]) == (path, "error")
        refused = station.browser.put("mode", json={"mode": "paused"})
        assert (refused.status_code, refused.json()["type"]) == (409, "/problems/model-unusable")
        revision = deployed(station, (path, broken, whole), name="Repaired")
        assert station.outcome(revision)["state"] == "runs"
        until(station.up)
        assert title(station) == "A single bolt"


def test_a_broken_model_that_nobody_has_edited_is_an_error_of_the_command_line(tmp_path: Path) -> None:
    model = tmp_path / "broken"
    shutil.copytree(SINGLE_BOLT, model)
    path, whole, broken = LOOSE
    (model / path).write_text((model / path).read_text().replace(whole, broken))
    refused = finished("run", str(model), "--port", str(free_port()), "--emulator")
    assert refused.returncode == UNUSABLE
    assert "bolt_stat" in refused.stderr


def test_a_model_that_cannot_be_emulated_runs_without_and_is_repaired_on_its_page(tmp_path: Path) -> None:
    model = tmp_path / "single_bolt"
    shutil.copytree(SINGLE_BOLT, model)
    path, before, after = NEVER_GIVEN
    (model / path).write_text((model / path).read_text().replace(before, after))
    with edited(tmp_path, "--emulator", model=model) as station:
        until(station.up)
        until(lambda: "not-emulated" in alarms(station))
        assert "nowhere" in alarms(station)["not-emulated"]
        station.control()
        revision = deployed(station, (path, after, before), name="Repaired")
        assert station.outcome(revision)["state"] == "runs"
        until(lambda: station.value("robot.pose") == "home")
        assert "not-emulated" not in alarms(station)


def moved(station: EditedStation) -> None:
    """The robot stands above the bolt, for production is started, and paused."""
    station.control()
    station.asked("PUT", "mode", {"mode": "paused"})
    begin(station)
    trial = {"ability": "robot.move_to(above)", "reason": "to try it"}
    # Refused until its first commands are sent, and the robot answers them.
    until(lambda: station.browser.post("test-runs", json=trial, timeout=PATIENCE).is_success)
    until(lambda: station.value("robot.pose") == "above")
    until(lambda: station.get("errand", "station") is None)


def test_emulated_devices_go_on_as_they_stand_or_begin_anew_with_the_station(tmp_path: Path) -> None:
    with edited(tmp_path, "--emulator", "--emulator-speed", "5") as station:
        until(station.up)
        moved(station)
        session = station.get("control", "station")["session"]
        revision = deployed(station, TITLED, name="Titled")
        assert station.outcome(revision)["state"] == "runs"
        until(lambda: station.value("robot.pose") == "above")
        assert title(station) == "Another title"
        assert station.value("robot.target_pose") == "above"
        assert station.get("control", "station")["session"] == session
        begin(station)

        again = (STATION, TITLED[2], TITLED[1])
        revision = deployed(station, again, name="As at first", simulation="reset")
        assert station.outcome(revision)["state"] == "runs"
        until(lambda: station.value("robot.pose") == "home")
        assert station.value("robot.target_pose") == "home"
        assert station.get("control", "station")["session"] == session
        assert station.get("unconfirmed", "station") is False
        begin(station)


def becomes(seen: dict[str, Any]) -> str:
    """What is seen to become of the first deployment."""
    return str((seen.get("deployment") or {"state": "starting"})["state"])


def test_nothing_but_a_stop_is_accepted_while_a_deployment_is_under_way_and_mode_and_control_are_shown(
    tmp_path: Path,
) -> None:
    with edited(tmp_path, "--emulator") as station:
        until(station.up)
        station.control()
        station.asked("PUT", "mode", {"mode": "paused"})
        session = station.get("control", "station")["session"]
        revision = deployed(station, TITLED, name="Titled")
        held = station.browser.put("mode", json={"mode": "hold"}).is_success  # the controller before may be gone by now
        mode, refused, shown = "hold" if held else "paused", Counter[str](), 0
        while becomes(seen := station.station()) != "runs":
            answer = station.browser.put("mode", json={"mode": "automatic"})
            if answer.is_success:  # by the new one, which accepts a moment before the page is told that it runs
                until(lambda: becomes(station.station()) == "runs", seconds=3)
                break
            if becomes(station.station()) == "runs":
                break
            assert answer.status_code in (503, 504), answer.text
            refused[answer.json()["type"]] += 1
            if seen.get("production") == "preparing":
                assert (seen["mode"], seen["standing"]) == (mode, "preparing")
                assert seen["control"]["session"] == session
                shown += 1
        assert refused["/problems/deployment-under-way"] > 0
        assert refused.keys() <= {
            "/problems/deployment-under-way",
            "/problems/controller-unavailable",
            "/problems/controller-timeout",
        }
        assert shown > 0
        assert station.outcome(revision)["state"] == "runs"
        assert station.get("control", "station")["session"] == session


def test_real_devices_cannot_be_reset(tmp_path: Path) -> None:
    with edited(tmp_path) as station:
        until(station.up)
        station.control()
        station.change(TITLED)
        station.checked()
        refused = station.deploy(station.save("Titled"), simulation="reset")
        assert (refused.status_code, refused.json()["type"]) == (409, "/problems/not-emulated")


AGV = REPOSITORY / "models" / "docking_agv"
PRODUCT = "assemble"  # with which it is done
RETITLED = (STATION, "title: AGV with a docking station", "title: AGV and bench")


def person_works(station: EditedStation) -> None:
    """Whoever has a task says that it is done."""
    for name, task in station.get("tasks").items():
        station.browser.post(f"tasks/{quote(name, safe='')}/acknowledgement", json={"revision": task["revision"]})


def planned(station: EditedStation, name: str) -> str:
    """Change the title, and plan to deploy that when the product is done; the id of the revision."""
    station.change(RETITLED)
    assert station.checked()["state"] == "done"
    revision = station.save(name)
    number = station.asked("GET", "model")["number"]
    body = {"revision": revision, "number": number, "reason": "a better title"}
    answer = station.browser.put("model/deployments/planned", json=body, timeout=PATIENCE)
    assert answer.status_code == 204, answer.text
    return revision


def test_what_is_planned_is_deployed_when_the_product_is_done_and_nothing_of_another_has_begun(tmp_path: Path) -> None:
    model = tmp_path / "docking_agv"
    shutil.copytree(AGV, model)
    with edited(tmp_path, "--emulator", "--emulator-speed", "5", model=model) as station:
        until(station.up)
        station.control()
        begin(station)
        until(lambda: station.get("operations")["fetch_kit"]["active"])
        revision = planned(station, "Retitled")
        told = station.asked("GET", "model/deployments/planned")
        assert (told["name"], told["refused"]) == ("Retitled", None)
        assert station.get("cycle_stop", "station")["reached"] is False

        def runs() -> bool:
            person_works(station)
            seen = station.station().get("deployment")
            return seen is not None and (seen["revision"], seen["state"]) == (revision, "runs")

        until(runs, seconds=4 * PATIENCE)
        until(lambda: title(station) == "AGV and bench")
        assert station.asked("GET", "model/deployments/planned") is None
        assert station.get("mode", "station") == "paused"
        operations = station.get("operations")
        assert operations[PRODUCT]["completed"] == 1
        assert operations["hand_over_kit"]["completed"] == 1, "the next product has not begun"


def test_what_is_planned_is_not_deployed_where_somebody_pauses_before_and_says_so(tmp_path: Path) -> None:
    model = tmp_path / "docking_agv"
    shutil.copytree(AGV, model)
    with edited(tmp_path, "--emulator", model=model) as station:
        until(station.up)
        station.control()
        refused = station.browser.put(
            "model/deployments/planned",
            json={"revision": "0" * 40, "number": station.asked("GET", "model")["number"], "reason": "so"},
            timeout=PATIENCE,
        )
        assert (refused.status_code, refused.json()["type"]) == (404, "/problems/no-revision")
        begin(station)
        planned(station, "Retitled")
        station.asked("PUT", "mode", {"mode": "paused"})
        until(lambda: station.asked("GET", "model/deployments/planned")["refused"] is not None)
        told = station.asked("GET", "model/deployments/planned")["refused"]
        assert told["detail_message"]["id"] == "refused.not-paused.taken-back"
        assert "paused or held before" in told["detail"]
        assert title(station) == "AGV with a docking station"
        station.asked("DELETE", "model/deployments/planned")
        assert station.asked("GET", "model/deployments/planned") is None


DUAL = (STATION, "name: single_bolt\n", "name: single_bolt\ndeployment_approval: dual\n")


def test_where_the_model_asks_for_it_only_what_somebody_else_has_approved_is_deployed(tmp_path: Path) -> None:
    """Also by who speaks to the controller itself; and what was approved is on record with who did it."""
    with edited(tmp_path, "--emulator") as station:
        until(station.up)
        station.control()
        first = deployed(station, DUAL, name="Two people")  # the model of before asks nobody
        assert station.outcome(first)["state"] == "runs"
        until(station.up)
        assert station.get("station", "station")["deployment_approval"] == "dual"
        # How the station was at first nobody has saved: who brings that back does not approve it alone.
        saved = station.get("revisions", "model/revisions")
        initial = next(each["id"] for each in saved if each["by"] == "Sequence Planner")
        for revision in (initial, first):
            number = station.asked("GET", "model")["number"]
            station.asked("POST", f"model/revisions/{revision}/restore", {"number": number})
            assert station.checked()["state"] == "done"
            if revision == initial:
                station.asked("POST", f"model/revisions/{initial}/reviews", {"verdict": "approved"})
                refused = station.deploy(initial)
                assert (refused.status_code, refused.json()["type"]) == (409, "/problems/not-approved")
        station.change((STATION, DUAL[2], DUAL[1]))
        assert station.checked()["state"] == "done"
        revision = station.save("One again")
        refused = station.deploy(revision)
        assert (refused.status_code, refused.json()["type"]) == (409, "/problems/not-approved")
        assert "“One again”" in refused.json()["detail"]
        with signed_in(station.model, station.port) as maria:
            name = maria.get("session").json()["person"]["name"]
            verdict = f"model/revisions/{revision}/reviews"
            assert maria.get("model/changes").json()["waits"]["name"] == "One again"
            assert station.asked("GET", "model/changes")["waits"] is None  # it is their own
            wanted = maria.post(verdict, json={"verdict": "changes-requested", "text": "Why?"})
            assert wanted.is_success, wanted.text
            refused = station.deploy(revision)
            assert (refused.status_code, refused.json()["type"]) == (409, "/problems/not-approved")
            assert name in refused.json()["detail"]
            assert maria.post(verdict, json={"verdict": "approved"}).is_success
            assert maria.get("model/changes").json()["waits"] is None
        assert station.deploy(revision).status_code == 204
        assert station.outcome(revision)["state"] == "runs"
        until(station.up)
        assert station.get("station", "station")["deployment_approval"] == "single"
        records = station.asked("GET", "audit?limit=50")["records"]
        approved = [each["entry"]["details"]["approved_by"] for each in records if each["entry"]["action"] == "deploy"]
        assert [name] in approved
        verdicts = [each["entry"] for each in records if each["entry"]["action"].startswith("revision-")]
        assert [(each["action"], each["actor"]["name"]) for each in verdicts[:2]] == [
            ("revision-approved", name),
            ("revision-changes-requested", name),
        ]
