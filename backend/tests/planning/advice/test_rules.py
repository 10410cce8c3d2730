"""A sample of the rules of proposals after single faults on all stations; `campaigns/ways.py` has many more."""

from __future__ import annotations

import pytest

from planning.advice.rules import STATIONS, after_a_fault

SMALL = [name for name in STATIONS if name != "truck_engine_station"]


@pytest.mark.parametrize("name", SMALL)
def test_what_is_proposed_after_a_fault_can_be_trusted(name: str) -> None:
    for number in range(12):
        assert after_a_fault(name, f"rules.{number}", 3.0)
