"""Edits of a YAML text at the places of its nodes. `editing` checks what is asked for, and what comes out."""

from __future__ import annotations

import re
from collections.abc import Callable

from sequence_planner.model.composing import Node
from sequence_planner.model.entries import Entry, Layout
from sequence_planner.model.layout import WIDTH, fold, in_brackets, lines, literal, scalar
from sequence_planner.model.paths import EditError
from sequence_planner.model.reading import EntryPath

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


def _lines(layout: Layout, entry: Entry, value: object, head: str, column: int) -> list[str]:
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


def _comment(layout: Layout, entry: Entry) -> str:
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


def inserted(text: str, parent: EntryPath, position: int, name: str | None, value: object) -> str:
    """`text` with a new entry in the mapping or list at `parent`, before the one at `position` or at the end."""
    head = "-" if name is None else f"{scalar(name)}:"
    flat = in_brackets(value) if name is None else f"{scalar(name, '', True)}: {in_brackets(value)}"

    def block(column: int, like_neighbour: bool) -> list[str]:
        line = " " * column + f"{head} {in_brackets(value)}"
        return [line] if like_neighbour and value and len(line) <= WIDTH else lines(value, head, column)

    return _put(text, parent, position, flat, block)


def moved(text: str, path: EntryPath, position: int) -> str:
    """`text` with the entry at `path` at another position, which counts without it."""
    layout, way = _found(text, path)
    entry = layout.entry(way)
    own = layout.comments_above(way[-1][0], way[-1][1])
    raw = (text[own : layout.line_start(entry.start)] if own < entry.start else "") + " " * (
        entry.start - layout.line_start(entry.start)
    )
    raw_lines = (raw + text[entry.start : layout.line_end(entry.end)]).split("\n")
    return _put(
        removed(text, path), path[:-1], position, text[entry.start : entry.end], lambda _column, _in_brackets: raw_lines
    )


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


def _cut_behind_dash(layout: Layout, entry: Entry, following: Entry) -> str:
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


def _put(text: str, path: EntryPath, position: int, flat: str, block: Callable[[int, bool], list[str]]) -> str:
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
        raise EditError(f"line {line}: put the pair in braces, as in `[{{name: value}}]`, and it can be edited")


def _found(text: str, path: EntryPath) -> tuple[Layout, list[tuple[Node, int]]]:
    layout = Layout.of(text)
    assert layout is not None, "there is an entry, so there is a root"
    return layout, layout.find(path)


def _splice(text: str, begin: int, end: int, written: str) -> str:
    return text[:begin] + written + text[end:]
