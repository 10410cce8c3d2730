"""Three-way merges: laws, and what git makes of the same texts."""

from __future__ import annotations

import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.editor.merging import MergeConflictError, merged, rewritten
from support.examples import examples

LINES = st.lists(st.sampled_from("abc"), max_size=8).map(lambda lines: "".join(f"{line}\n" for line in lines))


@st.composite
def edits(draw: st.DrawFn, size: int, whose: str) -> list[str]:
    """What becomes of each of so many lines: it stays, goes, becomes another, or gets one behind it."""
    found = []
    for number in range(size):
        what = draw(st.sampled_from("====-~+"))
        line = f"line {number}\n"
        fresh = f"{draw(st.sampled_from([whose, 'both']))} {number}\n"
        found.append({"=": line, "-": "", "~": fresh, "+": line + fresh}[what])
    return found


@st.composite
def versions(draw: st.DrawFn) -> tuple[str, str, str]:
    """A text in which no line is there twice, so that there is one way to see what was changed, and two others."""
    size = draw(st.integers(0, 12))
    old = "".join(f"line {number}\n" for number in range(size))
    end = draw(st.sampled_from(["", "no end of line"]))
    mine, theirs = ("".join(draw(edits(size, whose))) for whose in ("mine", "theirs"))
    return old + end, mine + end, theirs + end


def outcome(old: str, mine: str, theirs: str) -> str | None:
    """The text, or None for a conflict."""
    try:
        return merged(old, mine, theirs)
    except MergeConflictError:
        return None


def git(old: str, mine: str, theirs: str) -> str | None:
    """What `git merge-file` makes of it; None for a conflict."""
    with TemporaryDirectory() as folder:
        files = [Path(folder, name) for name in ("mine", "old", "theirs")]
        for file, text in zip(files, (mine, old, theirs), strict=True):
            file.write_bytes(text.encode())
        done = subprocess.run(["git", "merge-file", "-p", *files], capture_output=True, check=False)
    assert done.returncode < 128, done.stderr
    return done.stdout.decode() if done.returncode == 0 else None


@examples(300)
@given(versions())
def test_it_is_as_git_has_it(texts: tuple[str, str, str]) -> None:
    assert outcome(*texts) == git(*texts)


@examples(1000)
@given(LINES, LINES, LINES)
def test_where_it_does_not_matter_who_was_first(old: str, mine: str, theirs: str) -> None:
    assert outcome(old, mine, theirs) == outcome(old, theirs, mine)


@examples(1000)
@given(LINES, LINES, LINES)
def test_no_line_is_invented(old: str, mine: str, theirs: str) -> None:
    together = outcome(old, mine, theirs)
    if together is not None:
        assert set(together.splitlines()) <= {*mine.splitlines(), *theirs.splitlines()}


@pytest.mark.parametrize(
    ("old", "mine", "theirs", "expected"),
    [
        ("a\nb\nc\n", "A\nb\nc\n", "a\nb\nC\n", "A\nb\nC\n"),
        ("a\nb\nc\n", "A\nb\nc\n", "a\nB\nc\n", None),  # lines beside each other, with nothing between
        ("a\nb\nc\n", "a\nx\nb\nc\n", "a\nx\nb\nC\n", "a\nx\nb\nC\n"),
        ("a\n", "a\nx\n", "a\ny\n", None),
        ("a\nb", "a\nb", "a\nb\n", "a\nb\n"),
        ("", "x\n", "x\n", "x\n"),
        ("", "x\n", "y\n", None),
    ],
)
def test_examples(old: str, mine: str, theirs: str, expected: str | None) -> None:
    assert outcome(old, mine, theirs) == expected
    assert git(old, mine, theirs) == expected


def test_a_conflict_names_the_line() -> None:
    with pytest.raises(MergeConflictError, match="from line 2 of the old text"):
        merged("a\nb\nc\nd\n", "a\nX\nc\nd\n", "a\nY\nc\nd\n")


def test_long_texts_of_like_lines_are_merged_soon() -> None:
    """40 000 lines, of which most are there thousands of times."""
    old = "".join(f"  v{number}:\n    type: bool\n" for number in range(20_000))
    mine, theirs = old.replace("v10000:", "w:"), old.replace("v19999:\n    type: bool", "v19999:\n    type: int")
    assert merged(old, mine, theirs) == mine.replace("v19999:\n    type: bool", "v19999:\n    type: int")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("a: 1\nb: 2\n", "a: 1\nb: 3\n", [(2, "b: 2", "b: 3")]),
        ("a:\n  x: 1\n  y: 2\n", "a:\n  x: 2\n  y: 3\n", [(2, "x: 1", "x: 2"), (3, "y: 2", "y: 3")]),
        ("a: 1\n", "a: 1\nb:\n  c: 2\n", [(2, None, "b:\n  c: 2")]),
        ("a: 1\n  b: 2\n  c: 3\n", "a: 1\n", [(2, "b: 2\nc: 3", None)]),
        (None, "a: 1\n", [(1, None, "a: 1")]),
        ("a: 1\n", None, [(1, "a: 1", None)]),
    ],
)
def test_lines_that_differ_are_told_with_what_they_were(
    old: str | None, new: str | None, told: list[tuple[int, str | None, str | None]]
) -> None:
    assert [(each.line, each.was, each.now) for each in rewritten(old, new)] == told


@given(LINES, LINES)
def test_all_that_differs_is_told_where_it_stands(old: str, new: str) -> None:
    found = rewritten(old, new)
    assert bool(found) == (old != new)
    lines = new.splitlines()
    for each in found:
        now = [] if each.now is None else each.now.splitlines()
        assert lines[each.line - 1 :][: len(now)] == now
    gone = sum(len((each.was or "").splitlines()) - len((each.now or "").splitlines()) for each in found)
    assert len(old.splitlines()) - gone == len(lines)
