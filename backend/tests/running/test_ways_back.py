"""A sample of `campaigns/ways_back.py`: a station is stopped in two ways, and gets back to work through REST alone."""

from __future__ import annotations

from running.back_to_work.ways import bolt_ways


def test_a_station_that_was_stopped_gets_back_to_work_as_it_says() -> None:
    seen = bolt_ways("sample", 2)
    assert sum(number for what, number in seen.items() if what.startswith("way: ")) == 2
    assert seen["engines built"] >= 1
    assert seen["restart abilities"] + seen["corrections"] + seen["physical changes"] + seen["resets"] >= 2
