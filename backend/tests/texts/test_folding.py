"""Titles that differ in a number are told as one, and nothing else is said by that."""

from __future__ import annotations

import re
from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.texts.grammar import MOST_LISTED, folded
from sequence_planner.texts.message import Title


def pair(number: int) -> Title:
    words = {"en": f"Place the bolts of pair {number}", "sv": f"Sätt i par {number}"}
    return Title(words["en"], words)


def test_what_differs_in_a_number_is_one_title_in_each_language() -> None:
    one, other = folded([pair(2), pair(3), Title("Release", {"en": "Release", "sv": "Släpp"}), pair(4)])
    assert (one, other) == ("Place the bolts of pairs 2 to 4", "Release")
    assert isinstance(one, Title)
    assert one.words == {"en": "Place the bolts of pairs 2 to 4", "sv": "Sätt i par 2 till 4"}


def test_what_differs_in_more_is_told_as_it_is() -> None:
    for titles in (
        ["Bay 1 of hall 1", "Bay 2 of hall 2", "Bay 3 of hall 3"],
        ["Part 01", "Part 02", "Part 03"],
        [Title(f"Pair {n}", {"en": f"Pair {n}", "sv": f"Par {n + 1}"}) for n in (1, 2, 3)],
        ["Place 1", "Take 2", "Leave 3"],
    ):
        assert folded(titles) == titles


chosen = st.lists(st.tuples(st.sampled_from(["Place pair", "Tighten pair", "Rest"]), st.integers(0, 5)), max_size=14)


@given(chosen)
def test_each_title_is_told_once_and_no_other_is(chosen: list[tuple[str, int]]) -> None:
    every = list(dict.fromkeys(f"{what} {number}" for what, number in chosen))
    told = Counter[str]()
    for each in folded(every):
        found = re.fullmatch(r"(\D*?)s? (\d.*)", each)
        assert found is not None, each
        what, numbers = found.groups()
        ranges = re.findall(r"(\d+)(?: to (\d+))?", numbers)
        assert len(ranges) <= MOST_LISTED
        told.update(f"{what} {n}" for first, last in ranges for n in range(int(first), int(last or first) + 1))
    assert told == Counter(every)
