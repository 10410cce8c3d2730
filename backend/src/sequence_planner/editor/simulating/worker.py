"""Tries a draft with emulated devices, in a process that keeps the model it has prepared and what is tried with it."""

from __future__ import annotations

import secrets
from collections import OrderedDict
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Final

from sequence_planner.controller.views.part import Value as ShownValue
from sequence_planner.editor.processes import encoded
from sequence_planner.editor.schemas.simulation import (
    Advance,
    NoSimulationError,
    ScenarioExpectation,
    SimulationView,
    WrittenScenarioView,
)
from sequence_planner.editor.simulating.scenario_run import ScenarioRunner
from sequence_planner.editor.simulating.scenario_writing import scenario_document
from sequence_planner.editor.simulating.scenarios import found_in, run_view
from sequence_planner.editor.simulating.simulation import DraftSimulation, SimulatedMoment
from sequence_planner.editor.simulating.telling import SimulationTelling, unusable_view
from sequence_planner.editor.usable import KeptDraft, UnusableModelError, Usable, prepared, read_condition
from sequence_planner.language.evaluator import holds
from sequence_planner.process.budget import Budget
from sequence_planner.scenarios.scenario import named_scenario
from sequence_planner.texts.message import message

MOST_TRIED: Final = 4  # at once; the one that nobody has asked for longest is forgotten
ADVANCED_WITHIN: Final = 4.0
"""Seconds of work in which time is let pass; then it is told how far it came."""
CAUGHT_UP_WITHIN: Final = 30.0
"""Seconds of work in which it comes from a moment that was kept to the one that is asked for, and a scenario to its
end.
"""

# Of a new simulation without an id, the values that it begins with, or the scenario.
Asked = tuple[int, Path | None, str | None, Mapping[str, ShownValue | None] | str, Advance]
AskedScenario = tuple[str, ScenarioExpectation]
SimulationQuestion = tuple[Mapping[str, str | None], str, Asked | AskedScenario]


class SimulationService:
    """Lets simulations of a draft go on, which it keeps in `folder`."""

    def __init__(self, folder: Path) -> None:
        self._draft = KeptDraft(folder, prepared)
        self._tried: OrderedDict[str, SimulationTelling] = OrderedDict()

    def found_for(self, question: SimulationQuestion) -> SimulationView | WrittenScenarioView:
        """Return what a question asks for. Raises `EditError`."""
        changed, _, asked = question
        if len(asked) == 2:
            return self.written_scenario(*asked)
        return self.simulation_view(changed, asked)

    def simulation_view(self, changed: Mapping[str, str | None], asked: Asked) -> SimulationView:
        """Begin a simulation, or let one go on; returns how it stands. Raises `EditError` for what cannot be done, and
        `NoSimulationError`.
        """
        number, stages, id, present, advance = asked
        meant = self._draft.meant(changed, stages)
        if id is not None:
            return self._go_on(id, number, meant, advance)
        if isinstance(meant, UnusableModelError):
            return unusable_view(number, meant.why)
        id = secrets.token_hex(8)
        if isinstance(present, str):
            return self._carry_out(id, number, meant, present)
        self._keep(id, SimulationTelling(DraftSimulation(meant, present)))
        return _advanced(self._tried[id], id, number, advance)

    def written_scenario(self, id: str, expected: ScenarioExpectation) -> WrittenScenarioView:
        """Return the scenario that a simulation becomes. Raises `EditError`."""
        return WrittenScenarioView(document=scenario_document(self._known(id).simulation, expected))

    def _carry_out(self, id: str, number: int, meant: Usable, name: str) -> SimulationView:
        scenario = named_scenario(found_in(meant.station)[0], name)
        runner = ScenarioRunner(meant, scenario, Budget.seconds(CAUGHT_UP_WITHIN), goes_back=True)
        telling = SimulationTelling(runner.simulation)
        model = telling.model()
        run = runner.run()
        self._keep(id, telling)
        return telling.view(id, number, 0.0, run.moments, None, model=model, scenario=run_view(run))

    def _keep(self, id: str, telling: SimulationTelling) -> None:
        self._tried[id] = telling
        if len(self._tried) > MOST_TRIED:
            self._tried.popitem(last=False)

    def _known(self, id: str) -> SimulationTelling:
        if id not in self._tried:
            raise NoSimulationError(message("step.no-simulation"))
        self._tried.move_to_end(id)
        return self._tried[id]

    def _go_on(self, id: str, number: int, meant: Usable | UnusableModelError, advance: Advance) -> SimulationView:
        telling = self._known(id)
        simulation = telling.simulation
        if isinstance(meant, UnusableModelError):
            return telling.view(id, number, simulation.passed, (), None, obstacle=meant.why)
        if simulation.automaton is not meant.automaton:  # the draft is another one: it goes on from where it is
            telling = SimulationTelling(DraftSimulation(meant, simulation.present, simulation.passed))
            self._tried[id] = telling
        return _advanced(telling, id, number, advance)


def _advanced(telling: SimulationTelling, id: str, number: int, advance: Advance) -> SimulationView:
    """Return a simulation once time has passed; a new model is told as it was before. Raises `EditError` for what
    cannot be done, and nothing has changed then.
    """
    simulation = telling.simulation
    until = None if advance.until is None else partial(holds, read_condition(simulation.automaton, advance.until))
    simulation.check_advance(advance)
    model = telling.model() if telling.is_new else None
    since = simulation.passed if model is not None or advance.at is None else simulation.go_back(advance.at)
    moments: list[SimulatedMoment] = []
    if advance.at is not None and advance.at > since:  # what is done is done there, however long the way takes
        moments, _ = simulation.go_on(advance.at - since, Budget.seconds(CAUGHT_UP_WITHIN))
    moments += simulation.do(advance)
    simulation.station.people_wait = advance.people_wait
    more, stopped = simulation.go_on(advance.seconds, Budget.seconds(ADVANCED_WITHIN), until, once=advance.once)
    return telling.view(id, number, since, [*moments, *more], stopped, model=model)


def answering(folder: Path) -> Callable[[SimulationQuestion, object], object]:
    """Return what answers questions, in an empty folder; a process's life."""
    service = SimulationService(folder)
    return lambda question, _: encoded(service.found_for(question))
