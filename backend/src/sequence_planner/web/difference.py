"""The difference between two views: what changed, and what is gone.

The law that makes the stream right: whoever holds `old` and applies `difference(old, new)` holds `new`, to the letter.
Values are compared with their types, because Python calls `True` and `1` equal and a page does not.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from pydantic import BaseModel

from sequence_planner.control.view import StationView
from sequence_planner.web.stream_messages import StationChange, StationRemoval

MAPS = tuple(StationRemoval.__annotations__)


def difference(old: StationView, new: StationView) -> tuple[StationChange, StationRemoval]:
    """What to apply to `old` to get `new`: changed members (of maps, changed entries) and removed keys.

    `time` is always among the changes, so that whoever hears a delta also hears how fresh it is.
    """
    changed: dict[str, object] = {"time": new.time}
    removed: dict[str, list[str]] = {}
    for name in StationView.model_fields:
        before, after = getattr(old, name), getattr(new, name)
        if name not in MAPS:
            if not _same(before, after):
                changed[name] = after
            continue
        if entries := changed_entries(before, after):
            changed[name] = entries
        if gone := [key for key in before if key not in after]:
            removed[name] = gone
    # Both were built from the fields of StationView, whose names and types StationChange repeats.
    return cast(StationChange, changed), cast(StationRemoval, removed)


def changed_entries(old: Mapping[str, BaseModel], new: Mapping[str, BaseModel]) -> dict[str, BaseModel]:
    """The entries of `new` that are not, or not so, in `old`."""
    return {key: entry for key, entry in new.items() if key not in old or not _same(old[key], entry)}


def _same(old: object, new: object) -> bool:
    """Whether both are written as the same JSON, as far as these views go: equal, and of the same types throughout."""
    return old is new or (old == new and _same_types(old, new))


def _same_types(old: object, new: object) -> bool:
    """Whether what is equal is also of the same types, down to the values in it."""
    if old is new:
        return True
    if type(old) is not type(new):
        return False
    if isinstance(old, BaseModel):
        return _same_types(old.__dict__, new.__dict__)
    if isinstance(old, Mapping) and isinstance(new, Mapping):
        return all(_same_types(value, new[key]) for key, value in old.items())
    if isinstance(old, list | tuple) and isinstance(new, list | tuple):
        return all(map(_same_types, old, new))
    return True
