"""Days of a MES at the bolt tightening station: real processes, faults of devices, and kills of any process."""

from __future__ import annotations

import importlib.util
import random
import subprocess
import sys
import time
from collections import Counter
from contextlib import suppress
from types import ModuleType
from typing import Any

import httpx

from mes.receiver import Receiver, receiving
from running.killing import Mortal, mortal
from running.stations import REPOSITORY, command, environment
from sequence_planner.actor import SYSTEM
from sequence_planner.identity import keys
from sequence_planner.identity.roles import Scope
from sequence_planner.mes import events
from sequence_planner.mes.webhooks import webhook as webhooks
from sequence_planner.mes.webhooks.sealing import Seal, key_file

EXAMPLES = REPOSITORY / "docs" / "examples"
SECONDS = 40.0  # of the day
PATIENCE = 300.0  # seconds after it
FAULTS = ("nutrunner silent for 3 s", "robot silent for 2 s", "robot slow 3 for 5 s", "nutrunner stuck for 3 s")
SCOPES = frozenset({Scope.READ, Scope.ORDERS_READ, Scope.ORDERS_WRITE, Scope.AUDIT})


def example(name: str) -> ModuleType:
    """A module of the examples, as somebody imports it who has copied their folder."""
    sys.path.insert(0, str(EXAMPLES))
    try:
        spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
        assert spec is not None and spec.loader is not None
        module = sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module
    finally:
        sys.path.remove(str(EXAMPLES))


class Station:
    """The station of a day, and what its people and its troubles do there."""

    def __init__(self, station: Mortal, troubles: int) -> None:
        self._station = station
        self._began = time.monotonic()
        chance = station.chance
        self._coming = sorted(chance.uniform(2, SECONDS) for _ in range(troubles))
        self._doing: subprocess.Popen[bytes] | None = None

    def people(self) -> None:
        """Do the tasks, and bring back to work what was killed; and let happen what is due."""
        if self._coming and time.monotonic() - self._began > self._coming[0]:
            self._coming.pop(0)
            self._trouble()
        with suppress(httpx.HTTPError, KeyError):  # the server, or what it hears of, is away
            if self._station.production() == "waiting":
                self._station.begin_production()
            self._station.acknowledge()

    def _trouble(self) -> None:
        what = self._station.chance.choice(["fault", "fault", "server", "controller", "both"])
        if what == "fault":
            line = self._station.chance.choice(FAULTS)
            done = subprocess.run(
                command("fault", line), env=environment(), capture_output=True, timeout=60, check=False
            )
            assert done.returncode == 0, done.stdout + done.stderr
            self._station.seen[f"fault: {line.partition(' for')[0]}"] += 1
            return
        for part in ("controller", "server") if what == "both" else (what,):
            self._station.kill(part)
            self._station.seen[f"{part}s killed"] += 1
        for part in ("controller", "server") if what == "both" else (what,):
            self._station.start(part)


def day(seed: str, orders: int, troubles: int) -> Counter[str]:
    """A day with so many orders and troubles; AssertionError when anything was lost, doubled or told wrongly."""
    client, simulator = example("mes_client"), example("mes_simulator")
    with receiving() as receiver:
        targets = (f"--webhook-host=127.0.0.1:{receiver.port}", "--webhook-loopback")
        with mortal(seed, *targets) as station:
            secret = _told(station, receiver)
            mes = client.Mes(f"http://127.0.0.1:{station.port}", _key(station))
            station.begin_production()
            by_order = {"on": True, "reason": "the shift begins"}
            station.wait(lambda: station.ask("PUT", "work-by-order", by_order).is_success, "it works freely")
            people = Station(station, troubles).people
            of_day = simulator.Day(mes, "truck_engine", orders, SECONDS, random.Random(seed), people, "day")
            of_day.run(PATIENCE)
            assert of_day.differences() == []
            assert of_day.over == {f"day.{number}" for number in range(orders)}
            _require_told(station, receiver, secret, client)
            seen: Counter[str] = station.seen + of_day.told
            return seen


def _key(station: Mortal) -> str:
    with station.database.writing() as connection:
        secret, _ = keys.make_key(connection, "MES", SCOPES, 1, SYSTEM, time.time())
    return secret


def _told(station: Mortal, receiver: Receiver) -> str:
    """Have the receiver told of all events; its secret."""
    with station.database.writing() as connection:
        seal = Seal(key_file(station.database.place))
        secret, _ = webhooks.make(connection, seal, "MES", receiver.url(), (), 0, SYSTEM, time.time())
    return secret


def _require_told(station: Mortal, receiver: Receiver, secret: str, client: ModuleType) -> None:
    """Every event has come, signed; those that were under way while the server was killed may have come twice."""
    with station.database.reading() as connection:
        last = events.last(connection)
        written = {each.number: each.model_dump(mode="json") for each in events.after(connection, 0, last)}
    station.wait(lambda: set(receiver.numbers) == set(written), "events are not told")
    heard: dict[int, Any] = {}
    for each in receiver.received:
        event = client.verified(secret, each.headers, each.body, float(each.headers["webhook-timestamp"]))
        heard[event["number"]] = event
    assert heard == written
    station.seen["events told"] += len(written)
    station.seen["events told again"] += len(receiver.received) - len(written)
