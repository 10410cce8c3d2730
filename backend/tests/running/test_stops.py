"""Samples of `campaigns/stops.py`: what stops a station lasts, whatever becomes of the station right after."""

from __future__ import annotations

import pytest

from running import stops
from support.examples import SHARE
from support.postgresql import WHAT_TO_DO, binaries


def test_a_stop_lasts_though_the_controller_is_killed_within_milliseconds_after_the_answer() -> None:
    seen = stops.kills("sample 2", 3)
    assert seen["stopped"] and seen["stopped while nothing could be recorded"]
    assert seen["the answer said that it is not recorded yet"] == seen["stopped while nothing could be recorded"]
    assert seen["ticks that started something"] > 0


@pytest.mark.skipif(SHARE < 1, reason="takeovers one after the other take long: `make campaign`")
def test_no_other_station_goes_on_after_a_stop_through_outages_kills_and_takeovers() -> None:
    if binaries() is None:
        pytest.skip(WHAT_TO_DO)
    seen = stops.takeovers("sample", 1)
    assert seen["ticks that started something"] > 0
