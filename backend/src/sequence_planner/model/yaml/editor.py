"""YAML editing that preserves all other bytes: formatting of values, edit operations."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.scalarstring import DoubleQuotedScalarString, SingleQuotedScalarString

from sequence_planner.model.paths import EditError, missing, shown_path
from sequence_planner.model.source import ModelError
from sequence_planner.model.yaml.content import (
    Content,
    add_entry,
    content_at,
    move_entry,
    plain,
    put_value,
    rename_entry,
    same,
    take_entry,
)
from sequence_planner.model.yaml.layout import Layout, YamlEntry
from sequence_planner.model.yaml.reader import EntryPath, Node, compose, read_text
from sequence_planner.texts.message import message

# How values are written in YAML documents: two spaces, indented lists, short lists in one line, long texts folded.

WIDTH = 120
_BETWEEN_WORDS = re.compile(r"(?<=\S) (?=\S)")
_QUOTED = {'"': DoubleQuotedScalarString, "'": SingleQuotedScalarString}


def scalar(value: object, style: str = "", in_brackets: bool = False) -> str:
    """A value that is no list or mapping, in one line. A text is quoted by `style` (`'`, `"`), or where it must be."""
    yaml = YAML()
    yaml.width = 1_000_000_000
    yaml.default_flow_style = in_brackets
    yaml.representer.add_representer(type(None), lambda one, _: one.represent_scalar("tag:yaml.org,2002:null", "null"))
    text: object = value
    if isinstance(value, str):
        if "\n" in value or any(ord(character) < 32 for character in value):
            style = '"'
        text = _QUOTED.get(style, str)(value)
    stream = io.StringIO()
    yaml.dump([text], stream)
    written = stream.getvalue().rstrip("\n")
    return written[1:-1] if in_brackets else written[2:]


def in_brackets(value: object) -> str:
    """A value in one line."""
    match value:
        case Mapping():
            pairs = (f"{scalar(key, '', True)}: {in_brackets(inner)}" for key, inner in value.items())
            return "{" + ", ".join(pairs) + "}"
        case str():
            return scalar(value, in_brackets=True)
        case Sequence():
            return "[" + ", ".join(map(in_brackets, value)) + "]"
    return scalar(value, in_brackets=True)


def lines(value: object, name: str, column: int) -> list[str]:
    """The lines of an entry at `column`; `name` is what stands before its value, such as `key:` or `-`."""
    margin = " " * column
    if isinstance(value, str) and "\n" in value and (written := literal(value, column + 2)):
        return [f"{margin}{name} {written[0]}", *written[1:]]
    if not value or not isinstance(value, Mapping | list | tuple):
        empty_or_scalar = in_brackets(value) if isinstance(value, Mapping | list | tuple) else scalar(value)
        line = f"{margin}{name} {empty_or_scalar}"
        if len(line) > WIDTH and isinstance(value, str) and (folded := fold(value, column + 2)):
            return [f"{margin}{name} >-", *folded]
        return [line]
    if isinstance(value, Mapping):
        inner = [line for key, one in value.items() for line in lines(one, f"{scalar(key)}:", column + 2)]
    else:
        line = f"{margin}{name} {in_brackets(value)}"
        if len(line) <= WIDTH and not any(isinstance(one, Mapping | list | tuple) for one in value):
            return [line]
        inner = [line for one in value for line in lines(one, "-", column + 2)]
    if name == "-":  # the first line of what is inside stands behind the dash
        return [f"{margin}- {inner[0].lstrip(' ')}", *inner[1:]]
    return [f"{margin}{name}", *inner]


def fold(text: str, column: int, old: Sequence[str] = ()) -> list[str]:
    """The lines of a folded text, or none if it cannot be folded. Lines of `old` at its beginning and end are kept."""
    if not text or text != text.strip() or "\n" in text or not text.isprintable():
        return []
    above, below = _kept(text, [line.strip() for line in old])
    start = sum(len(line) + 1 for line in above)
    middle = text[start : len(text) - sum(len(line) + 1 for line in below)]
    wrapped: list[str] = []
    for word in _BETWEEN_WORDS.split(middle) if middle else []:
        if wrapped and column + len(wrapped[-1]) + 1 + len(word) <= WIDTH:
            wrapped[-1] += f" {word}"
        else:
            wrapped.append(word)
    return [" " * column + line for line in (*above, *wrapped, *below)]


def _kept(text: str, old: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return which lines of a folded text can stay above and below those that change."""
    above: list[str] = []
    while len(above) < len(old) and text.startswith(" ".join([*above, old[len(above)], ""])):
        above.append(old[len(above)])
    rest = text[sum(len(line) + 1 for line in above) :]
    below: list[str] = []
    while len(above) + len(below) < len(old) and rest.endswith(" ".join(["", old[-1 - len(below)], *below])):
        below.insert(0, old[-1 - len(below)])
    if len(above) + len(below) == len(old):  # words were put between two lines: into one of them
        if below:
            below.pop(0)
        elif above:
            above.pop()
    return above, below


def literal(text: str, column: int) -> list[str]:
    """The header and the lines of a text whose line breaks are kept, or nothing if only quotes can write it."""
    body = text.removesuffix("\n").split("\n")
    if not all(line.isprintable() and line == line.rstrip() for line in body) or not body[0] or not body[-1]:
        return []
    if body[0].startswith(" "):
        return []
    margin = " " * column
    return ["|" if text.endswith("\n") else "|-", *(margin + line if line else "" for line in body)]


# Edits of a YAML text at the places of its nodes. `editor` checks what is asked for, and what comes out.

NARROW = 80
_HEADER_COMMENT = re.compile(r"[|>][-+0-9]*([ ]+#[^\n]*)?")


def replaced(text: str, path: EntryPath, value: object) -> str:
    """`text` with `value` at `path`."""
    layout, way = _found(text, path)
    entry = layout.entry(way)
    layout.refuse_shared(way, entry)
    node = entry.node
    quotes = node.style if node.style in ("'", '"') and not entry.is_alias else ""
    begin = entry.value_start if entry.is_alias else layout.skip_properties(node)
    is_empty = entry.value_start == entry.end
    if way[-1][0].style:
        written = scalar(value, quotes, True) if isinstance(value, str) else in_brackets(value)
        colon = ":" if entry.key is not None and text[entry.head - 1] != ":" else ""
        return (
            text[: entry.head] + f"{colon} {written}" + text[entry.end :]
            if is_empty
            else _splice(text, begin, entry.end, written)
        )
    column = entry.start - layout.line_start(entry.start)
    head = text[entry.start : entry.head]
    if quotes and isinstance(value, str) and "\n" not in value:
        return _splice(text, begin, entry.end, scalar(value, quotes))
    written_lines = _lines(layout, entry, value, head, column)
    inline, rest = written_lines[0][column + len(head) :], written_lines[1:]
    is_one_line = "\n" not in text[entry.head : entry.end]
    if is_one_line and inline and not rest and not is_empty:
        return _splice(text, begin, entry.end, inline[1:])
    comment = _comment(layout, entry)
    below = "".join(f"\n{line}" for line in rest)
    return text[: entry.head] + inline + comment + below + text[layout.line_end(entry.end) :]


def _lines(layout: Layout, entry: YamlEntry, value: object, head: str, column: int) -> list[str]:
    """The lines of an entry with a new value, folded as it was."""
    written = lines(value, head, column)
    if entry.is_alias or entry.node.style not in ("|", ">") or not isinstance(value, str):
        return written
    text = value.removesuffix("\n")
    body = [line for line in layout.text[entry.value_start : entry.end].split("\n")[1:] if line.strip()]
    margin = len(body[0]) - len(body[0].lstrip(" ")) if body else column + 2
    if entry.node.style == ">" and "\n" not in text:
        one_line = " " * column + head + " " + scalar(value)
        room = WIDTH if len(body) > 1 else NARROW  # what was folded without need stays so
        is_short = len(one_line) + len(_comment(layout, entry)) <= room and text == value
        if not is_short and (folded := fold(text, margin, body)):
            return [f"{' ' * column}{head} {'>-' if text == value else '>'}", *folded]
        return [one_line]
    if "\n" in value and (kept := literal(value, margin)):
        return [f"{' ' * column}{head} {kept[0]}", *kept[1:]]
    return written


def _comment(layout: Layout, entry: YamlEntry) -> str:
    """The comment that stands in the line of an entry's name, or behind its value."""
    text = layout.text
    if entry.node.style in ("|", ">") and not entry.is_alias:
        found = _HEADER_COMMENT.match(text, layout.skip_properties(entry.node))
        return (found and found[1]) or ""
    is_below = "\n" in text[entry.head : entry.value_start]
    if is_below and entry.node.kind != "scalar":
        return text[entry.head : layout.line_end(entry.head)].rstrip()
    if entry.node.kind != "scalar" and not entry.node.style and not entry.is_alias:
        return ""
    return text[entry.end : layout.line_end(entry.end)].rstrip()


def renamed(text: str, path: EntryPath, name: str) -> str:
    """`text` with another name for the entry at `path`."""
    layout, way = _found(text, path)
    layout.refuse_shared(way[:-1], None)
    key = layout.entry(way).key
    assert key is not None
    quotes = key.style if key.style in ("'", '"') else ""
    written = scalar(name, quotes, in_brackets=bool(way[-1][0].style))
    return _splice(text, layout.skip_properties(key), layout.end_of(key), written)


def inserted(
    text: str, parent: EntryPath, position: int, name: str | None, value: object, written: str | None = None
) -> str:
    """`text` with a new entry in the mapping or list at `parent`, before the one at `position` or at the end.

    In a block it is `written` so, where that is said.
    """
    head = "-" if name is None else f"{scalar(name)}:"
    flat = in_brackets(value) if name is None else f"{scalar(name, '', True)}: {in_brackets(value)}"

    def block(column: int, like_neighbour: bool) -> list[str]:
        if written is not None:
            return _as_written(written, head, column)
        line = " " * column + f"{head} {in_brackets(value)}"
        return [line] if like_neighbour and value and len(line) <= WIDTH else lines(value, head, column)

    return _splice_in(text, parent, position, flat, block)


def _as_written(written: str, head: str, column: int) -> list[str]:
    """The lines of an entry at `column` whose value is `written` so; comments it begins with stand above it."""
    body = written.strip("\n").split("\n")
    start = next((at for at, line in enumerate(body) if line and not line.startswith("#")), 0)
    margin, inner = " " * column, " " * (column + 2)
    above = [f"{margin}{line}".rstrip() for line in body[:start]]
    root = compose(written)
    is_below = head != "-" and root is not None and root.kind != "scalar" and not root.style
    first = [f"{margin}{head}", f"{inner}{body[start]}"] if is_below else [f"{margin}{head} {body[start]}"]
    return [*above, *first, *(f"{inner}{line}" if line else "" for line in body[start + 1 :])]


def moved(text: str, path: EntryPath, position: int) -> str:
    """`text` with the entry at `path` at another position, which counts without it, and its comments.

    What stands between entries, such as blank lines, stays where it is: moved back, all is as it was.
    """
    layout, way = _found(text, path)
    parent, here = way[-1]
    if len(way) > 1:  # an anchor goes along; that it still stands before its aliases is seen when it is read again
        layout.refuse_shared(way[:-1], None)
    extents = layout.extents(parent)
    entries = [text[begin:end] for begin, end in extents]
    between = [text[end:begin] for (_, end), (begin, _) in pairwise(extents)]
    entries.insert(position, entries.pop(here))
    head = text[: extents[0][0]]
    if len(way) == 1 and entries[0].startswith("#") and all(line.startswith("#") for line in head.splitlines()):
        head += "\n"  # or it would be a comment about the file
    return head + "".join(map("".join, zip(entries, [*between, ""], strict=True))) + text[extents[-1][1] :]


def removed(text: str, path: EntryPath) -> str:
    """`text` without the entry at `path`, the comments directly above it, and the blank lines that set it apart."""
    layout, way = _found(text, path)
    parent, position = way[-1]
    entries = layout.entries(parent)
    entry = entries[position]
    layout.refuse_shared(way, entry)
    if parent.style:
        return _cut_in_brackets(layout, parent, position)
    if len(entries) == 1:
        if len(path) > 1:
            return _emptied(layout, path[:-1], way)
        nothing = "" if parent.kind == "mapping" else "[]"
        return text[: layout.line_start(entry.start)] + nothing + text[layout.line_end(entry.end) :]
    if text[layout.line_start(entry.start) : entry.start].strip():
        return _cut_behind_dash(layout, entry, entries[1])
    begin, end = layout.comments_above(parent, position), layout.line_end(entry.end)
    above, below = layout.blank_above(begin), layout.blank_below(end)
    if position == 0:
        end += below
    elif below or position == len(entries) - 1:
        begin -= above
    if end < len(text):
        return text[:begin] + text[end + 1 :]
    return text[: begin - 1]  # the last line of a text that does not end with a line break


def _emptied(layout: Layout, path: EntryPath, way: list[tuple[Node, int]]) -> str:
    """Without the only entry of what stands at `path`. Comments that are set apart from that entry stay there."""
    text, (parent, _), whole = layout.text, way[-1], layout.entry(way[:-1])
    new = replaced(text, path, {} if parent.kind == "mapping" else [])
    apart = text[layout.line_end(whole.head) : layout.comments_above(parent, 0)].rstrip()
    if "#" not in apart:
        return new
    end = len(new) - len(text) + layout.line_end(whole.end)
    return new[:end] + apart + new[end:]


def _cut_behind_dash(layout: Layout, entry: YamlEntry, following: YamlEntry) -> str:
    """Without the first entry of a mapping that stands behind a dash; the second one moves up."""
    text, end = layout.text, layout.line_end(entry.end)
    if "#" in text[end : following.start]:
        return text[: entry.start].rstrip(" ") + text[end:]
    return text[: entry.start] + text[following.start :]


def _cut_in_brackets(layout: Layout, parent: Node, position: int) -> str:
    text, entries = layout.text, layout.entries(parent)
    entry = entries[position]
    _refuse_bare_pair(layout, parent)
    after = re.compile(r"\s*,").match(text, entry.end)
    if position + 1 < len(entries):
        end = entries[position + 1].start
        if not after or re.search(r"[#\n]", text[entry.end : end]):
            end = after.end() if after else entry.end
        return text[: entry.start] + text[end:]
    if position == 0:
        return text[: entry.start] + text[after.end() if after else entry.end :]
    before = re.compile(r"\s*,").match(text, entries[position - 1].end)
    if after or not before:
        return text[: entry.start].rstrip(" ") + text[after.end() if after else entry.end :]
    if "#" in text[before.end() : entry.start]:
        return text[: before.end()] + text[before.end() : entry.start] + text[entry.end :]
    return text[: before.end() - 1] + text[entry.end :]


def _splice_in(text: str, path: EntryPath, position: int, flat: str, block: Callable[[int, bool], list[str]]) -> str:
    """`text` with a new entry, which in brackets is `flat`, and else has the lines `block`.

    `block` is told the column, and whether the entry beside it is a mapping in brackets.
    """
    layout = Layout.of(text)
    if layout is None:
        above = text if not text or text.endswith("\n") else text + "\n"
        return above + "\n".join(block(0, False)) + "\n"
    way = layout.find(path)
    layout.refuse_shared(way, None)
    parent = layout.entry(way).node if way else layout.root
    entries = layout.entries(parent)
    if parent.style:
        _refuse_bare_pair(layout, parent)
        if not entries:
            return _splice(text, layout.skip_properties(parent) + 1, layout.skip_properties(parent) + 1, flat)
        if position < len(entries):
            return _splice(text, entries[position].start, entries[position].start, f"{flat}, ")
        return _splice(text, entries[-1].end, entries[-1].end, f", {flat}")
    first = entries[0].start
    column = first - layout.line_start(first)
    neighbour = entries[min(position, len(entries) - 1)].node
    written = "\n".join(block(column, neighbour.style == "{" and neighbour.kind == "mapping"))
    near = min(max(position, 1), len(entries) - 1)
    gap = layout.blank_above(layout.comments_above(parent, near)) if len(entries) > 1 else 0
    if position == len(entries):
        end = layout.line_end(entries[-1].end)
        return f"{text[:end]}\n" + "\n" * gap + written + text[end:]
    if position == 0 and text[layout.line_start(first) : first].strip():
        return text[:first] + written.lstrip(" ") + "\n" + " " * column + text[first:]
    at = layout.comments_above(parent, position)
    return text[:at] + written + "\n" * (gap + 1) + text[at:]


def _refuse_bare_pair(layout: Layout, parent: Node) -> None:
    if layout.text[layout.skip_properties(parent)] not in "[{":
        line = layout.line(parent.start.index)
        raise EditError(message("edit.bare-pair", line=line, form="[{name: value}]"))


def _found(text: str, path: EntryPath) -> tuple[Layout, list[tuple[Node, int]]]:
    layout = Layout.of(text)
    assert layout is not None, "there is an entry, so there is a root"
    return layout, layout.find(path)


def _splice(text: str, begin: int, end: int, written: str) -> str:
    return text[:begin] + written + text[end:]


# Editing YAML without losing anything: an edit changes the lines of its entry, and every other byte stays.
#
# An entry is named by its path of names and indices, as in `("abilities", "run_nut", "enabled")`. Each edit is read
# again before it is returned: its content must be the old one with exactly that change.


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
        raise EditError(message("edit.whole-replaced"))
    return _verified(text, replaced(text, path, value), lambda content: put_value(content, path, value))


def insert(
    text: str,
    path: EntryPath,
    value: object,
    *,
    before: str | int | None = None,
    after: str | int | None = None,
    written: str | None = None,
) -> str:
    """Add an entry at the end of its mapping or list, or beside the sibling named. Raises `EditError`.

    In a list the last step of `path` is not looked at: the entry gets the index of the place where it is inserted.
    `written` is the YAML of its value with comments: it stands so, where it says there what `value` says.
    """
    parent = path[:-1]
    content = content_at(_content(text), parent)
    if not isinstance(content, dict | list):
        raise EditError(message("edit.no-entries", path=shown_path(parent)))
    if isinstance(content, dict) and path[-1] in content:
        raise EditError(message("edit.there-already-replace", path=shown_path(path)))
    position = _position(content, parent, before, after)
    name = str(path[-1]) if isinstance(content, dict) else None

    def added(old: Content) -> Content:
        return add_entry(old, parent, position, name, value)

    if written is not None and written.strip():
        try:
            return _verified(text, inserted(text, parent, position, name, value, written), added)
        except (EditError, YAMLError):
            pass  # comments are not worth that nothing is added
    return _verified(text, inserted(text, parent, position, name, value), added)


def remove(text: str, path: EntryPath) -> str:
    """Take an entry out, with the comments directly above it. Raises `EditError`."""
    if not path:
        raise EditError(message("edit.whole-removed"))
    content_at(_content(text), path)
    return _verified(text, removed(text, path), lambda content: take_entry(content, path))


def comment(text: str, path: EntryPath, comments: Sequence[str]) -> str:
    """Put lines of comment above the entry at `path`; the text as it was where that would change what it says."""
    layout = Layout.of(text)
    if layout is None or not comments:
        return text
    at = layout.line_start(layout.entry(layout.find(path)).start)
    line = text[at : layout.line_end(at)]
    margin = line[: len(line) - len(line.lstrip(" "))]
    commented = text[:at] + "".join(f"{margin}# {each}\n" for each in comments) + text[at:]
    return commented if same(_content(text), _content(commented)) else text


def rename(text: str, path: EntryPath, name: str) -> str:
    """Give the entry at `path` another name in the same place. Raises `EditError`."""
    content = _content(text)
    content_at(content, path)
    if not path or not isinstance(path[-1], str):
        raise EditError(message("edit.only-named"))
    if name in content_at(content, path[:-1]):
        raise EditError(message("edit.there-already", path=shown_path((*path[:-1], name))))
    return _verified(text, renamed(text, path, name), lambda old: rename_entry(old, path, name))


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

    def reordered(content: Content) -> Content:
        return move_entry(content, parent, here, position)

    try:
        return _verified(text, moved(text, path, position), reordered)
    except EditError:
        layout, way = _found(text, path)
        layout.refuse_shared(way, layout.entry(way))  # which says what stands in the way
        spelled = _spelled_out(text, path)
        if spelled == text:
            raise
        return _verified(spelled, moved(spelled, path, position), reordered)


def _spelled_out(text: str, path: EntryPath) -> str:
    """`text` with the values in the entry at `path` for which aliases stand there."""
    layout, way = _found(text, path)
    content = plain(_content(text))
    for each in list(_alias_paths(layout, layout.entry(way), path)):
        text = _verified(text, replaced(text, each, content_at(content, each)), lambda same_as_before: same_as_before)
    return text


def _alias_paths(layout: Layout, entry: YamlEntry, path: EntryPath) -> Iterator[EntryPath]:
    if entry.is_alias:
        yield path
    elif entry.node.kind != "scalar":
        for index, inner in enumerate(layout.entries(entry.node)):
            yield from _alias_paths(layout, inner, (*path, index if inner.key is None else str(inner.key.value)))


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
        before = index if index < len(old) + index - shared + below else None
        text = insert(text, (*path, index), new[index], before=before)
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


def _content(text: str) -> Content:
    try:
        return read_text(text, "line").content
    except ModelError as error:
        first = error.findings[0]
        raise EditError(message("edit.unreadable", place=str(first.place), what=first.message)) from error


def _verified(text: str, new: str, change: Callable[[Content], Content]) -> str:
    """`new`, if its content is that of `text` with `change` made to it."""
    expected = change(plain(_content(text)))
    try:
        found = read_text(new, "line").content
    except ModelError as error:
        raise EditError(message("edit.not-here.unreadable", why=error.findings[0].message)) from error
    if not same(expected, found):
        raise EditError(message("edit.not-here.else"))
    return new
