"""A station with emulated devices whose model is edited and deployed over REST, as an engineer's browser does it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx

from support.network import free_port
from support.places import REPOSITORY
from support.station import RunningStation, process, signed_in
from support.waiting import PATIENCE, until

SINGLE_BOLT = REPOSITORY / "models" / "single_bolt"
ROBOT, STATION = "resources/robot.yaml", "station.yaml"
POSES = "pose: [unknown, home, above, at_bolt]"
# An enumeration with a name that its `discretise` never gives.
NEVER_GIVEN = (STATION, POSES, POSES.replace("]", ", nowhere]"))


@dataclass
class EditedStation(RunningStation):
    """One whose model is changed."""

    model: Path

    def asked(self, method: str, path: str, body: object = None) -> Any:  # noqa: ANN401 - JSON
        # The first question starts the processes that answer it, on a machine where other stations start.
        answer = self.browser.request(method, path, json=body, timeout=PATIENCE)
        assert answer.is_success, answer.text
        return answer.json() if answer.content else None

    def get(self, part: str, path: str = "") -> Any:  # noqa: ANN401 - JSON
        """The `part` of the answer at `path`, once somebody tells it: while another model is started nobody does, nor
        as long as the controller has no processor to say how it stands.
        """
        found: list[Any] = []

        def told() -> bool:
            assert self.process.poll() is None, f"`run` has ended: {self.log.read_text()}"
            try:
                answer = self.browser.get(path or part)
            except httpx.HTTPError:
                return False
            if answer.status_code != httpx.codes.SERVICE_UNAVAILABLE:
                answer.raise_for_status()
                found[:] = [answer.json()[part]]
            return bool(found)

        until(told)
        return found[0]

    def control(self) -> None:
        """Take control from whoever has it."""
        holds = self.get("control", "station")
        self.asked("PUT", "control-lock", {"over": None if holds is None else holds["session"]})

    def change(self, *replacements: tuple[str, str, str]) -> None:
        """Change files of the draft: path, text before, text after."""
        edits = []
        for path, before, after in replacements:
            text = self.asked("GET", f"model/files?path={path}")["files"][path]["text"]
            assert before in text
            edits.append({"kind": "text", "file": path, "was": text, "text": text.replace(before, after, 1)})
        self.asked("POST", "model/changes", {"title": "changed", "edits": edits})

    def checked(self) -> Any:  # noqa: ANN401 - JSON
        """The check of the draft, once it is done."""
        found: list[Any] = []

        def done() -> bool:
            found[:] = [self.asked("GET", "model/check")]
            return bool(found[0]["state"] in ("done", "failed"))

        until(done)
        return found[0]

    def save(self, name: str) -> str:
        """Save the draft; the id of the revision."""
        number = self.asked("GET", "model")["number"]
        return str(self.asked("POST", "model/revisions", {"number": number, "name": name})["id"])

    def deploy(self, revision: str, **more: object) -> httpx.Response:
        """What is answered."""
        number = self.asked("GET", "model")["number"]
        body = {"revision": revision, "number": number, "reason": "to try it", **more}
        return self.browser.post("model/deployments", json=body, timeout=70)

    def station(self) -> Any:  # noqa: ANN401 - JSON
        """How it stands; empty while nobody tells."""
        assert self.process.poll() is None, f"`run` has ended: {self.log.read_text()}"
        try:
            answer = self.browser.get("station")
        except httpx.HTTPError:
            return {}
        return answer.json() if answer.is_success else {}

    def outcome(self, revision: str) -> Any:  # noqa: ANN401 - JSON
        """What has become of a deployment, once that is decided, and the station is up."""
        found: list[Any] = []

        def decided() -> bool:
            seen = self.station()
            found[:] = [seen.get("deployment")]
            return (
                found[0] is not None
                and found[0]["revision"] == revision
                and found[0]["state"] != "starting"
                and seen["production"] != "preparing"
            )

        until(decided, seconds=120)
        return found[0]


@contextmanager
def edited(folder: Path, *options: str, model: Path | None = None) -> Iterator[EditedStation]:
    """A copy of the single bolt, or the `model` that is there already, running with `options`; its page answers."""
    if model is None:
        model = folder / "single_bolt"
        shutil.copytree(SINGLE_BOLT, model)
    port, log = free_port(), folder / "station.log"
    with process(log, "run", str(model), "--port", str(port), *options) as running:
        seen = EditedStation(running, port, log, model)
        seen.__dict__["browser"] = signed_in(model, port)
        until(lambda: bool(seen.station()), seconds=4 * PATIENCE)
        yield seen
    assert running.returncode == 0, log.read_text()
