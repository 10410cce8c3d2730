"""Runs that were recorded once are replayed bit for bit, whatever the program is called inside by now."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from golden.journals import JOURNALS, MODELS, MOST_BYTES, MOST_BYTES_OF_ALL, model_of, names, records, replayed
from golden.scenarios import SCENARIOS

QUICK = (
    "bolt_tightening-deployment",
    "bolt_tightening-errands",
    "bolt_tightening-jobs",
    "truck_engine_station-restart",
)


@pytest.mark.parametrize("name", QUICK)
def test_it_is_replayed_bit_for_bit(name: str) -> None:
    assert replayed(records(name)) is None


def test_another_course_is_noticed() -> None:
    run = records("bolt_tightening-production")
    place, record, content = next(
        (place, record, content)
        for place, record in enumerate(run)
        if "robot.pose" in (content := json.loads(record.content)).get("measured", {})
    )
    content["measured"]["robot.pose"] = "unknown" if content["measured"]["robot.pose"] != "unknown" else "home"
    run[place] = replace(record, content=json.dumps(content))
    assert replayed(run) is not None


def test_there_is_a_journal_of_every_scenario_and_a_model_of_every_journal() -> None:
    assert names() == sorted(SCENARIOS)
    for name, scenario in SCENARIOS.items():
        assert scenario.kinds <= {record.kind for record in records(name)}
    used = {str(digest)[:12] for name in names() for record in records(name) if (digest := model_of(record))}
    assert used == {file.stem for file in MODELS.iterdir()}


def test_they_are_small() -> None:
    sizes = {file.name: file.stat().st_size for file in JOURNALS.rglob("*") if file.is_file()}
    assert {name for name, size in sizes.items() if size > MOST_BYTES} == set()
    assert sum(sizes.values()) <= MOST_BYTES_OF_ALL
