"""The name most like a word is the one that `difflib` would find."""

from __future__ import annotations

import difflib

from hypothesis import given
from hypothesis import strategies as st

from core.budget import examples
from sequence_planner.expressions.likeness import beginning_with, nearest, nearest_of

WORDS = st.text("abc_.", min_size=1, max_size=8)
NAMES = st.lists(st.one_of(WORDS, st.sampled_from(["robot.pose", "robot.moving", "pose", "poses"])), max_size=12)


@examples(1000)
@given(WORDS, NAMES, st.sampled_from([0.1, 0.5, 0.7, 1.0]))
def test_the_nearest_name_is_that_of_difflib(word: str, names: list[str], cutoff: float) -> None:
    expected = difflib.get_close_matches(word, list(dict.fromkeys(names)), n=1, cutoff=cutoff)
    found = nearest(word, names, cutoff)
    assert nearest_of(word, tuple(names), cutoff) == found
    assert ([] if found is None else [found[1]]) == expected


@examples(300)
@given(WORDS, st.lists(WORDS, unique=True))
def test_names_that_begin_so_are_found_in_their_order(prefix: str, names: list[str]) -> None:
    assert beginning_with(prefix, tuple(names)) == [name for name in names if name.startswith(prefix)]
