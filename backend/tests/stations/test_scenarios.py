"""The scenarios of the stations that come along pass, each a test of its own."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from ruamel.yaml import YAML

from sequence_planner.testing import ScenarioTest, scenarios
from support.places import MODELS

# Only their names are read while tests are gathered.
ALL = [
    (file.parent.parent.name, str(name))
    for file in sorted(MODELS.glob("*/tests/*.yaml"))
    for name in YAML(typ="safe").load(file)
]


@cache
def _of(station: str) -> dict[str, ScenarioTest]:
    return {str(each): each for each in scenarios(Path(MODELS, station))}


@pytest.mark.parametrize(("station", "name"), ALL)
def test_it_passes(station: str, name: str) -> None:
    _of(station)[name].check(within=300)


def test_the_truck_engine_station_has_some() -> None:
    assert ("truck_engine_station", "an_engine_is_assembled") in ALL
