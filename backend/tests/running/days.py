"""Days of a MES at a station: real processes, faults of devices, and kills of any process."""

from __future__ import annotations

import importlib.util
import random
import sys
import time
from collections import Counter
from collections.abc import Callable
from contextlib import AbstractContextManager
from types import ModuleType
from typing import Any

from mes.receiver import Receiver, receiving
from running.day_stations import DayStation
from running.mortal import Mortal
from sequence_planner.auth import api_keys
from sequence_planner.auth.roles import Scope
from sequence_planner.core.actor import SYSTEM
from sequence_planner.mes import events
from sequence_planner.mes.webhooks import endpoints as webhooks
from sequence_planner.mes.webhooks.endpoints import Seal, key_file
from support.places import REPOSITORY

EXAMPLES = REPOSITORY / "docs" / "examples"
SCOPES = frozenset({Scope.READ, Scope.ORDERS_READ, Scope.ORDERS_WRITE, Scope.AUDIT})

At = Callable[..., AbstractContextManager[DayStation]]
"""Where: by seed, number of troubles and options of the server."""


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


def day(at: At, seed: str, orders: int, troubles: int) -> Counter[str]:
    """A day with so many orders and troubles; AssertionError when anything was lost, doubled or told wrongly."""
    client, simulator = example("mes_client"), example("mes_simulator")
    with receiving() as receiver:
        targets = (f"--webhook-host=127.0.0.1:{receiver.port}", "--webhook-loopback")
        with at(seed, troubles, *targets) as place:
            station = place.station
            secret = _told(station, receiver)
            mes = client.Mes(f"http://127.0.0.1:{station.port}", mes_key(station))
            station.begin_production()
            by_order = {"on": True, "reason": "the shift begins"}
            station.wait(lambda: station.ask("PUT", "settings/job-mode", by_order).is_success, "it works freely")
            chance, people = random.Random(seed), place.people
            of_day = simulator.Day(mes, place.work_master, orders, place.seconds, chance, people, "day")
            try:
                of_day.run(place.patience)
            except (AssertionError, OSError) as error:
                raise AssertionError(f"{place.story}\n{type(error).__name__}: {error}") from error
            assert of_day.differences() == []
            assert of_day.over == {f"day.{number}" for number in range(orders)}
            responses = [mes.response(id) for id in of_day.over]
            place.judge(responses)
            _require_told(station, receiver, secret, client)
            seen: Counter[str] = station.seen + of_day.told
            seen.update(f"orders {each['outcome']}" for each in responses)
            return seen


def mes_key(station: Mortal) -> str:
    """The secret of a key as a MES needs it."""
    with station.database.writing() as connection:
        secret, _ = api_keys.make_key(connection, "MES", SCOPES, 1, SYSTEM, time.time())
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
