"""Random choices behind one function: drawing a whole station stays cheap, and hypothesis can still shrink it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import TypeVar

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

T = TypeVar("T")


class Choices:
    """Chooses by numbers: `below(n)` gives one from 0 to n - 1, and the smaller one is the simpler one."""

    def __init__(self, below: Callable[[int], int]) -> None:
        self._below = below

    def number(self, least: int, most: int) -> int:
        """A number from `least` to `most`."""
        return least + self._below(most - least + 1)

    def pick(self, options: Sequence[T]) -> T:
        """One of `options`, the first of which is the simplest."""
        return options[self._below(len(options))] if len(options) > 1 else options[0]

    def chance(self, one_in: int) -> bool:
        """True once in `one_in` times."""
        return self._below(one_in) == one_in - 1

    def different(self, options: Sequence[T], least: int, most: int) -> list[T]:
        """Between `least` and `most` different ones of `options`, or all where these are fewer, in random order."""
        left, chosen = list(options), list[T]()
        for _ in range(min(self.number(least, most), len(left))):
            chosen.append(left.pop(self._below(len(left))))
        return chosen


def made_by(make: Callable[[Choices], T]) -> SearchStrategy[T]:
    """The strategy of all that `make` can make."""

    @st.composite
    def strategy(draw: DrawFn) -> T:
        return make(Choices(lambda bound: draw(_below(bound))))

    return strategy()


@cache
def _below(bound: int) -> SearchStrategy[int]:
    return st.integers(0, bound - 1)
