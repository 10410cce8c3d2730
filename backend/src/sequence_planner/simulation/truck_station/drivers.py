"""Device drivers of the simulated truck station: robot, tools, AGV, tags, scene and watches."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from sequence_planner.simulation.truck_station.poses import POSES, named
from sequence_planner.simulation.truck_station.rest import GOAL, STATUS, request

# The computers at the devices: what they make of a command, and what they say of their device.
#
# A driver keeps what it has heard last, and nothing else: one that is started again knows nothing of what was before.

Record = Mapping[str, object]
Signals = dict[str, object]

FORGOTTEN_AFTER = 3.0  # seconds after which a command counts no more
RUNS = {
    "set_tool_idle": "idle",
    "run_tool_forward": "forward",
    "run_tool_in_reverse": "reverse",
    "inhibit_all_run_also_manual": "inhibit",
}
LIFTS = ("activate_unload", "activate_lift")
END_EFFECTOR = ("lock_rsp", "unlock_rsp", "open_gripper", "close_gripper")


class Driver(Protocol):
    """One computer. Times are seconds on any clock that only goes forward."""

    def on_command(self, command: Record, now: float) -> None:
        """Take a message of the controller."""

    def signals(self, now: float) -> Signals:
        """Return what to set at the device now."""

    def say(self, read: Record, now: float) -> dict[str, object]:
        """The message about the device, whose signals `read` has."""


class Listening:
    """The last command, for as long as it counts."""

    def __init__(self) -> None:
        self._command: Record = {}
        self._heard: float | None = None

    def on_command(self, command: Record, now: float) -> None:
        """See `Driver.hear`."""
        self._command, self._heard = command, now

    @property
    def spoken_to(self) -> bool:
        """True if a command was ever heard; until then a device stays as it is."""
        return self._heard is not None

    def fresh(self, now: float) -> bool:
        """Return whether a command was heard lately."""
        return self._heard is not None and now - self._heard < FORGOTTEN_AFTER

    def command(self, now: float) -> Record:
        """The command that counts; nothing when it is forgotten."""
        return self._command if self.fresh(now) else {}

    def bits(self, names: tuple[str, ...], now: float) -> dict[str, bool]:
        """The bits of the command; all are false when it is forgotten."""
        return {name: self.command(now).get(name) is True for name in names}


class ToolDriver(Listening):
    """The nutrunner runs only if exactly one of its four bits is set; the lift keeps what it was told last."""

    def signals(self, now: float) -> Signals:
        """See `Driver.signals`."""
        if not self.spoken_to:
            return {}
        runs = [run for name, run in RUNS.items() if self.command(now).get(name) is True]
        lifts = self.bits(LIFTS, now)
        return {
            "run": runs[0] if len(runs) == 1 else "idle",
            "lift": None if lifts[LIFTS[0]] == lifts[LIFTS[1]] else "float" if lifts[LIFTS[0]] else "hold",
        }

    def say(self, read: Record, now: float) -> dict[str, object]:
        """See `Driver.say`. The tool is always said to be idle, as this driver does."""
        heard = self.bits((*RUNS, *LIFTS), now)
        return {
            "aecu_unidriver_got_msg_from_sp": self.fresh(now),
            **{f"got_cmd_{name}": bit for name, bit in heard.items()},
            "tool_is_idle": True,
            "tool_is_running_forward": read["turning"] is True and not read["reverse"],
            "tool_is_running_reverse": read["turning"] is True and read["reverse"] is True,
            "positioned_at_home_station": read["home"],
            "operating_position": not read["home"],
            "programmed_torque_reached": read["torque"],
        }


class EndEffectorDriver(Listening):
    """The valves move only if exactly one bit is set; else they stay as they are."""

    def signals(self, now: float) -> Signals:
        """See `Driver.signals`."""
        match [name for name, bit in self.bits(END_EFFECTOR, now).items() if bit]:
            case ["lock_rsp" | "unlock_rsp" as only]:
                return {"lock": only == "lock_rsp"}
            case ["open_gripper" | "close_gripper" as only]:
                return {"close": only == "close_gripper"}
        return {}

    def say(self, read: Record, now: float) -> dict[str, object]:
        """See `Driver.say`."""
        tool = read["tool"]
        return {
            "recu_unidriver_got_msg_from_sp": self.fresh(now),
            **{f"got_cmd_{name}": bit for name, bit in self.bits(END_EFFECTOR, now).items()},
            "robot_not_connected_to_tool": tool is None,
            "robot_connected_to_lf_tool": tool == "LFTOOL",
            "robot_connected_to_atlas_tool": tool == "ATLASTOOL",
            "robot_connected_to_filter_tool": tool == "OFTOOL",
            "ladder_frame_not_connected": not read["frame"],
            "ladder_frame_connected": read["frame"],
            "pressure_ok": True,
            "rsp_is_locked": read["locked"],
            "gripper_is_closed": read["closed"],
        }


class DockDriver(Listening):
    """It only tells which tools are in the dock."""

    def signals(self, now: float) -> Signals:
        """See `Driver.signals`."""
        return {}

    def say(self, read: Record, now: float) -> dict[str, object]:
        """See `Driver.say`."""
        return {"lf_tool_home": read["lf"], "filter_tool_home": read["filter"]}


class AgvDriver(Listening):
    """The bridge to the AGV."""

    def signals(self, now: float) -> Signals:
        """See `Driver.signals`."""
        return {"goal": self.command(now).get("ref_pos")}

    def say(self, read: Record, now: float) -> dict[str, object]:
        """See `Driver.say`."""
        return {
            "mir_unidriver_got_msg_from_sp": self.fresh(now),
            "got_cmd_ref_pos": str(self.command(now).get("ref_pos", "")),
            "act_pos": read["position"],
        }


class TagDriver(Listening):
    """The reader of tags, the camera, and the switch of the line."""

    def signals(self, now: float) -> Signals:
        """See `Driver.signals`."""
        return {"read": self.command(now).get("read_tag"), "release": self.command(now).get("release_engine")}

    def say(self, read: Record, now: float) -> dict[str, object]:
        """See `Driver.say`."""
        return {"engine_in_place": read["in_place"], "tag_is_read": read["tag"] != "", "engine_number": read["tag"]}


class SceneDriver(Listening):
    """The scene of the motion planner, whose objects the robot holds or not."""

    def signals(self, now: float) -> Signals:
        """See `Driver.signals`."""
        command = self.command(now)
        return {"action": command.get("object_action"), "object": command.get("object_name")}

    def say(self, read: Record, now: float) -> dict[str, object]:
        """See `Driver.say`."""
        command = self.command(now)
        return {
            "state": {"robot_name": "TARS", "fresh_msg": self.fresh(now)},
            "ricochet": {
                "got_object_action": str(command.get("object_action", "")),
                "got_object_name": str(command.get("object_name", "")),
            },
            "scene_objects": ["ATLASTOOL", "LFTOOL", "OFTOOL"],
            "attached_objects": read["attached"],
        }


class WatchDriver(Listening):
    """The operator's watch."""

    def signals(self, now: float) -> Signals:
        """See `Driver.signals`."""
        command = self.command(now)
        return {"task": command.get("task"), "pair": command.get("pair")}

    def say(self, read: Record, now: float) -> dict[str, object]:
        """See `Driver.say`."""
        return {"acknowledged": read["acknowledged"], "takes_over": read["takes_over"]}


# How a node reaches its device: the world's port, and for the bridge to the AGV the AGV's own REST interface.

PATIENCE = 15.0  # seconds in which the world may start


class WorldEndedError(Exception):
    """The world is gone, and with it the device."""


@dataclass(frozen=True)
class NodeAnswer:
    """The device's signals, and what is the matter with the node."""

    read: dict[str, object]
    fault: dict[str, Any]


class DeviceLink(Protocol):
    """A way to a device."""

    async def exchange(self, put: Signals) -> NodeAnswer:
        """Set signals, and read those of the device. Raises `WorldEndedError` when it is gone."""

    def close(self) -> None:
        """Leave it."""


class WorldLink:
    """A node's connection to the world."""

    def __init__(self, node: str, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._node = node
        self._reader = reader
        self._writer = writer

    @classmethod
    async def to(cls, node: str, port: int) -> WorldLink:
        """Connect, once there is a world. Raises OSError when there is none after `PATIENCE`."""
        until = time.monotonic() + PATIENCE
        while True:
            try:
                return cls(node, *await asyncio.open_connection("127.0.0.1", port))
            except OSError:
                if time.monotonic() > until:
                    raise
                await asyncio.sleep(0.1)

    async def exchange(self, put: Signals) -> NodeAnswer:
        """See `DeviceLink.exchange`."""
        self._writer.write(json.dumps({"node": self._node, "put": put}).encode() + b"\n")
        try:
            line = await self._reader.readline()
        except ConnectionError as error:
            raise WorldEndedError from error
        if not line:
            raise WorldEndedError
        answer = json.loads(line)
        return NodeAnswer(answer["read"], answer["fault"])

    def close(self) -> None:
        """See `DeviceLink.close`."""
        self._writer.close()


class RestLink:
    """The bridge's way: the AGV over HTTP at `port`. The world is asked only what is the matter with the bridge."""

    def __init__(self, world: WorldLink, port: int) -> None:
        self._world = world
        self._port = port

    async def exchange(self, put: Signals) -> NodeAnswer:
        """See `DeviceLink.exchange`."""
        answer = await self._world.exchange({})
        if answer.fault.get("kind") == "stuck":
            return answer
        try:
            if (goal := put.get("goal")) is not None:
                await request(self._port, "PUT", GOAL, {"goal": goal})
            status = await request(self._port, "GET", STATUS)
            position = status["position"]
        except (OSError, ValueError, KeyError):
            return NodeAnswer({}, {"kind": "silent"})  # a bridge that knows nothing says nothing
        return NodeAnswer({"position": position}, answer.fault)

    def close(self) -> None:
        """See `DeviceLink.close`."""
        self._world.close()


# The computer of the robot: poses by name, and a memory of the last command, so that it is carried out once.

MOVING = 0.01  # rad/s of any of the first five joints
FORGET = ("UNKNOWN", "RESET")
FIELDS = ("action", "robot_type", "robot_name", "pose_type", "pose_name", "speed_scaling", "acc_scaling")
ROBOT_TYPE, ROBOT_NAME = "UR10", "TARS"


class RobotDriver(Listening):
    """A command that equals the one before it is ignored, until a pose named UNKNOWN or RESET makes it forget."""

    def __init__(self) -> None:
        super().__init__()
        self._taken: Record | None = None
        self._errors: list[str] = []
        self._previous = "UNKNOWN"
        self._target = "UNKNOWN"

    def on_command(self, command: Record, now: float) -> None:
        """See `Driver.hear`."""
        super().on_command(command, now)
        pose = str(command.get("pose_name", ""))
        self._errors = _errors(command)
        if pose in FORGET:
            self._taken = None
        elif command != self._taken and not self._errors:
            self._taken = command
            self._target = pose

    def signals(self, now: float) -> Signals:
        """See `Driver.signals`."""
        if (command := self._taken) is None:
            return {}
        speed = command.get("speed_scaling")
        return {
            "pose": command.get("pose_name"),
            "action": command.get("action"),
            "scaling": float(speed) if isinstance(speed, (int, float)) else 0.0,
        }

    def say(self, read: Record, now: float) -> dict[str, object]:
        """See `Driver.say`."""
        moving = any(abs(speed) >= MOVING for speed in _numbers(read["speeds"])[:5])
        pose = named(_numbers(read["joints"]))
        if not moving and pose is not None:
            self._previous = pose
        return {
            "info": {"robot_name": ROBOT_NAME, "fresh_msg": self.fresh(now), "error_list": self._errors},
            "ricochet": {f"got_{name}": str(self.command(now).get(name, "")) for name in FIELDS},
            "moving": moving,
            "actual_pose": f"moving from {self._previous} to {self._target}" if moving else pose or "UNKNOWN",
        }


def _errors(command: Record) -> list[str]:
    errors = [] if command.get("robot_type") == ROBOT_TYPE else [f"robot type mismatch: {command.get('robot_type')}"]
    if command.get("robot_name") != ROBOT_NAME:
        errors.append(f"robot name mismatch: {command.get('robot_name')}")
    if (pose := command.get("pose_name")) not in (*POSES, *FORGET):
        errors.append(f"no such pose is saved: {pose}")
    return errors


def _numbers(values: object) -> tuple[float, ...]:
    return tuple(float(value) for value in values) if isinstance(values, Sequence) else ()
