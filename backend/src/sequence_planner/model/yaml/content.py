"""What a YAML text says, whatever it looks like: entries by their path, equality, and the change that each edit is.

What changes a content does so in place, and returns it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from sequence_planner.model.paths import EditError, missing
from sequence_planner.model.yaml.reader import EntryPath

# Texts, numbers, truth values, lists and dicts of them, or nothing.
Content = Any


def same(one: object, other: object) -> bool:
    """Return whether two contents are equal, in their types and the order of their entries too.

    `2.0` is `2`: a browser knows one kind of number, and tells what it has read as the shorter one.
    """
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return list(map(str, one)) == list(map(str, other)) and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, str) and isinstance(other, str):
        return str(one) == str(other)
    numbers = all(isinstance(each, int | float) and not isinstance(each, bool) for each in (one, other))
    return (numbers or type(one) is type(other)) and (one == other or (_is_nan(one) and _is_nan(other)))


def _is_nan(value: object) -> bool:
    return isinstance(value, float) and math.isnan(value)


def plain(content: Content) -> Content:
    """The same with texts and names that know nothing of their places."""
    if isinstance(content, dict):
        return {str(key): plain(value) for key, value in content.items()}
    if isinstance(content, list):
        return [plain(value) for value in content]
    return str(content) if isinstance(content, str) else content


def content_at(content: Content, path: EntryPath) -> Content:
    """The content at `path`; raises with the way there where it does not exist."""
    for depth, step in enumerate(path):
        is_there = (isinstance(content, dict) and isinstance(step, str) and step in content) or (
            isinstance(content, list) and isinstance(step, int) and 0 <= step < len(content)
        )
        if not is_there:
            raise EditError(missing(path, depth, content))
        content = content[step]
    return content


def put_value(content: Content, path: EntryPath, value: object) -> Content:
    """`content` with a value at `path`."""
    content_at(content, path[:-1])[path[-1]] = value
    return content


def take_entry(content: Content, path: EntryPath) -> Content:
    """`content` without the entry at `path`."""
    del content_at(content, path[:-1])[path[-1]]
    return content


def add_entry(content: Content, parent: EntryPath, position: int, name: str | None, value: object) -> Content:
    """`content` with another entry of `parent`, which has a name in a mapping."""
    inside = content_at(content, parent)
    if name is None:
        inside.insert(position, value)
    else:
        pairs = list(inside.items())
        inside.clear()
        inside.update([*pairs[:position], (name, value), *pairs[position:]])
    return content


def rename_entry(content: Content, path: EntryPath, name: str) -> Content:
    """`content` with another name for the entry at `path`."""
    inside = content_at(content, path[:-1])
    pairs = [(name if key == path[-1] else key, value) for key, value in inside.items()]
    inside.clear()
    inside.update(pairs)
    return content


def move_entry(content: Content, parent: EntryPath, here: int, position: int) -> Content:
    """`content` with the entry of `parent` that is `here` at another position."""
    inside = content_at(content, parent)
    entries = list(inside.items()) if isinstance(inside, dict) else list(inside)
    entries.insert(position, entries.pop(here))
    inside.clear()
    if isinstance(inside, dict):
        inside.update(entries)
    else:
        inside.extend(entries)
    return content
