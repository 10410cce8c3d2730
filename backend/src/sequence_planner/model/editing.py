"""Editing YAML without losing anything: an edit changes the lines of its entry, and every other byte stays.

An entry is named by its path of names and indices, as in `("abilities", "run_nut", "enabled")`. Each edit is read again
before it is returned: its content must be the old one with exactly that change.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from sequence_planner.model import splicing
from sequence_planner.model.paths import EditError, missing, shown_path
from sequence_planner.model.reading import EntryPath, read_text
from sequence_planner.model.source import ModelError

_NOT_HERE = "this cannot be edited here without rewriting what is around it: edit it by hand; nothing was changed"

# Texts, numbers, truth values, lists and dicts of them, or nothing.
Content = Any


def replace(text: str, path: EntryPath, value: object) -> str:
    """Give the entry at `path` another value. Of lists and dicts only what differs is touched. Raises `EditError`."""
    old = content_at(_content(text), path)
    if same(old, value):
        return text
    if isinstance(old, dict) and isinstance(value, Mapping) and old and value:
        return _replace_mapping(text, path, old, value)
    if isinstance(old, list) and isinstance(value, list | tuple) and old and value:
        return _replace_list(text, path, old, list(value))
    if not path:
        raise EditError("the whole document cannot be replaced: name an entry")
    return _verified(text, splicing.replaced(text, path, value), lambda content: _put(content, path, value))


def insert(
    text: str, path: EntryPath, value: object, *, before: str | int | None = None, after: str | int | None = None
) -> str:
    """Add an entry at the end of its mapping or list, or beside the sibling named. Raises `EditError`.

    In a list the last step of `path` is not looked at: the entry gets the index of the place where it is inserted.
    """
    parent = path[:-1]
    content = content_at(_content(text), parent)
    if not isinstance(content, dict | list):
        raise EditError(f"`{shown_path(parent)}` holds no entries, so none can be added: replace it")
    if isinstance(content, dict) and path[-1] in content:
        raise EditError(f"`{shown_path(path)}` is there already: replace it")
    position = _position(content, parent, before, after)
    name = str(path[-1]) if isinstance(content, dict) else None
    return _verified(
        text,
        splicing.inserted(text, parent, position, name, value),
        lambda old: _add(old, parent, position, name, value),
    )


def remove(text: str, path: EntryPath) -> str:
    """Take an entry out, with the comments directly above it. Raises `EditError`."""
    if not path:
        raise EditError("the whole document cannot be removed")
    content_at(_content(text), path)
    return _verified(text, splicing.removed(text, path), lambda content: _take(content, path))


def rename(text: str, path: EntryPath, name: str) -> str:
    """Give the entry at `path` another name in the same place. Raises `EditError`."""
    content = _content(text)
    content_at(content, path)
    if not path or not isinstance(path[-1], str):
        raise EditError("only an entry with a name can be renamed")
    if name in content_at(content, path[:-1]):
        raise EditError(f"`{shown_path((*path[:-1], name))}` is there already")
    return _verified(text, splicing.renamed(text, path, name), lambda old: _call(old, path, name))


def move(text: str, path: EntryPath, *, before: str | int | None = None, after: str | int | None = None) -> str:
    """Put an entry elsewhere among its siblings, with the comments directly above it. Raises `EditError`.

    It goes to the end, or beside the sibling named; siblings of a list are named by their present index.
    """
    parent = path[:-1]
    siblings = content_at(_content(text), parent)
    content_at(siblings, path[-1:])
    here = path[-1] if isinstance(path[-1], int) else [str(key) for key in siblings].index(path[-1])
    position = _position(siblings, parent, before, after)
    position -= here < position
    if position == here:
        return text
    return _verified(
        text, splicing.moved(text, path, position), lambda content: _shift(content, parent, here, position)
    )


def value_at(text: str, path: EntryPath) -> Content:
    """The value of the entry at `path`, with texts that know nothing of their places. Raises `EditError`."""
    return content_at(plain(_content(text)), path)


def _replace_mapping(text: str, path: EntryPath, old: dict[str, Content], new: Mapping[str, Content]) -> str:
    for key in [str(key) for key in old if key in new]:
        text = replace(text, (*path, key), new[key])
    for key in new:
        if key not in old:
            text = insert(text, (*path, str(key)), new[key])
    for key in [str(key) for key in old if key not in new]:
        text = remove(text, (*path, key))
    return text


def _replace_list(text: str, path: EntryPath, old: list[Content], new: list[Content]) -> str:
    shared = min(len(old), len(new))
    above = next((at for at in range(shared) if not same(old[at], new[at])), shared)
    below = next((at for at in range(shared - above) if not same(old[-1 - at], new[-1 - at])), shared - above)
    for index in range(above, shared - below):
        text = replace(text, (*path, index), new[index])
    for index in range(shared - below, len(new) - below):
        beside = {"before": index} if index < len(old) + index - shared + below else {}
        text = insert(text, (*path, index), new[index], **beside)
    for index in reversed(range(shared - below, len(old) - below)):
        text = remove(text, (*path, index))
    return text


def _position(
    content: dict[str, Content] | list[Content], parent: EntryPath, before: str | int | None, after: str | int | None
) -> int:
    siblings: list[str | int] = [str(key) for key in content] if isinstance(content, dict) else [*range(len(content))]
    for sibling, offset in ((before, 0), (after, 1)):
        if sibling is not None:
            if sibling not in siblings:
                raise EditError(missing((*parent, sibling), len(parent), content))
            return siblings.index(sibling) + offset
    return len(siblings)


def same(one: object, other: object) -> bool:
    """Whether two contents are equal, in their types and the order of their entries too."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return list(map(str, one)) == list(map(str, other)) and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, str) and isinstance(other, str):
        return str(one) == str(other)
    return type(one) is type(other) and (one == other or (one != one and other != other))  # noqa: PLR0124


def _content(text: str) -> Content:
    try:
        return read_text(text, "line").content
    except ModelError as error:
        raise EditError(f"it cannot be edited before it can be read: {error.findings[0]}") from error


def _verified(text: str, new: str, change: Callable[[Content], Content]) -> str:
    """`new`, if its content is that of `text` with `change` made to it."""
    expected = change(plain(_content(text)))
    try:
        found = read_text(new, "line").content
    except ModelError as error:
        raise EditError(f"{_NOT_HERE} (it could not be read afterwards: {error.findings[0].message})") from error
    if not same(expected, found):
        raise EditError(f"{_NOT_HERE} (something else would change with it)")
    return new


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


def _put(content: Content, path: EntryPath, value: object) -> Content:
    content_at(content, path[:-1])[path[-1]] = value
    return content


def _take(content: Content, path: EntryPath) -> Content:
    del content_at(content, path[:-1])[path[-1]]
    return content


def _add(content: Content, parent: EntryPath, position: int, name: str | None, value: object) -> Content:
    inside = content_at(content, parent)
    if name is None:
        inside.insert(position, value)
    else:
        pairs = list(inside.items())
        inside.clear()
        inside.update([*pairs[:position], (name, value), *pairs[position:]])
    return content


def _call(content: Content, path: EntryPath, name: str) -> Content:
    inside = content_at(content, path[:-1])
    pairs = [(name if key == path[-1] else key, value) for key, value in inside.items()]
    inside.clear()
    inside.update(pairs)
    return content


def _shift(content: Content, parent: EntryPath, here: int, position: int) -> Content:
    inside = content_at(content, parent)
    entries = list(inside.items()) if isinstance(inside, dict) else list(inside)
    entries.insert(position, entries.pop(here))
    inside.clear()
    if isinstance(inside, dict):
        inside.update(entries)
    else:
        inside.extend(entries)
    return content
