"""The signals between the devices' computers and the devices: what each computer sets, and what it reads."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sequence_planner.simulation.truck_station.poses import POSES
from sequence_planner.simulation.truck_station.world import World

Signals = Mapping[str, object]
# Those that speak ROS 2; the AGV `mir` speaks to the bridge `mircom` alone.
NODES = ("tool_ecu", "rsp_ecu", "dock_ecu", "mircom", "rfidcam", "ur10", "scene", "watch")
COMPUTERS = (*NODES, "mir")


def set_signals(world: World, node: str, signals: Signals) -> None:
    """Set signals of a node's device. Raises KeyError for a node that there is not; unknown signals are left out."""
    _PUT[node](world, signals)


def read(world: World, node: str) -> dict[str, object]:
    """The signals that a node reads. Raises KeyError for a node that there is not."""
    return _READ[node](world)


def _put_tool(world: World, signals: Signals) -> None:
    tool = world.nutrunner
    match signals.get("run"):
        case "idle" | "forward" | "reverse" | "inhibit" as run:
            tool.run = run
    match signals.get("lift"):
        case "hold" | "float" as lift:
            tool.lift = lift


def _put_effector(world: World, signals: Signals) -> None:
    if isinstance(lock := signals.get("lock"), bool):
        world.effector.lock_wanted = lock
    if isinstance(close := signals.get("close"), bool):
        world.effector.close_wanted = close


def _put_agv(world: World, signals: Signals) -> None:
    if (goal := signals.get("goal")) in ("kitting", "station"):
        world.agv.goal = str(goal)


def _put_line(world: World, signals: Signals) -> None:
    if isinstance(read_tag := signals.get("read"), bool):
        world.line.read = read_tag
    if isinstance(release := signals.get("release"), bool):
        world.line.release = release


def _put_arm(world: World, signals: Signals) -> None:
    goal, scaling = POSES.get(str(signals.get("pose"))), signals.get("scaling")
    if goal is None or not isinstance(scaling, float) or (goal, scaling) == world.arm.told:
        return
    is_planned = signals.get("action") == "PLANNED"
    tool = world.held if world.effector.locked else None
    if is_planned and not world.arm.off and goal != world.arm.goal and world.scene != ([] if tool is None else [tool]):
        world.verdict.add_event(world.now, f"wrong plan: the scene has {world.scene}, and the robot {tool}")
    world.arm.command(goal, scaling)


def _put_scene(world: World, signals: Signals) -> None:
    name = str(signals.get("object"))
    if signals.get("action") == "ATTACH" and name not in world.scene:
        world.scene.append(name)
    elif signals.get("action") == "DETACH" and name in world.scene:
        world.scene.remove(name)


def _put_watch(world: World, signals: Signals) -> None:
    if (task := signals.get("task")) in ("none", "place", "guide", "free"):
        world.person.task, world.person.pair = str(task), str(signals.get("pair"))


def _read_tool(world: World) -> dict[str, object]:
    tool = world.nutrunner
    at_home = "ATLASTOOL" not in world.away
    return {"turning": tool.turning, "reverse": tool.run == "reverse", "torque": tool.torque, "home": at_home}


def _read_effector(world: World) -> dict[str, object]:
    effector = world.effector
    return {
        "tool": world.held,
        "frame": world.frame_held,
        "locked": effector.locked,
        "closed": effector.closed,
    }


def _read_dock(world: World) -> dict[str, object]:
    return {"lf": "LFTOOL" not in world.away, "filter": "OFTOOL" not in world.away}


def _read_arm(world: World) -> dict[str, object]:
    return {"joints": list(world.arm.joints), "speeds": list(world.arm.speeds)}


_PUT: dict[str, Callable[[World, Signals], None]] = {
    "tool_ecu": _put_tool,
    "rsp_ecu": _put_effector,
    "dock_ecu": lambda world, signals: None,
    "mircom": _put_agv,
    "mir": _put_agv,
    "rfidcam": _put_line,
    "ur10": _put_arm,
    "scene": _put_scene,
    "watch": _put_watch,
}
_READ: dict[str, Callable[[World], dict[str, object]]] = {
    "tool_ecu": _read_tool,
    "rsp_ecu": _read_effector,
    "dock_ecu": _read_dock,
    "mircom": lambda world: {"position": world.agv.position},
    "mir": lambda world: {"position": world.agv.position},
    "rfidcam": lambda world: {"in_place": world.line.engine is not None, "tag": world.line.tag},
    "ur10": _read_arm,
    "scene": lambda world: {"attached": list(world.scene)},
    "watch": lambda world: {"acknowledged": world.person.acknowledged, "takes_over": world.person.takes_over},
}
