"""The name most like a word is the one that `difflib` would find, be it by what the name is without its parameters."""

from __future__ import annotations

import difflib
from difflib import SequenceMatcher

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.language.names.suggestions import beginning_with, nearest, nearest_of
from support.examples import examples

WORDS = st.text("abc_.", min_size=1, max_size=8)
NAMES = st.lists(st.one_of(WORDS, st.sampled_from(["robot.pose", "robot.moving", "pose", "poses"])), max_size=12)


STATION = ["tighten_oil_filter", "robot.pose", "robot.moving", "bolts[pair_1]", "bolts[pair_2]", "place(pair_1)"]
STATION += [f"tighten_bolt_pair({pair})" for pair in ("pair_1", "pair_2")]


@pytest.mark.parametrize(
    ("word", "name"),
    [
        ("tighten_bolt_pair", "tighten_bolt_pair(pair_1)"),
        ("tighten_bolt_pears", "tighten_bolt_pair(pair_1)"),
        ("tighten_bolt_pair(pear_2)", "tighten_bolt_pair(pair_2)"),
        ("posse", "robot.pose"),
        ("bolt", "bolts[pair_1]"),
        ("tigten_oil_filter", "tighten_oil_filter"),
    ],
)
def test_who_leaves_out_a_parameter_or_an_owner_is_understood(word: str, name: str) -> None:
    found = nearest(word, STATION, 0.5)
    assert found is not None
    assert found[1] == name


@examples(1000)
@given(WORDS.map(lambda word: f"{word}(."), NAMES, st.sampled_from([0.1, 0.5, 0.7, 1.0]))
def test_the_nearest_name_as_a_whole_is_that_of_difflib(word: str, names: list[str], cutoff: float) -> None:
    expected = difflib.get_close_matches(word, list(dict.fromkeys(names)), n=1, cutoff=cutoff)
    found = nearest(word, names, cutoff)
    assert nearest_of(word, tuple(names), cutoff) == found
    assert ([] if found is None else [found[1]]) == expected


@examples(300)
@given(WORDS, NAMES)
def test_a_part_is_found_only_where_it_is_more_like_the_word_than_every_whole_name(word: str, names: list[str]) -> None:
    found = nearest(word, names, 0.5)
    ratios = [SequenceMatcher(None, name, word).ratio() for name in names]
    assert max(ratios, default=0.0) <= (found[0] if found is not None else 0.5)
    assert found is None or found[1] in names


@examples(300)
@given(WORDS, st.lists(WORDS, unique=True))
def test_names_that_begin_so_are_found_in_their_order(prefix: str, names: list[str]) -> None:
    assert beginning_with(prefix, tuple(names)) == [name for name in names if name.startswith(prefix)]
