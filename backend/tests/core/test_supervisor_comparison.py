"""A little of the campaign about supervisors: larger and more entangled automata than the other tests make."""

from __future__ import annotations

import pytest

from .supervisor_comparison import compare_plain, compare_station


@pytest.mark.parametrize("number", range(30))
def test_a_plain_automaton_has_the_supervisor_of_its_definition(number: int) -> None:
    compare_plain(f"tests.{number}")


@pytest.mark.parametrize("number", range(12))
def test_a_station_has_the_supervisor_of_its_definition(number: int) -> None:
    compare_station(f"tests.{number}")
