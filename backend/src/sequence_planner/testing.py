"""For the tests of a station: the examples of its pipelines and its scenarios, each as a test of its own.

    from pathlib import Path

    import pytest

    from sequence_planner.testing import Example, ScenarioTest, examples, scenarios

    STATION = Path(__file__).parent

    @pytest.mark.parametrize("example", examples(STATION), ids=str)
    def test_pipelines(example: Example) -> None:
        example.check()

    @pytest.mark.parametrize("scenario", scenarios(STATION), ids=str)
    def test_scenarios(scenario: ScenarioTest) -> None:
        scenario.check()

`sequence-planner check` carries out the same examples, and `sequence-planner test` the same scenarios.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from sequence_planner.analysis.kept import with_supervisor
from sequence_planner.editor.simulating.scenario_run import ScenarioRunner
from sequence_planner.editor.usable import Usable, supervisor_in
from sequence_planner.model.source import ModelError
from sequence_planner.pipelines.examples import PipelineExample
from sequence_planner.process.budget import Budget
from sequence_planner.scenarios.scenario import Scenario, scenarios_of
from sequence_planner.station import prepare_station

__all__ = ["Example", "ScenarioTest", "examples", "scenarios"]


@dataclass(frozen=True)
class Example:
    """One example of a topic or flow, as it stands in the model."""

    of: PipelineExample

    def __str__(self) -> str:
        return str(self.of)

    def check(self) -> None:
        """Carry it out. Raises AssertionError saying what was expected, where, and what came."""
        if failures := self.of.failures():
            raise AssertionError("\n".join(map(str, failures)))


@dataclass(frozen=True)
class ScenarioTest:
    """One scenario, as it stands in the station's `tests`."""

    of: Scenario
    meant: Usable = field(repr=False)

    def __str__(self) -> str:
        return self.of.name

    def check(self, within: float = 60.0) -> None:
        """Carry it out in simulated time, in so many seconds of the machine's. Raises AssertionError saying what did
        not come about, and where it stands.
        """
        failure = ScenarioRunner(self.meant, self.of, Budget.seconds(within)).run().failure
        if failure is not None:
            raise AssertionError(f"{failure.place}: {failure.why}")


def examples(folder: Path) -> list[Example]:
    """All examples of the station in `folder`. Raises `ModelError` when it cannot be used."""
    return [Example(each) for each in prepare_station(folder).examples]


def scenarios(folder: Path) -> list[ScenarioTest]:
    """All scenarios of the station in `folder`. Raises `ModelError` when it, or one of them, cannot be used."""
    station = prepare_station(folder)
    if station.written is None:
        return []
    found, wrong = scenarios_of(station.automaton, station.written, station.pipelines)
    if wrong:
        raise ModelError(wrong)
    meant = Usable(station, supervisor_in("whole", with_supervisor(station.automaton)))
    return [ScenarioTest(each, meant) for each in found]
