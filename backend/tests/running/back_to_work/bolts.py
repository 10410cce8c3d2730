"""The bolt tightening station: what is true of the bolts, which no device knows, and hands that reach them."""

from __future__ import annotations

import math
import shutil
import threading
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ruamel.yaml import YAML

from running.back_to_work.floor import Floor, Hear, floor
from support.network import free_port
from support.places import REPOSITORY
from support.station import MODEL, RunningStation, process
from support.waiting import PATIENCE, until

PAIRS = ("bolt_pair_1", "bolt_pair_2", "bolt_pair_3")
SPEED = 5
# Of the model, in its own seconds: its devices are so many times as fast.
SOONER = {"finish: 30": "finish: 6", "react: 2": "react: 1.5", "react: 5": "react: 3"}


class Bolts:
    """What is true: it follows from where the tool turns and what hands do, whatever is believed."""

    def __init__(self, poses: Mapping[str, list[float]]) -> None:
        self._poses = poses
        self._lock = threading.Lock()
        self._at: str | None = None
        self._pair: str | None = None  # where the robot was last, of them
        self._turns = self._torque = False
        self.guided = False  # by a hand
        self.state = dict.fromkeys(PAIRS, "empty")
        self.engines = 0
        self.wrong: list[str] = []

    @property
    def topics(self) -> dict[str, tuple[str, Hear]]:
        """What is heard."""
        return {
            "/ur10/state": ("truck_engine_msgs/msg/RobotState", self._robot),
            "/smart_nutrunner/state": ("truck_engine_msgs/msg/NutrunnerState", self._tool),
        }

    def _robot(self, message: Mapping[str, object]) -> None:
        joints = message["joint_positions"]
        assert isinstance(joints, list)
        near = (name for name, pose in self._poses.items() if math.dist(joints, pose) < 0.02)
        at = next(near, None)
        with self._lock:
            if at != self._at and at in PAIRS and self.state[at] == "placed" and not self._turns and not self.guided:
                self.wrong.append(f"a standing tool is driven onto {at}")
            self._at = at
            self._pair = at if at in PAIRS else self._pair

    def _tool(self, message: Mapping[str, object]) -> None:
        torque = bool(message["programmed_torque_reached"])
        with self._lock:
            self._turns = bool(message["tool_is_running_forward"])
            # That nothing but loose bolts is turned is no specification of this small station.
            # It is reached at a pair alone; on a busy machine that is heard only after the robot has left.
            if torque and not self._torque and self._pair is not None and self.state[self._pair] == "placed":
                self.state[self._pair] = "tightened"
            self._torque = torque

    def place(self, pair: str) -> None:
        """A hand places a pair, on the next engine where this one is ready."""
        with self._lock:
            if all(state == "tightened" for state in self.state.values()):
                self.engines += 1
                self.state = dict.fromkeys(PAIRS, "empty")
            if self.state[pair] != "empty":
                self.wrong.append(f"{pair} is placed and was {self.state[pair]}: {self.state}")
            self.state[pair] = "placed"

    def make(self, pair: str, value: str) -> None:
        """A hand takes a pair out, or tightens it."""
        if value == "placed":
            self.place(pair)
        with self._lock:
            self.state[pair] = value


class BoltHands:
    """Somebody beside the station, who also was who disturbed it."""

    def __init__(self, place: Floor, bolts: Bolts) -> None:
        self._floor = place
        self.bolts = bolts
        self.known: dict[str, object] = {}
        self._standing: set[str] = set()  # resources whose devices do nothing until they are told something else

    def stop(self, resource: str) -> None:
        """Its devices stand still."""
        self._floor.fault(f"{resource} slow 10000")
        self._standing.add(resource)

    def fault(self, line: str) -> None:
        self._floor.fault(line)

    def push(self, changes: Mapping[str, object]) -> None:
        """Devices that stand still are moved, and stand still as before."""
        for name, value in changes.items():
            self._floor.by_hand(name, value)

    def can_bring(self, changes: Mapping[str, object]) -> bool:
        """An emulated device is brought to any value."""
        return True

    def bring(self, changes: Mapping[str, object]) -> None:
        self.bolts.guided = any(name == "robot.pose" for name in changes)
        for name, value in changes.items():
            if not name.startswith("operator."):
                self._floor.by_hand(name, value)
        self.told_anew({name.partition(".")[0] for name in changes})

    def online(self, resource: str) -> None:
        self._floor.fault(f"clear {resource}")
        self._standing.discard(resource)

    def told_anew(self, resources: Collection[str]) -> None:
        for resource in self._standing.intersection(resources):
            self._floor.fault(f"clear {resource}")
        self._standing.difference_update(resources)

    def make_true(self, estimate: str, value: object) -> bool:
        self.bolts.make(estimate.removeprefix("bolts[").removesuffix("]"), str(value))
        return True

    def serve(self, task: Mapping[str, object]) -> None:
        self.bolts.guided = False
        self.bolts.place(next(pair for pair in PAIRS if pair in str(task["ability"])))


@contextmanager
def bolt_station(folder: Path) -> Iterator[tuple[RunningStation, BoltHands]]:
    """The station with emulated devices, and hands beside it. Its time-outs are as fast as its devices."""
    model, log, port = folder / "bolt_tightening", folder / "log", free_port()
    shutil.copytree(REPOSITORY / MODEL, model)
    for path in (model / "resources").glob("*.yaml"):
        text = path.read_text(encoding="utf-8")
        for long, short in SOONER.items():
            text = text.replace(long, short)
        path.write_text(text, encoding="utf-8")
    robot = YAML(typ="safe").load(model / "resources" / "robot.yaml")
    bolts = Bolts(robot["topics"]["/ur10/state"]["pipeline"][0]["discretise"]["values"])
    with process(log, "run", str(model), "--port", str(port), "--emulator", "--emulator-speed", str(SPEED)) as running:
        station = RunningStation(running, port, log)
        try:
            until(station.up, seconds=3 * PATIENCE)
        except AssertionError as error:
            raise AssertionError(f"{error}\n{log.read_text()[-3000:]}") from None
        with floor(model / "messages", bolts.topics) as place:
            yield station, BoltHands(place, bolts)
    assert running.returncode == 0, log.read_text()
