"""The name most like a word: what `difflib.get_close_matches` finds, in less time among thousands of names.

Whoever writes `tighten_bolt_pair` leaves out which pair, and whoever writes `pose` of what. So a word is compared with
a name as a whole and, where it has no parameter or owner itself, with the name without these.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections import Counter
from collections.abc import Iterable
from difflib import SequenceMatcher
from functools import lru_cache
from operator import itemgetter

from sequence_planner.texts.late import message

# What is known of a list of names is kept for the next questions about it; a list is that of a station.
_OWNERS, _PARAMETERS = "./", "(["  # what stands behind an owner, and before a parameter
_ARGUMENTS = re.compile(r"([(\[])([^()\[\]]+)([)\]])")
_LISTS = 4
_WORDS = 64
_ALIKE = 0.5  # as arguments have to be for an instance to be what was meant


def nearest(word: str, candidates: Iterable[str], cutoff: float) -> tuple[float, str] | None:
    """The one of `candidates` most like `word`, with how like it is, from `cutoff` to 1."""
    names = list(dict.fromkeys(candidates))
    whole = _most_like(word, names, cutoff)
    parts: dict[str, str] = {}  # each with the first name that it is a part of
    for name in names:
        for each in _parts(word, name):
            parts.setdefault(each, name)
    part = _most_like(word, parts, cutoff if whole is None else whole[0])
    if part is None or (whole is not None and whole[0] >= part[0]):
        return whole
    return part[0], parts[part[1]]


def meant(word: str, candidates: Iterable[str], *near: tuple[float, str] | None) -> str:
    """`; did you mean ...?` with the one that is most like it, the first of those that are equally; of several
    instances what they look like; nothing if there is none.
    """
    found = [each for each in near if each is not None]
    if not found:
        return ""
    most = max(found, key=itemgetter(0))[1]
    shape = shape_of(most)
    if shape != most and nearest(arguments_of(word), [arguments_of(most)], _ALIKE) is None:
        first, *others = (name for name in candidates if shape_of(name) == shape)
        if others:
            return message("hint.meant-as", shape=shape, first=first)
        most = first
    return message("hint.meant", name=most)


def suggestion(word: str, candidates: Iterable[str], likeness: float = 0.5) -> str:
    """`; did you mean ...?` with the nearest of `candidates`, or nothing."""
    every = list(candidates)
    return meant(word, every, nearest(word, every, likeness))


def shape_of(name: str) -> str:
    """What all instances look like, as in `move(…).executing`."""
    return _ARGUMENTS.sub("\\1…\\3", name)


def arguments_of(name: str) -> str:
    """What stands between its brackets."""
    return " ".join(each[1] for each in _ARGUMENTS.findall(name))


def _parts(word: str, name: str) -> list[str]:
    """Return what the name is without the parameters, and without the owner, that the word does not have either."""
    head = name if any(each in word for each in _PARAMETERS) else name[: _first(name, _PARAMETERS)]
    bare = head if any(each in word for each in _OWNERS) else head[_last(head, _OWNERS) + 1 :]
    return [part for part in (head, bare) if part and part != name]


def _first(name: str, marks: str) -> int:
    return min((at for mark in marks if (at := name.find(mark)) > 0), default=len(name))


def _last(name: str, marks: str) -> int:
    """Of what stands before parameters: those may be values with owners of their own."""
    end = _first(name, _PARAMETERS)
    return max(name.rfind(mark, 0, end) for mark in marks)


def _most_like(word: str, candidates: Iterable[str], cutoff: float) -> tuple[float, str] | None:
    letters = list(Counter(word).items())
    bounds: list[tuple[float, str]] = []
    for candidate in candidates:
        total = len(word) + len(candidate)
        if not total or 2.0 * min(len(word), len(candidate)) / total < cutoff:
            continue
        # No more letters can be alike than both have.
        bound = 2.0 * sum([min(number, candidate.count(letter)) for letter, number in letters]) / total
        if bound >= cutoff:
            bounds.append((bound, candidate))
    bounds.sort(reverse=True)
    matcher = SequenceMatcher()
    matcher.set_seq2(word)
    best: tuple[float, str] | None = None
    for bound, candidate in bounds:
        if best is not None and bound < best[0]:
            break
        matcher.set_seq1(candidate)
        ratio = matcher.ratio()
        if ratio >= cutoff and (best is None or (ratio, candidate) > best):
            best = ratio, candidate
    return best


@lru_cache(_WORDS)
def nearest_of(word: str, names: tuple[str, ...], cutoff: float) -> tuple[float, str] | None:
    """The same of a long list of names, about which it is asked again and again."""
    return nearest(word, names, cutoff)


def beginning_with(prefix: str, names: tuple[str, ...]) -> list[str]:
    """Those of a long list that begin so, in its order."""
    ordered, position = _ordered(names)
    found: list[str] = []
    for name in ordered[bisect_left(ordered, prefix) :]:
        if not name.startswith(prefix):
            break
        found.append(name)
    return sorted(found, key=position.__getitem__)


@lru_cache(_LISTS)
def _ordered(names: tuple[str, ...]) -> tuple[tuple[str, ...], dict[str, int]]:
    return tuple(sorted(names)), {name: at for at, name in enumerate(names)}
