"""Two versions of a text brought together, where each changed other lines of the same old one."""

from __future__ import annotations

from merge3 import Merge3


class MergeConflictError(Exception):
    """Both changed the same lines; the text says which."""


def merged(old: str | None, mine: str | None, theirs: str | None) -> str | None:
    """The text with what both have done to the `old` one; None is no text. Raises `MergeConflictError`."""
    if theirs in (mine, old):
        return mine
    if mine == old:
        return theirs
    if old is None or mine is None or theirs is None:
        raise MergeConflictError("in another way: it was made, or taken away")
    merge = Merge3(old.splitlines(True), mine.splitlines(True), theirs.splitlines(True))
    for region in merge.merge_regions():
        if region[0] == "conflict":
            raise MergeConflictError(f"in the same lines, from line {region[1] + 1} of the old text on")
    return "".join(merge.merge_lines())
