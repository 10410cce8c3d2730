"""The scenarios of a draft as people see them, and how they ran."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path, PurePath
from typing import Final

from sequence_planner.editor.processes import encoded
from sequence_planner.editor.schemas.simulation import (
    ScenarioPlaceView,
    ScenarioRunView,
    ScenariosView,
    ScenarioView,
)
from sequence_planner.editor.simulating.scenario_run import ScenarioRun, not_exercised, run_scenarios
from sequence_planner.editor.usable import UnusableModelError, prepared, station_of
from sequence_planner.language.types import Place
from sequence_planner.model.files import Files
from sequence_planner.model.paths import TESTS, EditError
from sequence_planner.model.source import Finding
from sequence_planner.process.budget import Budget
from sequence_planner.scenarios.scenario import Scenario, named_scenario, scenarios_of
from sequence_planner.station import ReadyStation
from sequence_planner.texts.message import Message, as_it_was

RUN_WITHIN: Final = 120.0
"""Seconds of work that the scenarios of a draft may take together."""


def run_view(run: ScenarioRun) -> ScenarioRunView:
    """A scenario as it ran."""
    failure = None if run.failure is None else _placed(run.failure.place, run.failure.why)
    return ScenarioRunView(name=run.scenario.name, seconds=run.seconds, failure=failure)


def found_scenarios(
    number: int, files: Files, stages: Path | None, names: Sequence[str] | None, folder: Path
) -> Iterator[object]:
    """Yield the scenarios of a draft, and with `names` how these ran, or all where there are none of them; a message in
    their place says which one cannot be carried out.
    """
    whole = folder / "station"
    try:
        if names is None:
            yield encoded(_view(number, station_of("whole", files, stages, whole)))
            return
        meant = prepared("whole", files, stages, whole)
    except UnusableModelError as error:
        yield encoded(_nothing(number, error.why))
        return
    scenarios, _ = found_in(meant.station)
    try:
        chosen = [named_scenario(scenarios, each) for each in dict.fromkeys(names)] or scenarios
    except EditError as error:
        yield error
        return
    runs = list(run_scenarios(meant, chosen, Budget.seconds(RUN_WITHIN)))
    unused = {} if names else not_exercised(meant, runs)
    view = _view(number, meant.station)
    yield encoded(view.model_copy(update={"runs": [*map(run_view, runs)], "not_exercised": dict(unused)}))


def found_in(station: ReadyStation) -> tuple[list[Scenario], list[Finding]]:
    """All scenarios of a station that can be carried out, and what is wrong with the others."""
    return ([], []) if station.written is None else scenarios_of(station.automaton, station.written, station.pipelines)


def _view(number: int, station: ReadyStation) -> ScenariosView:
    scenarios, wrong = found_in(station)
    return ScenariosView(
        number=number,
        obstacle=None,
        scenarios=[
            ScenarioView(name=each.name, title=each.title, file=_file(each.place), line=each.place.line)
            for each in scenarios
        ],
        wrong=[_placed(each.place, as_it_was(each.message)) for each in wrong],
        runs=[],
        not_exercised={},
    )


def _nothing(number: int, why: Message) -> ScenariosView:
    return ScenariosView(number=number, obstacle=why, scenarios=[], wrong=[], runs=[], not_exercised={})


def _placed(place: Place, said: Message) -> ScenarioPlaceView:
    return ScenarioPlaceView(file=_file(place), line=place.line, column=place.column, said=said)


def _file(place: Place) -> str:
    """The name of a file below the station's folder, wherever that is."""
    return f"{TESTS}/{PurePath(place.file).name}"
