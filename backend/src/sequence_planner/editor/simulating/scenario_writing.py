"""Makes a scenario of what was tried: from where it began, what somebody did, and what is to come about."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from pydantic import JsonValue

from sequence_planner.automaton.tick import initial_state
from sequence_planner.editor.schemas.simulation import Advance, ScenarioExpectation
from sequence_planner.editor.simulating.simulation import DraftSimulation
from sequence_planner.editor.usable import read_condition
from sequence_planner.history.simulated_station import STEP
from sequence_planner.model.paths import EditError
from sequence_planner.texts.message import message

GRACE: Final = 5.0  # seconds more than it took, until what is expected has come about


def scenario_document(simulation: DraftSimulation, expected: ScenarioExpectation) -> dict[str, JsonValue]:
    """Return the document of a scenario that does what was done, up to a moment. Raises `EditError` where nothing is
    expected of it, or no condition.
    """
    if expected.holds is not None:
        read_condition(simulation.automaton, expected.holds)
    end = simulation.passed if expected.at is None else min(expected.at, simulation.passed)
    steps = list(_steps(simulation, expected, end))
    if not any(key in step for step in steps for key in ("starts", "holds")):
        raise EditError(message("scenario.expects-nothing"))
    document: dict[str, JsonValue] = {}
    if expected.title:
        document["title"] = expected.title
    initial = initial_state(simulation.automaton)
    given: dict[str, JsonValue] = {
        name: simulation.before[name]
        for name in simulation.automaton.variables
        if simulation.before[name] != initial[name]
    }
    if given:
        document["given"] = given
    if simulation.station.people_wait:
        document["people"] = "wait"
    document["steps"] = [*steps]
    return document


def _steps(simulation: DraftSimulation, expected: ScenarioExpectation, end: float) -> Iterator[dict[str, JsonValue]]:
    at = simulation.begun
    for time, advance in simulation.deeds:
        if time > end + STEP / 2:
            break
        deeds = list(_deeds(advance, people_wait=simulation.station.people_wait))
        if deeds and time - at > STEP / 2:
            yield {"wait": round(time - at, 1)}
        if deeds:
            at = time
        yield from deeds
    within = math.ceil(end - at + GRACE)
    if expected.starts:
        since, until = at - STEP / 2, end + STEP / 2
        started: list[JsonValue] = [name for time, name in simulation.started if since <= time <= until]
        if started:
            yield {"starts": started, "within": within}
    if expected.holds is not None:
        yield {"holds": expected.holds, "within": within}


def _deeds(advance: Advance, *, people_wait: bool) -> Iterator[dict[str, JsonValue]]:
    for fault in advance.faults:
        yield {"fault": fault}
    if advance.sets:
        sets: dict[str, JsonValue] = dict(advance.sets)
        yield {"set": sets}
    for ability in advance.done if people_wait else ():
        yield {"done": ability}
