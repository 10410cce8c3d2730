"""Two versions of a text brought together, where each changed other lines of the same old one."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from textwrap import dedent

from sequence_planner.texts.message import Message, message


class MergeConflictError(Exception):
    """Both changed the same lines; the text says which, and `how`."""

    def __init__(self, how: Message) -> None:
        super().__init__(how)
        self.how = how


@dataclass(frozen=True)
class _Change:
    """The lines of the old text from `start` up to `end` have become `lines`."""

    start: int
    end: int
    lines: Sequence[str]


def merged(old: str | None, mine: str | None, theirs: str | None) -> str | None:
    """The text with what both have done to the `old` one; None is no text. Raises `MergeConflictError`."""
    if theirs in (mine, old):
        return mine
    if mine == old:
        return theirs
    if old is None or mine is None or theirs is None:
        raise MergeConflictError(message("edit.file-changed.made"))
    lines, found, done = old.splitlines(True), list[str](), 0
    for change in _both(lines, _changes(lines, mine.splitlines(True)), _changes(lines, theirs.splitlines(True))):
        found += [*lines[done : change.start], *change.lines]
        done = change.end
    return "".join([*found, *lines[done:]])


@dataclass(frozen=True)
class Rewritten:
    """The lines from this one on, from 1, were `was`, and are `now`; None is no line."""

    line: int
    was: str | None
    now: str | None


def rewritten(old: str | None, new: str | None) -> list[Rewritten]:
    """The lines in which two versions of a text differ, in the order of the new one, without what is around them."""
    return [
        Rewritten(begin + 1, _block(before), _block(after))
        for before, after, begin in _replaced((old or "").splitlines(), (new or "").splitlines())
    ]


def _replaced(old: Sequence[str], new: Sequence[str]) -> Iterator[tuple[Sequence[str], Sequence[str], int]]:
    for tag, start, end, begin, until in SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        if tag == "replace" and end - start == until - begin:
            yield from (([old[start + at]], [new[begin + at]], begin + at) for at in range(end - start))
        elif tag != "equal":
            yield old[start:end], new[begin:until], begin


def _block(lines: Sequence[str]) -> str | None:
    return dedent("\n".join(lines)).strip("\n") if lines else None


def _changes(old: Sequence[str], new: Sequence[str]) -> list[_Change]:
    """Return what leads from one text to the other."""
    return [
        _Change(start, end, new[begin:until])
        for tag, start, end, begin, until in SequenceMatcher(None, old, new).get_opcodes()
        if tag != "equal"
    ]


def _both(old: Sequence[str], one: Iterable[_Change], other: Iterable[_Change]) -> Iterator[_Change]:
    """All changes in their order; those that overlap or touch one another are one, if they come to the same."""
    mine, theirs = deque(one), deque(other)
    while mine or theirs:
        begin = min(each[0].start for each in (mine, theirs) if each)
        end, ours, others = begin, list[_Change](), list[_Change]()
        grown = True
        while grown:
            grown = False
            for waiting, taken in ((mine, ours), (theirs, others)):
                while waiting and waiting[0].start <= end:
                    taken.append(waiting.popleft())
                    end, grown = max(end, taken[-1].end), True
        if not others or not ours:
            yield from ours or others
        elif (lines := _after(old, begin, end, ours)) == _after(old, begin, end, others):
            yield _Change(begin, end, lines)
        else:
            raise MergeConflictError(message("edit.file-changed.lines", line=begin + 1))


def _after(old: Sequence[str], begin: int, end: int, changes: Sequence[_Change]) -> list[str]:
    """Return what has become of the lines from `begin` up to `end`."""
    found, done = list[str](), begin
    for change in changes:
        found += [*old[done : change.start], *change.lines]
        done = change.end
    return [*found, *old[done:end]]
