"""A short sample of the campaign: a station is stopped in four ways, and gets back to work through REST alone."""

from __future__ import annotations

from running.back_to_work.ways import bolt_ways


def test_a_station_that_was_stopped_gets_back_to_work_as_it_says() -> None:
    seen = bolt_ways("sample", 4)
    assert sum(number for what, number in seen.items() if what.startswith("way: ")) == 4
    assert {"restart abilities", "corrections", "physical changes", "engines built"} <= seen.keys()
