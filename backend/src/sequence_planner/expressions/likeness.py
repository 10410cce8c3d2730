"""The name most like a word: what `difflib.get_close_matches` finds, in less time among thousands of names."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Iterable
from difflib import SequenceMatcher
from functools import lru_cache

# What is known of a list of names is kept for the next questions about it; a list is that of a station.
_LISTS = 4
_WORDS = 64


def nearest(word: str, candidates: Iterable[str], cutoff: float) -> tuple[float, str] | None:
    """The one of `candidates` most like `word`, with how like it is, from `cutoff` to 1."""
    letters = list(Counter(word).items())
    bounds: list[tuple[float, str]] = []
    for candidate in dict.fromkeys(candidates):
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
