"""In which manner a use ties one thing to another."""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.model.reading import EntryPath
from sequence_planner.workshop.references.declared import Declared
from sequence_planner.workshop.references.parts import Part


class Manner(StrEnum):
    """What who uses a thing does with it. Those of a pipeline are said from its side: it feeds a variable."""

    RUNS = "runs"  # a work master, an operation
    AFTER = "after"  # a work master: others wait for it
    BRINGS = "brings"  # a work master: the value for a new product
    GOAL = "goal"
    PRECONDITION = "precondition"
    FORMULA = "formula"  # over the runs of an operation
    FORBIDS = "forbids"
    EXCLUDES = "excludes"
    ORDERS = "orders"
    ZONE = "zone"
    REST = "rest"  # the station at rest
    GUARD = "guard"  # of a start
    PROGRESS = "progress"  # what is so while an ability is executing, and when it has finished
    ACKNOWLEDGEMENT = "acknowledgement"  # by a person
    COMMANDS = "commands"  # an ability, an output variable
    WRITES = "writes"  # an ability, any other variable
    EFFECT = "effect"  # what a device is expected to do
    EXPECTS = "expects"  # when an effect is expected
    READS = "reads"
    FEEDS = "feeds"  # from ROS 2
    SENDS = "sends"  # to ROS 2
    SOURCE = "source"  # of a flow
    CARRIES = "carries"  # a type of message
    EXAMPLE = "example"
    RANGES = "ranges"  # over an enumeration
    NAMES = "names"  # a value, a parameter or a resource


_ROS = ("topic", "service", "action")
_BY_KEY = {
    "ability": {
        "enabled": Manner.GUARD,
        "executing": Manner.PROGRESS,
        "finished": Manner.PROGRESS,
        "human": Manner.ACKNOWLEDGEMENT,
    },
    "operation": {"goal": Manner.GOAL, "precondition": Manner.PRECONDITION, "local": Manner.FORMULA},
    "specification": {"exclusive": Manner.EXCLUDES, "order": Manner.ORDERS, "zone": Manner.ZONE},
    "work_master": {"brings": Manner.BRINGS},
}
_OTHERWISE = {"specification": Manner.FORBIDS, "work_master": Manner.RUNS, "message": Manner.CARRIES}


def manner_of(part: Part, by: Part | None, path: EntryPath, declared: Declared, *, writes: bool) -> Manner:
    """How `by`, or the station itself, uses a part at an entry within it; `writes` holds where that gets a value."""
    if part.kind == "enumeration":
        return Manner.RANGES
    if part.kind in ("value", "parameter", "resource"):
        return Manner.NAMES
    if by is None:
        return Manner.REST
    if by.kind in (*_ROS, "flow"):
        return _of_pipeline(part, path, writes=writes, outgoing=_is_outgoing(by, path, declared))
    key = str(path[0]) if path else ""
    if by.kind == "ability" and key not in _BY_KEY["ability"]:
        return _of_transition(part, path, declared, writes=writes)
    if by.kind == "work_master" and "after" in path:
        return Manner.AFTER
    return _BY_KEY.get(by.kind, {}).get(key) or _OTHERWISE.get(by.kind, Manner.READS)


def _of_transition(part: Part, path: EntryPath, declared: Declared, *, writes: bool) -> Manner:
    is_condition = "when" in path[1:]
    if path and path[0] == "effects":
        if is_condition:
            return Manner.EXPECTS
        return Manner.EFFECT if writes else Manner.READS
    if is_condition:
        return Manner.GUARD if path[0] == "start" else Manner.PROGRESS
    if not writes:
        return Manner.READS
    variable = declared.variables.get(part.full)
    return Manner.COMMANDS if variable is not None and variable.section == "output" else Manner.WRITES


def _of_pipeline(part: Part, path: EntryPath, *, writes: bool, outgoing: bool) -> Manner:
    key = path[0] if path else ""
    if part.kind == "message":
        return Manner.CARRIES
    if key == "from":
        return Manner.SOURCE
    if key == "examples":
        return Manner.EXAMPLE
    if writes:
        return Manner.FEEDS
    return Manner.SENDS if outgoing or key == "when" else Manner.READS


def _is_outgoing(by: Part, path: EntryPath, declared: Declared) -> bool:
    """Whether a stage is of what is sent: a request, a goal, or a topic that somebody else reads."""
    if by.kind == "topic":
        return by.name in declared.sent
    return bool(path) and path[0] in ("request", "goal")
