"""Numbers of things are told in the right form."""

from __future__ import annotations

from sequence_planner.core.numerals import counted


def test_one_is_not_many() -> None:
    assert [counted(n, "ability", "abilities") for n in (0, 1, 2)] == ["0 abilities", "1 ability", "2 abilities"]
    assert [counted(n, "tick") for n in (1, 10)] == ["1 tick", "10 ticks"]
