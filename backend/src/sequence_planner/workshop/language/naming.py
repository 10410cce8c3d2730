"""The names that can be written at a place, as many as there is room for: where there are more, their beginnings."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from sequence_planner.automaton.grounding.declarations import OPERATION
from sequence_planner.automaton.grounding.findings import without_arguments
from sequence_planner.workshop.language.completion import MOST_OPTIONS, Option, option
from sequence_planner.workshop.language.matching import NO_MATCH, likeness
from sequence_planner.workshop.language.names import Visible
from sequence_planner.workshop.language.visible import Sight
from sequence_planner.workshop.language_view import NameKind

_LEVELS = 5
_MOST_INSTANCES = 8  # of one declaration that are written out before its bracket is typed
_NO_VARIABLES = (NameKind.FLAG, NameKind.ACTIVITY)
_BRACKET = re.compile(r"[(\[]")
Match = tuple[int, Visible, bool]  # how well a family fits what is typed, and whether it is its full name that does


def name_options(
    sight: Sight, typed: str, wanted: Callable[[Visible], bool], room: int = MOST_OPTIONS
) -> list[tuple[int, Option]]:
    """The `wanted` families whose names fit what is typed, each with how well it does, the nearest first."""
    bracket = _BRACKET.search(typed)
    if bracket is not None:
        return [(0, each) for each in _with_arguments(sight, typed, wanted)]
    matches = sorted(_matches(sight, typed, wanted), key=lambda match: (match[0], match[1].distance))
    for level in range(_LEVELS):
        found = _at_level(sight, matches, typed, level, room)
        if len(found) <= room:
            return found
    return found


def resource_steps(sight: Sight, typed: str, wanted: Callable[[Visible], bool]) -> list[tuple[int, Option]]:
    """The resources, as the beginnings of their full names."""
    owners = dict.fromkeys(seen.family.step for seen in sight.families if wanted(seen))
    ranked = ((likeness(typed, owner), owner) for owner in owners if owner)
    return sorted(
        ((rank, _step_option(owner)) for rank, owner in ranked if rank < NO_MATCH),
        key=lambda each: each[0],
    )


def _matches(sight: Sight, typed: str, wanted: Callable[[Visible], bool]) -> Iterator[Match]:
    for seen in sight.families:
        if wanted(seen):
            short = likeness(typed, seen.short)
            long = likeness(typed, seen.long) if short and seen.own else NO_MATCH
            if short < NO_MATCH or long < NO_MATCH:
                yield min(short, long), seen, long < short


def _at_level(sight: Sight, matches: list[Match], typed: str, level: int, room: int) -> list[tuple[int, Option]]:
    """The options where `level` 0 writes all out but long lists of arguments, 1 leaves out the arguments of other
    resources, 2 all arguments, 3 what is no variable of other resources, and 4 all that other resources have.
    """
    found: dict[str, tuple[int, Option]] = {}
    for rank, seen, long in matches:
        family = seen.family
        is_far = not seen.own and family.step and not typed.startswith(family.step)
        if is_far and (level == 4 or (level == 3 and family.kind in _NO_VARIABLES)):
            if family.step not in found:
                found[family.step] = rank, _step_option(family.step)
        elif family.arguments and level and (level > 1 or not seen.own):
            stub = _stub(seen, long)
            found.setdefault(stub, (rank, option(stub, family.kind, "…")))
        else:
            forms = list(sight.forms(seen, long))
            if len(forms) > _MOST_INSTANCES:
                forms = [form for form in forms[:_MOST_INSTANCES] if sight.has_parameter(form)]
                found.setdefault(_stub(seen, long), (rank, option(_stub(seen, long), family.kind, "…")))
            for form in forms:
                found.setdefault(form, (rank, option(form, family.kind, family.type)))
        if len(found) > room:
            break
    return list(found.values())


def _with_arguments(sight: Sight, typed: str, wanted: Callable[[Visible], bool]) -> Iterator[Option]:
    """The names that begin with what is typed, which has arguments, or the beginning of some."""
    head = typed[: typed.index(next(sign for sign in typed if sign in "(["))]
    begun = _bare(typed)
    for seen in sight.families:
        if not seen.family.arguments or not wanted(seen):
            continue
        long = seen.family.name == head
        if long or (seen.own and seen.family.name.endswith(f".{head}") and seen.short.startswith(head)):
            for form in sight.forms(seen, long):
                if _bare(form).startswith(begun):
                    yield option(form, seen.family.kind, seen.family.type)


def _bare(text: str) -> str:
    return re.sub(r"\s", "", text).lower()


def _stub(seen: Visible, long: bool) -> str:
    """The name up to its arguments."""
    name = without_arguments(seen.long if long else seen.short).removesuffix(seen.family.suffix)
    return f"{name}{'[' if seen.family.indexed else '('}"


def _step_option(step: str) -> Option:
    return option(step, NameKind.OPERATION if step == f"{OPERATION}." else NameKind.RESOURCE)
