"""Editing documents: what a change looks like, and what is refused."""

from __future__ import annotations

import difflib

import pytest

from sequence_planner.model.paths import EditError, parse_path, shown_path
from sequence_planner.model.yaml.content import Content
from sequence_planner.model.yaml.editor import insert, move, remove, rename, replace, value_at
from sequence_planner.model.yaml.reader import EntryPath, read_text
from support.places import BOLT_TIGHTENING

TEXTS = {path.name: path.read_text(encoding="utf-8") for path in sorted(BOLT_TIGHTENING.glob("**/*.yaml"))}
KEYS_OF_GUARDS = ("enabled", "executing", "when", "precondition", "goal", "forbidden", "rest")


def entries(content: Content, path: EntryPath = ()) -> list[tuple[EntryPath, Content]]:
    """All entries of a document."""
    inner = content.items() if isinstance(content, dict) else enumerate(content) if isinstance(content, list) else ()
    return [(path, content), *(entry for step, value in inner for entry in entries(value, (*path, step)))]


GUARDS = [
    pytest.param(name, path, str(guard), id=f"{name}:{shown_path(path)}")
    for name, text in TEXTS.items()
    for path, guard in entries(read_text(text, name).content)
    if path and path[-1] in KEYS_OF_GUARDS
]


@pytest.mark.parametrize(("name", "path", "guard"), GUARDS)
def test_a_change_of_one_guard_is_a_difference_of_one_line(name: str, path: EntryPath, guard: str) -> None:
    changed = guard.replace("==", "!=", 1) if "==" in guard else f"not {guard}"
    new = replace(TEXTS[name], path, changed)
    difference = list(difflib.unified_diff(TEXTS[name].split("\n"), new.split("\n"), n=0, lineterm=""))[2:]
    assert [line[0] for line in difference] == ["@", "-", "+"]
    assert dict(entries(read_text(new, name).content))[path] == changed


def test_a_short_guard_in_place_of_a_folded_one_is_one_line() -> None:
    new = replace("a:\n  when: >- # why\n    b and\n    c\n  d: 1 # e\n", ("a", "when"), "b")
    assert new == "a:\n  when: b # why\n  d: 1 # e\n"


def test_a_long_guard_is_folded() -> None:
    guard = " and ".join(f"position_{number} == home" for number in range(8))
    new = replace("a:\n  when: b # c\n", ("a", "when"), guard)
    assert new.startswith("a:\n  when: >- # c\n    position_0 == home and")
    assert max(map(len, new.split("\n"))) <= 120


def test_new_entries_are_in_the_style_of_the_house() -> None:
    ability = {"title": "Stop", "start": {"do": ["a := b", "c[d] := e"]}, "effects": {"f": {"takes": [1, 2.5]}}}
    assert insert("abilities:\n  a:\n    title: A\n", ("abilities", "stop"), ability) == (
        "abilities:\n  a:\n    title: A\n  stop:\n    title: Stop\n    start:\n      do: [a := b, 'c[d] := e']\n"
        "    effects:\n      f:\n        takes: [1, 2.5]\n"
    )
    new = insert("m:\n  a: {type: bool} # c\n", ("m", "b"), {"type": "0..3"})
    assert new == "m:\n  a: {type: bool} # c\n  b: {type: 0..3}\n"


def test_comments_go_with_their_entries() -> None:
    text = "# The file.\na: 1\n\n# About b.\nb: 2 # two\n\n# About c.\nc: 3\n"
    assert remove(text, ("b",)) == "# The file.\na: 1\n\n# About c.\nc: 3\n"
    assert remove(text, ("a",)) == "# The file.\n# About b.\nb: 2 # two\n\n# About c.\nc: 3\n"
    assert move(text, ("c",), before="b") == "# The file.\na: 1\n\n# About c.\nc: 3\n\n# About b.\nb: 2 # two\n"
    assert rename(text, ("b",), "d: e").split("\n")[4] == "'d: e': 2 # two"


def test_what_stands_between_entries_stays_where_it_is() -> None:
    text = "a:\n  x: 1\n  # Not yet: y\n\n# About b.\nb: 2 # two\n\n\n# ---- apart\n\nc: 3"
    there = "# About b.\nb: 2 # two\n\na:\n  x: 1\n  # Not yet: y\n\n\n# ---- apart\n\nc: 3"
    assert move(text, ("b",), before="a") == f"\n{there}"  # a comment in the first line would be about the file
    assert move(text, ("c",), before="a") == (
        "c: 3\n\na:\n  x: 1\n  # Not yet: y\n\n\n# ---- apart\n\n# About b.\nb: 2 # two"
    )
    assert move("# The file.\na: 1\n# About b.\nb: 2\n", ("a",)) == "# The file.\n\n# About b.\nb: 2\na: 1\n"
    assert move("m: [ a,  b , c ]\n", ("m", 2), before=0) == "m: [ c,  a , b ]\n"


def test_of_a_mapping_only_what_differs_is_written() -> None:
    text = "a: # one\n  b: 1 # two\n  # three\n  c: {d: [1,  2]}\n"
    new = replace(text, ("a",), {"b": 1, "c": {"d": [1, 3]}, "e": None})
    assert new == "a: # one\n  b: 1 # two\n  # three\n  c: {d: [1,  3]}\n  e: null\n"


@pytest.mark.parametrize("path", [("a", "b"), ("c", "b"), ("a",)], ids=shown_path)
def test_what_an_anchor_shares_is_refused(path: EntryPath) -> None:
    message = r"^what the anchor in line 1 names is used by the alias in line 3 too: write it out there"
    text = "a: &x\n  b: 1\nc: *x\n"
    with pytest.raises(EditError, match=message):
        replace(text, path, 2)
    with pytest.raises(EditError, match=message):
        remove(text, path)


def test_an_alias_itself_can_be_replaced() -> None:
    assert replace("a: &x\n  b: 1\nc: *x # d\n", ("c",), 2) == "a: &x\n  b: 1\nc: 2 # d\n"


@pytest.mark.parametrize(
    ("text", "path", "message"),
    [
        ("a: {b: 1}\n", "a.c", "`a` has no entry `c`"),
        ("enabled: x\n", "enabld", "the document has no entry `enabld`; did you mean `enabled`?"),
        ("a: [1, 2]\n", "a[2]", "`a` is a list of 2, counted from [0]: there is no `[2]` in it"),
        ("a: [1, 2]\n", "a.b", "`a` is a list of 2, counted from [0]: there is no `b` in it"),
        ("a: {b: 1}\n", "a[0]", "`a` is a mapping: write a name and not [0]"),
        ("a: 1\n", "a.b", "`a` has no entries"),
        (
            "a: &x {b: 1}\nc: {<<: *x}\n",
            "a",
            "it cannot be edited before it can be read: line:2:5: `<<` is not known here: write the entries out",
        ),
        ("? a\n: b\n", "a", "line 1: a name behind a `?` cannot be edited; write it as `name: value`"),
    ],
)
def test_what_cannot_be_edited_is_said(text: str, path: str, message: str) -> None:
    with pytest.raises(EditError) as caught:
        replace(text, parse_path(path), "new")
    assert str(caught.value) == message


@pytest.mark.parametrize("written", ["a.b", "a[0].b", '"/ur10/state".type', '"/a.b"', "a.'b.c'[2][3]", '[1]."x y"'])
def test_paths(written: str) -> None:
    path = parse_path(written)
    assert parse_path(shown_path(path)) == path
    assert path == parse_path(written.replace("'", '"'))


def test_a_path_is_names_and_indices() -> None:
    assert parse_path("topics.\"/a.b\".pipeline[0].rename.'c d'") == ("topics", "/a.b", "pipeline", 0, "rename", "c d")


@pytest.mark.parametrize("written", ["", "a.", ".a", "a..b", "a[x]", "a b", "a[0", 'a."b', "a[0]b"])
def test_what_is_no_path(written: str) -> None:
    with pytest.raises(EditError, match=r"path"):
        parse_path(written)


STAGES = """\
topics:
  /robot/state:
    pipeline:
      # near enough
      - discretise: # by hand
          field: joints
          within: &near 0.1 # rad
      - limit: {every: 1.0}

      # as near as that
      - debounce:
          seconds: *near
"""
PIPELINE = ("topics", "/robot/state", "pipeline")


def test_what_is_added_stands_as_it_is_written_with_its_comments() -> None:
    written = "# why\n# and how\nlimit: # rarely\n  every: 2 # s\n  note: |\n    one\n\n    two\n"
    value = {"limit": {"every": 2, "note": "one\n\ntwo\n"}}
    new = insert(STAGES, (*PIPELINE, 0), value, before=1, written=written)
    lines = ["# why", "# and how", "- limit: # rarely", "    every: 2 # s", "    note: |", "      one", "", "      two"]
    assert "".join(f"      {line}".rstrip() + "\n" for line in lines) in new
    assert value_at(new, (*PIPELINE, 1)) == value
    assert (
        insert("m:\n  a: 1\n", ("m", "b"), {"c": 2}, written="# d\nc: 2 # e\n")
        == "m:\n  a: 1\n  # d\n  b:\n    c: 2 # e\n"
    )
    assert insert("m:\n  a: 1\n", ("m", "b"), [2], written="[2] # e") == "m:\n  a: 1\n  b: [2] # e\n"


@pytest.mark.parametrize(
    "written", ["limit: {every: 3}", "limit: {every: *near", "limit: *nobody", "", "# only this", "- limit: {every: 2}"]
)
def test_what_is_written_otherwise_than_it_says_is_added_without_it(written: str) -> None:
    plain = insert(STAGES, (*PIPELINE, 0), {"limit": {"every": 2}}, before=1)
    assert insert(STAGES, (*PIPELINE, 0), {"limit": {"every": 2}}, before=1, written=written) == plain


def test_an_anchor_goes_along_with_what_is_moved_where_it_still_stands_before_its_aliases() -> None:
    new = move(STAGES, (*PIPELINE, 0), after=1)
    assert "      - limit: {every: 1.0}\n      # near enough\n      - discretise: # by hand\n" in new
    assert "within: &near 0.1 # rad" in new
    with pytest.raises(EditError, match="anchor"):
        move(STAGES, (*PIPELINE, 0), after=2)


def test_what_stands_behind_an_alias_is_written_out_where_it_moves_before_its_anchor() -> None:
    new = move(STAGES, (*PIPELINE, 2), before=0)
    assert "      # as near as that\n      - debounce:\n          seconds: 0.1\n" in new
    assert "within: &near 0.1 # rad" in new
    assert value_at(new, (*PIPELINE, 0)) == {"debounce": {"seconds": 0.1}}
