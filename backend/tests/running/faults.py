"""One fault at a running station with emulated devices: how soon it is told, and what is proposed then."""

from __future__ import annotations

import random
import shutil
import tempfile
import time
from collections import Counter
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from running.back_to_work.floor import Floor, floor
from running.back_to_work.person import Person
from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.tick import effect_writes
from sequence_planner.station import prepare_station
from support.network import free_port
from support.places import REPOSITORY
from support.station import RunningStation, process
from support.waiting import PATIENCE, until

TRUCK = REPOSITORY / "models" / "truck_engine_station"
SPEED = 5
# Of the model, in its own seconds: its devices are so many times as fast.
SOONER = {
    "finish: 120": "finish: 24",
    "finish: 60,": "finish: 12,",
    "finish: 60}": "finish: 12}",
    "finish: 40": "finish: 8",
}
KINDS = ("offline", "silent", "stuck", "slow 10000", "restarted", "garbage")
TOLD_WITHIN = 40.0  # seconds; what nobody needs to be told within that does not keep anything waiting
LONGEST_WAY = 60.0  # seconds until the work has come to a moment
PROPOSED_WITHIN = 2.0  # seconds
URGENT, NOTICES = ("medium", "high"), ("low",)


@dataclass(frozen=True)
class Seen:
    """What came of a fault: the `alarm` after so many seconds, and then what is proposed.

    Where nobody is told, `alarm` is None: how many operations were `completed` all the same, what a `notice` says that
    nobody has to acknowledge, which tasks wait for a person, and whether the fault changed nothing, as it `was_so`.
    """

    fault: str
    alarm: str | None = None
    told: float = 0.0
    proposed: float = 0.0
    advice: Any = None  # JSON
    completed: int = 0
    notice: str | None = None
    tasks: int = 0
    was_so: bool = False


@cache
def automaton() -> Automaton:
    """The truck engine station."""
    return prepare_station(TRUCK).automaton


def faults() -> list[str]:
    """All of them, as lines for the emulated devices; `by hand` stands before what is moved."""
    station = automaton()
    measured = station.names(Kind.MEASURED)
    lines = [f"{resource} {kind}" for resource in station.resources for kind in KINDS]
    for name in measured:
        domain = station.variables[name].type.domain
        values = [str(value).lower() if isinstance(value, bool) else str(value) for value in domain[:2]]
        lines += [f"{name} wrong {value}" for value in values] + [f"by hand {name} := {value}" for value in values]
    return [*lines, "out of service robot", "out of service nutrunner", "hold"]


@contextmanager
def truck_at_work() -> Iterator[tuple[RunningStation, Person, Floor]]:
    """The station with emulated devices, and somebody who serves its watch. Time-outs are as fast as devices."""
    with tempfile.TemporaryDirectory() as folder:
        model, log, port = Path(folder) / TRUCK.name, Path(folder) / "log", free_port()
        shutil.copytree(TRUCK, model)
        for path in (model / "resources").glob("*.yaml"):
            text = path.read_text(encoding="utf-8")
            for long, short in SOONER.items():
                text = text.replace(long, short)
            path.write_text(text, encoding="utf-8")
        options = ("--port", str(port), "--emulator", "--emulator-speed", str(SPEED))
        with process(log, "run", str(model), *options) as running:
            station = RunningStation(running, port, log)
            until(station.up, seconds=3 * PATIENCE)
            with floor(model / "messages", {}) as place:
                person = Person(station, _NoHands())
                person.do("POST", "production/start", {})
                yield station, person, place


class _NoHands:
    """Somebody who only looks on, and says at the watch that all is done."""

    def __init__(self) -> None:
        self.known: dict[str, object] = {}

    def serve(self, task: object) -> None:
        """The emulated operator does it."""

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - nothing else is done here
        raise AttributeError(name)


def after(person: Person, place: Floor, fault: str) -> Seen:
    """What comes of it at a station that works."""
    before, noticed = set(_alarms(person, URGENT)), set(_alarms(person, NOTICES))
    completed, was_so = person.completed(), _is_so(person, fault)
    began = time.monotonic()
    _begin(person, place, fault)
    found: dict[str, Any] = {}

    def told() -> bool:
        found.update({key: alarm for key, alarm in _alarms(person, URGENT).items() if key not in before})
        return bool(found) or (fault == "hold" and time.monotonic() - began > 1)

    if not person.until(told, TOLD_WITHIN):
        notice = next((alarm["text"] for key, alarm in _alarms(person, NOTICES).items() if key not in noticed), None)
        tasks = len(person.get("tasks")["tasks"])
        done = person.completed() - completed
        return Seen(fault, completed=done, notice=notice, tasks=tasks, was_so=was_so)
    seconds = time.monotonic() - began
    asked = time.monotonic()
    advice = person.get("recovery/proposals")
    text = next((alarm["text"] for alarm in found.values()), "held")
    return Seen(fault, text, seconds, time.monotonic() - asked, advice)


def _alarms(person: Person, priorities: Collection[str]) -> dict[str, Any]:
    alarms = person.get("alarms")["alarms"].items()
    return {key: alarm for key, alarm in alarms if alarm["ended"] is None and alarm["priority"] in priorities}


def _is_so(person: Person, fault: str) -> bool:
    """Whether a variable has the value already that the fault gives it."""
    name, given, value = fault.removeprefix("by hand ").partition(" := " if fault.startswith("by hand ") else " wrong ")
    return bool(given) and str(person.value(name)).lower() == value.lower()


def _begin(person: Person, place: Floor, fault: str) -> None:
    if fault == "hold":
        person.do("PUT", "mode", {"mode": "hold", "reason": "an emergency"})
    elif fault.startswith("out of service "):
        resource = fault.removeprefix("out of service ")
        person.do("PUT", f"availability/resource/{resource}", {"in_service": False, "reason": "it is looked after"})
    elif fault.startswith("by hand "):
        name, value = fault.removeprefix("by hand ").split(" := ")
        place.by_hand(name, value)
    else:
        place.fault(fault)


def judged(seen: Seen, state: dict[str, Any]) -> Counter[str]:
    """What was met. AssertionError where proposals come late, or are nothing that anybody would do, and where nobody is
    told anything though the work does not go on.
    """
    if seen.alarm is None:
        assert seen.completed or seen.tasks, f"{seen.fault}: nobody is told anything, and the work does not go on"
        goes_on = "the work goes on" if seen.completed else "a task waits for a person"
        so = ", as it was so already" if seen.was_so else ""
        told = f", and a notice says “{seen.notice}”" if seen.notice else so or " all the same"
        return Counter({f"{seen.fault}: {goes_on}{told}": 1})
    offers = seen.advice["offers"]
    told = f"{seen.fault}: “{seen.alarm}” after {seen.told:.1f} s"
    searched = f"{seen.advice['seconds']:.1f} s of them looked for"
    assert seen.proposed <= PROPOSED_WITHIN, f"{told}; proposals after {seen.proposed:.1f} s, {searched}"
    titles = [offer["title"] for offer in offers]
    why = (seen.advice["reasons"] or {}).get("members")
    assert offers or seen.advice["if_checked"] or why, f"{told}: nothing is proposed, and not why"
    passing = [offer["title"] for offer in offers if _passes(offer, state)]
    assert len(passing) in (0, len(offers)), f"{told}: what would not stay is proposed: {passing}"
    first = titles[0] if titles else "nothing but what has to be checked" if seen.advice["if_checked"] else "reasons"
    met = {f"{seen.fault}: first “{first}”": 1, "proposals": len(titles)}
    return Counter(met | {"most ms to proposals": round(1000 * seen.proposed)})


def _passes(offer: dict[str, Any], state: dict[str, Any]) -> bool:
    """Whether devices would at once change what somebody was asked to see to."""
    changed = {each["name"]: each["then"] for each in offer["physical"]}
    after_it = {**state, **changed}
    written = (effect_writes(each, after_it) or {} for each in automaton().effects if not each.fault)
    return any(each.get(name, value) != value for each in written for name, value in changed.items())


def one_fault(seed: str) -> Counter[str]:
    """A fault that the seed draws, at a moment of the main job that it draws."""
    chance = random.Random(seed)
    every = faults()
    number = int(seed.rpartition(".")[2])
    order = random.Random(seed.rpartition(".")[0]).sample(every, len(every))
    with truck_at_work() as (_, person, place):
        person.works(operations=chance.randrange(1, 14))
        person.until(lambda: False, chance.uniform(0, 2))
        seen = after(person, place, order[number % len(order)])
        state = {name: each["value"] for name, each in person.get("state")["variables"].items()}
        return judged(seen, {**dict.fromkeys(f.name for f in automaton().flags), **state})
