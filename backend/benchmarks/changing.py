"""What every request costs that changes something, at a running station with its journal.

Run with `make bench`. The bolt tightening station runs as its users run it, with emulated devices and a database of
SQLite on the disk, and an administrator does everything that the OpenAPI document has that changes something, round
after round, one request after the other. Times are on the wall, of the client. What is refused counts for nothing: the
run ends with an error when an act does not do what it is for, or when a route is neither measured nor named below.
"""

from __future__ import annotations

import os
import re
import shutil
import statistics
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
from access import GIVEN, NAME, PASSWORD, STATION, add_administrator, station, wait_for

ROUNDS = 15
WHY = "to be measured"
CHANGING = ("POST", "PUT", "PATCH", "DELETE")
OTHER = "an even quieter submarine"

# They change nothing: their bodies are questions.
QUESTIONS = {
    "POST /corrections/preview",
    "POST /operator-plans/goal-preview",
    "POST /operator-plans/reset-preview",
    "POST /history/{number}/branch",
    "POST /model/language/check",
    "POST /model/language/completion",
    "POST /model/language/format",
    "POST /model/language/hover",
    "POST /model/pipelines/suggestions",
    "POST /model/pipelines/preview",
    "POST /model/pipelines/test-runs",
    "POST /model/what-if",
    "POST /goals/blockers",
}
# They need another station than this one: at its first start, before production, a demonstration, with a provider, with
# two people, an archive, overrides, a topic that is not in its model, a recording, or a checked revision.
ELSEWHERE = {
    "POST /corrections/confirm",
    "POST /storage/archive",
    "PUT /restored-outputs",
    "POST /production/start",
    "PUT /overrides/{name}",
    "DELETE /overrides/{name}",
    "POST /setup",
    "POST /session/demonstration",
    "POST /session/provider",
    "POST /session/provider/answer",
    "POST /approvals/corrections",
    "POST /approvals/forces",
    "POST /approvals/restored-outputs",
    "POST /approvals/{request}/approve",
    "POST /approvals/{request}/decline",
    "POST /model/deployments",
    "POST /model/pipelines/examples",
    "POST /model/pipelines/recordings",
    "POST /ros/attachments",
}


class Acts:
    """Does things at a station as its administrator, and notes how long each took, by route."""

    def __init__(self, client: httpx.Client) -> None:
        self._client = client
        document = client.get("/openapi.json").raise_for_status().json()
        self.routes = {
            f"{method.upper()} {path.removeprefix('/api/v1')}"
            for path, methods in document["paths"].items()
            for method in methods
            if method.upper() in CHANGING
        }
        self._patterns = {each: re.compile(re.sub(r"\{\w+\}", "[^/]+", each)) for each in self.routes}
        self.times: dict[str, list[float]] = defaultdict(list)

    def __call__(self, method: str, path: str, body: object = None, **more: Any) -> Any:  # noqa: ANN401 - JSON
        """What is answered. Raises `RuntimeError` unless it was done."""
        return self.by(self._client, method, path, body, **more)

    def by(
        self,
        client: httpx.Client,
        method: str,
        path: str,
        body: object = None,
        *,
        etag: bool = False,
        headers: dict[str, str] | None = None,
    ) -> Any:  # noqa: ANN401 - JSON
        """What `client` is answered, or the entity tag of that. Raises `RuntimeError` unless it was done."""
        content: dict[str, Any] = {"json": body} if body is not None else {}
        began = time.perf_counter()
        answer = client.request(method, path, headers=headers, **content)
        took = time.perf_counter() - began
        if not answer.is_success:
            raise RuntimeError(f"{method} {path} gave {answer.status_code}: {answer.text}")
        if method in CHANGING:
            asked = f"{method} {path}"
            [route] = [each for each, pattern in self._patterns.items() if pattern.fullmatch(asked)]
            self.times[route].append(took)
        if etag:
            return answer.headers["ETag"]
        return answer.json() if answer.content else None

    def wait(self, condition: Callable[[], object]) -> None:
        """Return when it is true; raises `TimeoutError`."""
        wait_for(lambda: bool(condition()))


def main() -> None:
    """Measure and print."""
    os.environ["ROS_DOMAIN_ID"] = str(1 + (os.getpid() + 55) % 100)
    with tempfile.TemporaryDirectory(prefix="changing-") as folder:
        os.environ["SEQUENCE_PLANNER_DATABASE"] = f"sqlite:///{folder}/station.sqlite"
        model = Path(folder) / "bolt_tightening"
        shutil.copytree(STATION, model)
        add_administrator()
        with (
            station(model, "--webhook-host", "127.0.0.1:9", "--webhook-loopback") as (address, _),
            httpx.Client(base_url=f"{address}/api/v1", timeout=30) as client,
        ):
            client.post("/session", json={"name": NAME, "password": GIVEN}).raise_for_status()
            client.put("/session/password", json={"old": GIVEN, "new": PASSWORD}).raise_for_status()
            act = Acts(client)
            for number in range(ROUNDS):
                people(act, number)
                systems(act, number)
                backups(act)
                watches(act, number, address)
                act("PUT", "/control-lock", {"over": None})
                tasks_and_alarms(act)
                modes(act)
                ways_back(act)
                orders(act, number)
                drafting(act, number)
                act("DELETE", "/control-lock")
    report(act)


def people(act: Acts, number: int) -> None:
    """Sign-in and the people there are."""
    old, new = (PASSWORD, OTHER) if number % 2 == 0 else (OTHER, PASSWORD)
    act("DELETE", "/session")
    act("POST", "/session", {"name": NAME, "password": old})
    act("PUT", "/session/password", {"old": old, "new": new})
    person = act("POST", "/users", {"name": f"Person {number}", "role": "viewer", "password": f"{PASSWORD} too"})
    address, revision = f"/users/{person['id']}", {"If-Match": f'"{person["revision"]}"'}
    act("PATCH", address, {"role": "operator"}, headers=revision)
    act("PUT", f"{address}/password", {"password": f"{PASSWORD} as well"})
    act("DELETE", f"{address}/sessions")


def systems(act: Acts, number: int) -> None:
    """Keys and webhooks."""
    key = act("POST", "/api-keys", {"name": f"key {number}", "scopes": ["read"], "days": 1})["key"]["id"]
    turned = act("POST", f"/api-keys/{key}/rotation", {"overlap": 60})["key"]["id"]
    act("DELETE", f"/api-keys/{turned}")
    url = "http://127.0.0.1:9/told"
    made = act("POST", "/webhooks", {"title": f"MES {number}", "url": url, "after": 0})
    webhook = f"/webhooks/{made['webhook']['id']}"
    act("POST", f"{webhook}/dead-letters/retry", {})
    act("DELETE", webhook)


def backups(act: Acts) -> None:
    """One is made, and checked."""
    file = act("POST", "/backups", {})["file"]
    act.wait(lambda: act("GET", "/backups")["busy"] is None)
    act("POST", f"/backups/{file}/check", {})
    act.wait(lambda: act("GET", "/backups")["busy"] is None)


def watches(act: Acts, number: int, address: str) -> None:
    """A watch is offered to be paired twice, and paired once."""
    asked = {"name": f"watch {number}", "resource": "operator"}
    act("DELETE", f"/wearables/offers/{act('POST', '/wearables/offers', asked)['id']}")
    offer = act("POST", "/wearables/offers", asked)
    with httpx.Client(base_url=f"{address}/api/v1", timeout=30) as wrist:
        watch = act.by(wrist, "POST", "/wearables/pairing", {"code": offer["code"]})["id"]
    act("POST", f"/wearables/{watch}/confirmation", {})
    act("DELETE", f"/wearables/{watch}")


def tasks_and_alarms(act: Acts) -> None:
    """Somebody has a problem with a task, which is an alarm; it is solved, and the task done."""
    act("PUT", "/mode", {"mode": "automatic"})

    def tasks() -> dict[str, Any]:
        return {id_: each for id_, each in act("GET", "/tasks")["tasks"].items() if not each["problem"]}

    act.wait(tasks)
    [(task, revision), *_] = [(id_, each["revision"]) for id_, each in tasks().items()]
    act("POST", f"/tasks/{task}/problem", {"revision": revision, "reason": WHY})
    [(alarm, since)] = [(id_, each["since"]) for id_, each in act("GET", "/alarms")["alarms"].items() if task in id_]
    act("POST", "/alarms/acknowledge", {"alarm": alarm, "since": since})
    act("POST", "/alarms/shelve", {"alarm": alarm, "reason": WHY, "seconds": 60})
    act("POST", "/alarms/unshelve", {"alarm": alarm})
    act("POST", "/alarms/suppress", {"alarm": alarm, "reason": WHY})
    act("POST", "/alarms/restore", {"alarm": alarm})
    revision = act("GET", "/tasks")["tasks"][task]["revision"]
    act("POST", f"/tasks/{task}/problem/solved", {"revision": revision})
    revision = act("GET", "/tasks")["tasks"][task]["revision"]
    act("POST", f"/tasks/{task}/acknowledgement", {"revision": revision})


def modes(act: Acts) -> None:
    """Pause, steps, out of service, forces."""
    act("PUT", "/stepping", {"on": True, "reason": WHY})
    act("POST", "/stepping/step", {})
    act("PUT", "/stepping", {"on": False, "reason": WHY})
    act("PUT", "/mode", {"mode": "paused"})
    for in_service in (False, True):
        act("PUT", "/availability/resource/robot", {"in_service": in_service, "reason": WHY})
    act("PUT", "/forces/robot.moving", {"value": False, "seconds": 60, "reason": WHY})
    act("DELETE", "/forces/robot.moving")


def ways_back(act: Acts) -> None:
    """A correction that is taken back, an errand that is stopped, and an ability that is tried."""

    def moving() -> bool:
        abilities = act("GET", "/abilities")["abilities"].values()
        return any(each["running_since"] for each in abilities if each["resource"] == "robot")

    act.wait(lambda: not moving())
    time.sleep(0.5)  # until its devices have said so
    act("POST", "/restart/enter", {})
    now = act("GET", "/state")["variables"]["bolts[bolt_pair_1]"]["value"]
    values = {"bolts[bolt_pair_1]": "empty" if now != "empty" else "placed"}
    revision = act("GET", "/station")["revision"]
    act("POST", "/corrections", {"values": values, "revision": revision, "reason": WHY})
    revision = act("GET", "/station")["last_correction"]["revision"]
    act("POST", "/corrections/undo", {"revision": revision, "reason": WHY})
    pose = act("GET", "/state")["variables"]["robot.pose"]["value"]
    there = "home" if pose == "above_engine" else "above_engine"
    offer = act("POST", "/operator-plans/goal-preview", {"predicate": f"robot.pose == {there}"})
    steps = [each["ability"] for each in offer["errand"]["steps"]]
    act("POST", "/operator-plans", {"offer": offer["id"], "reason": WHY, "starts": steps})
    act("POST", "/operator-plans/stop", {})
    act.wait(lambda: act("GET", "/station")["errand"] is None)
    act("POST", "/restart/leave", {})
    act("PUT", "/mode", {"mode": "paused"})
    abilities = act("GET", "/abilities")["abilities"]
    startable = [name for name, each in abilities.items() if each["enabled"] and not each["human"]]
    act("POST", "/test-runs", {"ability": startable[0]})
    act.wait(lambda: act("GET", "/station")["errand"] is None)


def orders(act: Acts, number: int) -> None:
    """An order is given, changed, started and cancelled."""
    act("PUT", "/settings/job-mode", {"on": True, "reason": WHY})
    asked = {"work_master": "truck_engine", "start": False}
    order = act("POST", "/job-orders", asked, headers={"Idempotency-Key": f"order-{number}"})
    address = f"/job-orders/{order['id']}"
    revision = {"If-Match": act("GET", address, etag=True)}
    act("PUT", address, {"work_master": "truck_engine", "priority": 3}, headers=revision)
    for one in ("Start", "RevokeStart", "Cancel"):
        act("POST", f"{address}/commands", {"command": one, "reason": WHY})
    act("PUT", "/settings/job-mode", {"on": False, "reason": WHY})


def drafting(act: Acts, number: int) -> None:
    """The title of the station is changed, a variable renamed, and all that saved and taken back."""
    title = f"Station {number}"
    was = act("GET", "/model/files")["files"]["station.yaml"]["content"]["title"]
    edit = {"kind": "set", "file": "station.yaml", "path": ["title"], "was": was, "value": title}
    act("POST", "/model/changes", {"title": title, "edits": [edit]})
    act("POST", "/model/rename", {"part": "variable:bolts", "name": "bolt_pairs"})
    act("POST", "/model/undo", {})
    act("POST", "/model/redo", {})
    act("POST", "/model/undo", {})
    count = act("GET", "/model")["number"]
    revision = act("POST", "/model/revisions", {"number": count, "name": f"revision {number}"})
    act("POST", f"/model/revisions/{revision['id']}/restore", {"number": act("GET", "/model")["number"]})


def report(act: Acts) -> None:
    """Print the median of each route. Raises `RuntimeError` when one is missing."""
    missing = act.routes - act.times.keys() - QUESTIONS - ELSEWHERE
    for route, times in sorted(act.times.items(), key=lambda each: statistics.median(each[1]), reverse=True):
        middle, most = statistics.median(times) * 1000, max(times) * 1000
        print(f"{route}: {middle:.1f} ms median, {most:.1f} ms at most of {len(times)}")
    if missing:
        raise RuntimeError(f"not measured: {sorted(missing)}")


if __name__ == "__main__":
    main()
