"""Facts of an outline: what they are about, as conditions of the model and as words."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from sequence_planner.editor.outline.outline import (
    Clamp,
    Device,
    Fact,
    Never,
    Outline,
    OutlineStep,
    OutlineThing,
    PersonDevice,
    Robot,
    Tool,
)
from sequence_planner.editor.outline.writing import all_of, titled

STEP = "step:"
# What a thing is at the beginning comes first.
_TOOL = {"idle": "idle", "running": "running"}
_CLAMP = {"open": "open", "closed": "closed"}
_PERSON = {"free": "free", "busy": "busy"}
_STEP = {"under_way": "under way"}


@dataclass(frozen=True)
class _Thing:
    """A thing, and the condition that it has one of its values."""

    view: OutlineThing
    condition: Callable[[str], str]


def things_of(outline: Outline) -> list[OutlineThing]:
    """Return the things that facts can be about."""
    return [each.view for each in _things(outline).values()]


def condition_of(facts: Sequence[Fact], outline: Outline) -> str:
    """Return the condition that all facts are so. Raises `KeyError` for a thing or value that is not there."""
    things = _things(outline)
    return all_of(_condition(things[each.thing], each) for each in facts)


def sentence_of(never: Never, outline: Outline) -> str:
    """Return what must never be in words, in English. Raises `KeyError` for a thing or value that is not there."""
    things = _things(outline)

    def conjoined(facts: Sequence[Fact]) -> str:
        return " and ".join(_told(things[each.thing].view, each) for each in facts)

    return f"Never {conjoined(never.facts)}" + (f" while {conjoined(never.during)}" if never.during else "")


def is_so_at_first(facts: Sequence[Fact], outline: Outline) -> bool:
    """Return whether all facts are so at the beginning. Raises `KeyError` for a thing that is not there."""
    things = _things(outline)

    def initial(thing: OutlineThing) -> str | None:
        return None if thing.kind == "step" else next(iter(thing.values))

    return all((initial(things[each.thing].view) == each.value) == each.holds for each in facts)


def is_on_the_way(facts: Sequence[Fact], outline: Outline) -> bool:
    """Return whether all facts are about the product alone, and are so in one of its states."""
    product = outline.product
    if any(each.thing != product.name for each in facts):
        return False
    return any(all((state.name == each.value) == each.holds for each in facts) for state in product.states)


def _condition(thing: _Thing, fact: Fact) -> str:
    if fact.value not in thing.view.values:
        raise KeyError(fact.value)
    condition = thing.condition(fact.value)
    if fact.holds:
        return condition
    return f"not {condition}" if condition.startswith("(") or " " not in condition else f"not ({condition})"


def _told(thing: OutlineThing, fact: Fact) -> str:
    verb = "is" if fact.holds else "is not"
    at = {"robot": "in the pose ", "step": ""}.get(thing.kind, "")
    return f"{thing.title} {verb} {at}{thing.values[fact.value]}"


def _things(outline: Outline) -> dict[str, _Thing]:
    """All things by their ids."""
    product = outline.product
    states = {each.name: titled(each) for each in product.states}
    found = [_of_device(each) for each in outline.devices]
    found.append(
        _Thing(
            OutlineThing(id=product.name, kind="product", title=titled(product), values=states),
            lambda state: f"{product.name} == {state}",
        )
    )
    found += [_of_step(each) for each in product.steps]
    return {each.view.id: each for each in found if each is not None}


def _of_step(step: OutlineStep) -> _Thing:
    name = f"{step.by}.{step.name}"
    view = OutlineThing(id=f"{STEP}{name}", kind="step", title=titled(step), values=_STEP)
    return _Thing(view, lambda _: f"{name}.executing")


def _of_device(device: Device) -> _Thing | None:
    name, title = device.name, titled(device)
    match device:
        case Robot():
            poses = {each.name: titled(each) for each in device.poses}
            # Where it is, and where it is sent: with one of both alone it could be on its way there.
            return _Thing(
                OutlineThing(id=name, kind="robot", title=title, values=poses),
                lambda pose: f"({name}.place == {pose} or {name}.target == {pose})",
            )
        case Tool():
            runs = f"({name}.run or {name}.is_running)"
            return _Thing(
                OutlineThing(id=name, kind="tool", title=title, values=_TOOL),
                lambda value: runs if value == "running" else f"not {runs}",
            )
        case Clamp():
            return _Thing(
                OutlineThing(id=name, kind="clamp", title=title, values=_CLAMP), lambda value: f"{name}.is_{value}"
            )
        case PersonDevice():
            asked = f"{name}.request != nothing"
            return _Thing(
                OutlineThing(id=name, kind="person", title=title, values=_PERSON),
                lambda value: asked if value == "busy" else f"{name}.request == nothing",
            )
        case _:
            return None
