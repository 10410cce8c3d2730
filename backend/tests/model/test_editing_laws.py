"""The laws of editing: exactly that change, and no other line is lost, moved or rewritten."""

from __future__ import annotations

import copy
import difflib
import re

from hypothesis import assume, given
from hypothesis import strategies as st

from sequence_planner.model.yaml.content import Content
from sequence_planner.model.yaml.editor import insert, move, remove, rename, replace
from sequence_planner.model.yaml.reader import EntryPath, read_text
from support.examples import examples
from support.places import BOLT_TIGHTENING

TEXTS = {path.name: path.read_text(encoding="utf-8") for path in sorted(BOLT_TIGHTENING.glob("**/*.yaml"))}

# -- documents -------------------------------------------------------------------------------------------------------

words = st.text("ab:#=é😀\"' -", min_size=1, max_size=8)
plain = st.sampled_from(
    ["x", "pose == home", "a := b", "true", "yes", "1.5", "010", "not a", '"q: #"', "'it''s'", '"\\u00e9"']
)
values: st.SearchStrategy[Content] = st.recursive(
    st.one_of(
        words, st.booleans(), st.integers(-5, 99), st.floats(allow_nan=False), st.sampled_from(["l\nm\n", "l\n\n m"])
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.sampled_from(["p", "q", "r s", "010"]), inner, max_size=3)
    ),
    max_leaves=4,
)
names = st.lists(st.sampled_from(["a", "b", "c", '"d e"', "'f'", "g.h", "/i"]), min_size=1, max_size=3, unique=True)
above = st.sampled_from(["", "", "", "# about it\n", "\n", "\n# far\n\n# near\n", "\n\n"])
behind = st.sampled_from(["", "", " # note", "  # a, [b"])


@st.composite
def scalars(draw: st.DrawFn, column: int) -> str:
    margin = " " * column
    note = draw(behind)
    written: str = draw(
        st.one_of(
            plain.map(lambda text: f" {text}{note}\n"),
            plain.map(lambda text: f" {text}{note}\n"),
            st.just(f" >-{note}\n{margin}one two\n{margin}three\n"),
            st.just(f" >{note}\n{margin}one\n\n"),
            st.just(f" |{note}\n{margin}# no comment\n\n{margin}  b\n"),
            st.just(f" [a, {{b: 1, 'c': [x, y]}}, \"z\"]{note}\n"),
            st.just(f" {{a: 1, b: [{{c: d}}]}}{note}\n"),
            st.just(f" [ a,  # first\n{margin}b ]\n"),
            st.just(f" {{}}{note}\n"),
            st.just(f"{note}\n"),
        )
    )
    return written


@st.composite
def blocks(draw: st.DrawFn, column: int, depth: int) -> str:
    margin = " " * column
    is_list = column > 0 and draw(st.booleans())
    heads = ["-"] * draw(st.integers(1, 3)) if is_list else [f"{name}:" for name in draw(names)]
    written = ""
    for head in heads:
        comments = draw(above)
        written += "".join(f"{margin}{line}\n" if line else "\n" for line in comments.split("\n")[:-1])
        if depth and draw(st.booleans()):
            inner = draw(blocks(column + 2, depth - 1))
            if is_list:  # comments between a dash and what it holds belong to the entry
                inner = re.sub(r"\A(?: *(?:#.*)?\n)+", "", inner)
            compact = is_list and draw(st.booleans())
            between = " " + inner.lstrip(" ") if compact else draw(behind) + "\n" + inner
            written += f"{margin}{head}{between}"
        else:
            written += f"{margin}{head}{draw(scalars(column + 2))}"
    return written


documents = st.builds(
    lambda head, body: head + body, st.sampled_from(["", "# The file.\n", "# The file.\n\n"]), blocks(0, 3)
)


def paths_of(content: Content, path: EntryPath = ()) -> list[EntryPath]:
    inner = content.items() if isinstance(content, dict) else enumerate(content) if isinstance(content, list) else ()
    found: list[EntryPath] = [path] if path else []
    return found + [one for step, value in inner for one in paths_of(value, (*path, step))]


def content_of(text: str) -> Content:
    def unplaced(content: Content) -> Content:
        if isinstance(content, dict):
            return {str(key): unplaced(value) for key, value in content.items()}
        return [unplaced(value) for value in content] if isinstance(content, list) else content

    return unplaced(read_text(text, "file").content)


def at(content: Content, path: EntryPath) -> Content:
    for step in path:
        content = content[step]
    return content


def lost_and_new(old: str, new: str) -> tuple[list[str], list[str]]:
    diff = list(difflib.unified_diff(old.splitlines(), new.splitlines(), n=0, lineterm=""))[2:]
    return [line[1:] for line in diff if line[0] == "-"], [line[1:] for line in diff if line[0] == "+"]


# -- laws ------------------------------------------------------------------------------------------------------------


@examples(120)
@given(documents, st.data())
def test_replace_changes_that_and_nothing_else(text: str, data: st.DataObject) -> None:
    content = content_of(text)
    path = data.draw(st.sampled_from(paths_of(content)))
    value = data.draw(values)
    new = replace(text, path, value)
    expected = copy.deepcopy(content)
    at(expected, path[:-1])[path[-1]] = value
    assert content_of(new) == expected
    assert_kept(text, new, path)


@examples(60)
@given(documents, st.data(), plain)
def test_replacing_a_scalar_in_one_line_is_a_difference_of_one_line(text: str, data: st.DataObject, value: str) -> None:
    content = content_of(text)
    scalars_there = [path for path in paths_of(content) if isinstance(at(content, path), str | bool | float)]
    assume(scalars_there)
    path = data.draw(st.sampled_from(scalars_there))
    document = read_text(text, "file")
    assume("\n" not in getattr(at(document.content, path), "raw", ""))
    lost, new = lost_and_new(text, replace(text, path, value))
    assert len(lost) == len(new) <= 1


@examples(120)
@given(documents, st.data())
def test_what_was_inserted_is_removed_without_a_trace(text: str, data: st.DataObject) -> None:
    content = content_of(text)
    parents = [path for path in [(), *paths_of(content)] if isinstance(at(content, path), dict | list)]
    parent = data.draw(st.sampled_from(parents))
    siblings = at(content, parent)
    is_list = isinstance(siblings, list)
    keys: list[Content] = list(range(len(siblings))) if is_list else list(siblings)
    beside = data.draw(st.sampled_from([{}, *({how: key} for key in keys for how in ("before", "after"))]))
    position = keys.index(*beside.values()) + ("after" in beside) if beside else len(keys)
    step: str | int = position if is_list else "new"
    value = data.draw(values)
    with_it = insert(text, (*parent, step), value, **beside)
    entries = at(content_of(with_it), parent)
    assert list(entries if is_list else entries.values())[position] == value
    lost, _ = lost_and_new(text, with_it)
    assert len(lost) <= 1  # that of a list in brackets, or behind a dash
    assert remove(with_it, (*parent, step)) == text


@examples(120)
@given(documents, st.data())
def test_remove_takes_nothing_else_along(text: str, data: st.DataObject) -> None:
    path = data.draw(st.sampled_from(paths_of(content_of(text))))
    new = remove(text, path)
    expected = content_of(text)
    del at(expected, path[:-1])[path[-1]]
    assert content_of(new) == expected
    assert_kept(text, new, path)


@examples(60)
@given(documents, st.data(), st.sampled_from(["new", "n: #", "010"]))
def test_rename(text: str, data: st.DataObject, name: str) -> None:
    named = [path for path in paths_of(content_of(text)) if isinstance(path[-1], str)]
    path = data.draw(st.sampled_from(named))
    new = rename(text, path, name)
    assert at(content_of(new), (*path[:-1], name)) == at(content_of(text), path)
    lost, written = lost_and_new(text, new)
    assert len(lost) == len(written) == 1


@examples(60)
@given(documents, st.data())
def test_move_loses_nothing(text: str, data: st.DataObject) -> None:
    path = data.draw(st.sampled_from(paths_of(content_of(text))))
    siblings = at(content_of(text), path[:-1])
    keys: list[Content] = list(range(len(siblings))) if isinstance(siblings, list) else list(siblings)
    new = move(text, path, before=data.draw(st.sampled_from(keys)))
    assert characters(new) == characters(text)


@examples(200)
@given(documents, st.data())
def test_what_was_moved_and_moved_back_leaves_no_trace(text: str, data: st.DataObject) -> None:
    content = content_of(text)
    parents = [path for path in [(), *paths_of(content)] if isinstance(at(content, path), dict | list)]
    parent = data.draw(st.sampled_from([path for path in parents if at(content, path)]))
    siblings = at(content, parent)
    keys: list[Content] = list(range(len(siblings))) if isinstance(siblings, list) else list(siblings)
    here, there = (data.draw(st.integers(0, len(keys) - 1)) for _ in range(2))
    beside = {"before": keys[there]} if there < here else {"after": keys[there]}
    new = move(text, (*parent, keys[here]), **beside)
    moved = at(content_of(new), parent)
    order = [*keys]
    order.insert(there, order.pop(here))
    if isinstance(moved, list):
        assert moved == [siblings[int(str(key))] for key in order]
        step, back = there, {"before": here} if here < there else {"after": here}
    else:
        assert [*moved] == order
        step, back = keys[here], {"before" if here < there else "after": order[here]}
    again = move(new, (*parent, step), **back)
    if parent == () and again != text:  # a blank line keeps the comment of the first entry from being one of the file
        again, text = ("".join(line for line in each.splitlines(True) if line.strip()) for each in (again, text))
    assert again == text


def characters(text: str) -> list[str]:
    return sorted(text.translate({ord(sign): None for sign in " \n,"}))


def outside(text: str, path: EntryPath) -> list[str]:
    """The lines above the entry at `path` (but for the comments directly above it) and below it."""
    document = read_text(text, "file")
    line = document.place(path).line - 1
    lines = text.split("\n")
    top = line
    while top and re.fullmatch(r" *-( +#.*)?", lines[top - 1]):  # its dash has a line of its own
        top -= 1
    while top and lines[top - 1].lstrip().startswith("#"):
        top -= 1
    following = [
        place.line - 1
        for other, place in document.places.items()
        if other[: len(path)] != path and place.line - 1 > line
    ]
    below = min(following, default=len(lines))
    return lines[:top] + lines[below:]


def assert_kept(text: str, new: str, path: EntryPath) -> None:
    """The lines outside of the entry are in the new text, in their order, but for one, which may hold `[]` now."""
    kept = [line for line in outside(text, path) if not re.fullmatch(r" *(-( +#.*)?)?", line)]
    assert common(kept, new.split("\n")) >= len(kept) - 1, new


def common(one: list[str], other: list[str]) -> int:
    """How many lines both have in the same order."""
    best = [0] * (len(other) + 1)
    for line in one:
        above = best
        best = [0]
        for index, candidate in enumerate(other):
            best.append(above[index] + 1 if line == candidate else max(best[-1], above[index + 1]))
    return best[-1]
