"""Problems of an outline that keep it from being written down, each with its place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sequence_planner.editor.outline.devices import BETWEEN, NOTHING, SUPPLY
from sequence_planner.editor.outline.facts import is_on_the_way, is_so_at_first, things_of
from sequence_planner.editor.outline.outline import (
    Clamp,
    Device,
    Fact,
    FoundDevice,
    Never,
    Outline,
    OutlineItem,
    OutlineProblem,
    OutlineStep,
    PersonDevice,
    Robot,
)
from sequence_planner.editor.outline.writing import titled
from sequence_planner.model.fields import fault_of_name
from sequence_planner.texts.message import Message, message

# What resources call their own variables: within them the product could not be named otherwise.
_OWN = {
    *("place", "target", "beside", "run", "is_running", "is_done", "is_open", "is_closed", "close_it"),
    *("request", "is_acknowledged", "pose"),
}

Place = tuple[str | int, ...]
_Found = tuple[Place, str]


def problems_of(outline: Outline) -> list[OutlineProblem]:
    """Return what is missing or wrong, in the order of the outline."""
    return [
        OutlineProblem(place=list(place), why=str(why), why_message=why if isinstance(why, Message) else None)
        for place, why in _all(outline)
    ]


def _all(outline: Outline) -> Iterator[_Found]:
    product = outline.product
    if not outline.devices:
        yield ("devices",), message("outline.no-devices")
    known = [SUPPLY] if product.then == "next" else []
    yield from _named(outline.devices, ("devices",), "resource", [product.name, *known])
    for at, device in enumerate(outline.devices):
        if isinstance(device, Robot):
            yield from _poses(device, ("devices", at, "poses"), _not_values(outline))
    yield from _name(product, ("product",), "variable", [*known, *_OWN])
    if len(product.states) < 2:
        yield ("product", "states"), message("outline.too-few-states")
    yield from _named(product.states, ("product", "states"), "value", _not_values(outline))
    if len(product.steps) != max(len(product.states) - 1, 0):
        yield ("product", "steps"), message("outline.steps-missing", states=len(product.states))
    yield from _steps(outline)
    for each in outline.devices:
        if isinstance(each, Clamp):
            yield from _turns(each, outline)
    yield from _nevers(outline)


def _turns(clamp: Clamp, outline: Outline) -> Iterator[_Found]:
    """What is wrong with the steps of a clamp: it rests open, and closes and opens in turns."""
    closed: int | None = None  # by this step
    for at, step in enumerate(outline.product.steps):
        if step.by != clamp.name or step.action is None:
            continue
        if (step.action == "close") == (closed is not None):
            which = "outline.closed-already" if step.action == "close" else "outline.open-already"
            yield ("product", "steps", at, "action"), message(which, device=titled(clamp))
        closed = at if step.action == "close" else None
    if closed is not None:
        yield ("product", "steps", closed, "action"), message("outline.stays-closed", device=titled(clamp))


def _named(all_: Sequence[OutlineItem], place: Place, kind: str, taken: Sequence[str]) -> Iterator[_Found]:
    """What is wrong with the names of several, none of which may be one of those that are `taken`."""
    before = list(taken)
    for at, each in enumerate(all_):
        yield from _name(each, (*place, at), kind, before)
        alike = next((one for one in all_[:at] if titled(one) == titled(each) and one.name != each.name), None)
        if alike is not None:
            yield (*place, at, "title"), message("outline.taken-title", title=titled(each))
        before.append(each.name)


def _name(named: OutlineItem, place: Place, kind: str, taken: Sequence[str]) -> Iterator[_Found]:
    if not named.name:
        yield (*place, "name"), message("outline.no-name")
    elif fault := fault_of_name(named.name, kind):
        yield (*place, "name"), fault
    elif named.name in taken:
        yield (*place, "name"), message("outline.taken-name", name=named.name)
    if "{" in named.title or "}" in named.title:
        yield (*place, "title"), message("outline.braces")


def _not_values(outline: Outline) -> list[str]:
    """Names that are those of variables wherever values are spoken of, or of values that all such have."""
    return [NOTHING, BETWEEN, outline.product.name, *_OWN]


def _poses(robot: Robot, place: Place, taken: Sequence[str]) -> Iterator[_Found]:
    if not robot.poses:
        yield place, message("outline.no-poses", robot=titled(robot))
        return
    yield from _named(robot.poses, place, "value", taken)
    count = len(robot.poses[0].joints)
    for at, pose in enumerate(robot.poses):
        if len(pose.joints) != count:
            yield (*place, at, "joints"), message("outline.other-joints", count=count, here=len(pose.joints))
        alike = next((each for each in robot.poses[:at] if count and _near(each.joints, pose.joints)), None)
        if alike is not None:
            yield (*place, at, "joints"), message("outline.same-joints", pose=titled(alike))


def _near(one: Sequence[float], other: Sequence[float]) -> bool:
    """Whether a robot in one of them could be taken to be in the other one."""
    return len(one) == len(other) and all(abs(a - b) < 0.04 for a, b in zip(one, other, strict=True))


def _steps(outline: Outline) -> Iterator[_Found]:
    devices = {each.name: each for each in outline.devices}
    called = set[tuple[str, str]]()
    for at, step in enumerate(outline.product.steps):
        place = ("product", "steps", at)
        device = devices.get(step.by)
        taken = [name for by, name in called if by == step.by] + _own(device, outline)
        if outline.product.then == "next":
            taken.append(f"next_{outline.product.name}")
        yield from _name(step, place, "ability", taken)
        called.add((step.by, step.name))
        if device is None or isinstance(device, Robot | FoundDevice):
            yield (*place, "by"), message("outline.nobody-does-it")
        elif isinstance(device, Clamp) and step.action is None:
            yield (*place, "action"), message("outline.no-action", device=titled(device))
        yield from _stands(step, devices, (*place, "where"))


def _own(device: Device | None, outline: Outline) -> list[str]:
    """Names that a device has for something else already."""
    if isinstance(device, Clamp):
        used = {each.action for each in outline.product.steps if each.by == device.name}
        return ["is_open", "is_closed", "close_it", *(each for each in ("close", "open") if each not in used)]
    # What a person is asked for are values.
    return _not_values(outline) if isinstance(device, PersonDevice) else ["run", "is_running", "is_done"]


def _stands(step: OutlineStep, devices: dict[str, Device], place: Place) -> Iterator[_Found]:
    for at, stand in enumerate(step.where):
        robot = devices.get(stand.robot)
        if not isinstance(robot, Robot):
            yield (*place, at, "robot"), message("outline.no-robot")
        elif stand.pose not in {each.name for each in robot.poses}:
            yield (*place, at, "pose"), message("outline.no-pose", robot=titled(robot))
        elif any(each.robot == stand.robot for each in step.where[:at]):
            yield (*place, at, "robot"), message("outline.twice-robot", robot=titled(robot))


def _nevers(outline: Outline) -> Iterator[_Found]:
    things = {each.id: each for each in things_of(outline)}
    for at, never in enumerate(outline.never):
        if not never.facts:
            yield ("never", at, "facts"), message("outline.no-facts")
        if "{" in never.title or "}" in never.title:
            yield ("never", at, "title"), message("outline.braces")
        wrong = False
        for where, facts in _parts(never):
            for number, fact in enumerate(facts):
                thing = things.get(fact.thing)
                wrong = wrong or thing is None or fact.value not in thing.values
                if thing is None:
                    yield ("never", at, where, number, "thing"), message("outline.no-thing")
                elif fact.value not in thing.values:
                    yield ("never", at, where, number, "value"), message("outline.no-value", thing=thing.title)
        if never.facts and not wrong and is_so_at_first((*never.facts, *never.during), outline):
            yield ("never", at), message("outline.at-first")
        elif never.facts and not wrong and is_on_the_way((*never.facts, *never.during), outline):
            yield ("never", at), message("outline.on-the-way")


def _parts(never: Never) -> Iterator[tuple[str, Sequence[Fact]]]:
    yield "facts", never.facts
    yield "during", never.during
