"""A controller that stands by while a deployment starts, as real processes: the model is kept."""

from __future__ import annotations

import os
import random
import shutil
import signal
from contextlib import closing
from pathlib import Path

import pytest

from running.mortal import Mortal
from running.pairs import standby
from running.test_deploying import TITLED, deployed
from running.workshops import SINGLE_BOLT, EditedStation
from sequence_planner.core.storage_error import DATABASE
from sequence_planner.db.database import Database
from support.examples import SHARE
from support.network import free_port
from support.postgresql import Server
from support.station import process, signed_in
from support.waiting import until

LONG = 240.0  # seconds, on a machine that is busy with much else


def part_of(station: EditedStation, name: str, other_than: int = 0) -> int:
    """The process id of a part of a station that `run` has started, once it is another one."""
    until(lambda: bool(children := station.children(name)) and other_than not in children)
    return station.children(name)[0]


def with_other_title(folder: Path) -> Path:
    """The model that is deployed, as it is copied to the other machine."""
    model = folder / "single_bolt"
    shutil.copytree(SINGLE_BOLT, model)
    path, before, after = TITLED
    text = (model / path).read_text(encoding="utf-8")
    (model / path).write_text(text.replace(before, after, 1), encoding="utf-8")
    return model


@pytest.mark.skipif(SHARE < 1, reason="two stations and two takeovers take long: `make campaign` tries it")
@pytest.mark.timeout(900)  # on a machine that is busy with much else
def test_a_deployment_during_whose_start_another_station_takes_over_is_kept(
    postgresql: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    url = postgresql.new_database()
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv(DATABASE, url)
    model, port, log = tmp_path / "a" / "single_bolt", free_port(), tmp_path / "a.log"
    shutil.copytree(SINGLE_BOLT, model)
    (tmp_path / "b").mkdir()
    with closing(Database.open(url)) as database:
        database.upgrade()
        other = Mortal(
            tmp_path / "b", database, random.Random(1), url, "press-b", model=with_other_title(tmp_path / "b")
        )
        run = ("run", str(model), "--port", str(port), "--emulator", "--hot-standby", "press-a")
        with process(log, *run) as running:
            station = EditedStation(running, port, log, model)
            station.__dict__["browser"] = signed_in(model, port, url)
            until(station.up, seconds=LONG)
            other.start("server")
            other.start("controller")
            try:
                other.wait(lambda: "runs another model" in str(standby(other).get("trouble")), "it does not stand by")
                kept_while_it_stands_by(station, other)
            finally:
                other.end()


def kept_while_it_stands_by(station: EditedStation, other: Mortal) -> None:
    """`other` takes over from the controller with which the deployment starts, and later gives the command back."""
    station.control()
    devices, controller = part_of(station, "emulate"), part_of(station, "controller")
    revision = deployed(station, TITLED, name="Titled")
    # Without its devices it cannot say that it runs, however quickly it is prepared.
    devices = part_of(station, "emulate", devices)
    os.kill(devices, signal.SIGSTOP)
    try:
        controller = part_of(station, "controller", controller)
        other.wait(lambda: standby(other)["holder"] == "press-a" and standby(other)["trouble"] is None, "not held anew")
        assert station.get("deployment", "station")["state"] == "starting"
        os.kill(controller, signal.SIGSTOP)
        other.wait(lambda: standby(other)["active"] is True, "nobody takes over")
        os.kill(controller, signal.SIGCONT)
        # It is overtaken, and the next one stands by while it starts.
        part_of(station, "controller", controller)
        until(lambda: (station.station().get("standby") or {}).get("holder") == "press-b", seconds=LONG)
        assert station.get("deployment", "station")["state"] == "starting"
        assert station.get("production", "station") == "preparing"
    finally:
        os.kill(devices, signal.SIGCONT)
    until(lambda: (station.station().get("deployment") or {}).get("state") == "runs", seconds=LONG)
    assert station.get("standby", "station")["active"] is False
    refused = station.browser.post("production/start", json={})
    assert (refused.status_code, refused.json()["type"]) == (503, "/problems/on-standby")
    # Later it commands again, with the model that was deployed.
    other.kill("controller")
    until(lambda: (station.station().get("standby") or {}).get("active") is True, seconds=LONG)
    until(station.up, seconds=LONG)
    assert station.get("deployment", "station")["revision"] == revision
    assert station.get("station")["title"] == "Another title"
    assert "is brought back" not in station.log.read_text()
