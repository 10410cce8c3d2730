"""The bolt tightening station in a test, with whoever corrects it; the advisor plans at once, in this process."""

from __future__ import annotations

from collections.abc import Mapping

from controller.carrying_out import carry_out
from sequence_planner.analysis.mutual_exclusion import NeverTogether, never_together
from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.commands.recovery import CorrectEstimates
from sequence_planner.controller.features.variables import Beliefs
from sequence_planner.controller.recovery.consistency import ConsistencyMonitor
from sequence_planner.controller.recovery.corrections import Corrections
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import PlanAnswer, PlanRequest
from sequence_planner.process.budget import Budget
from support.people import EVA
from support.simulated import truck_engine

NOW = Timestamp(1000.0, 10.0)
WHY = "seen with my own eyes"


class Planning:
    """The station's own planner, in the place of another process."""

    async def answer(self, request: PlanRequest, deadline: float) -> PlanAnswer:
        return truck_engine()[2].answer(replace(request, deadline=60.0))  # however busy the machine is


def corrections(
    execution: Executor, doubting: ConsistencyMonitor | None = None, beliefs: Beliefs | None = None
) -> Corrections:
    return Corrections(
        execution,
        Planning().answer,
        Beliefs(execution) if beliefs is None else beliefs,
        ConsistencyMonitor(execution) if doubting is None else doubting,
        lambda names: None,
    )


class Station:
    """It, with what its devices measure."""

    def __init__(self, known: NeverTogether | None = None) -> None:
        station, supervisor, _ = truck_engine()
        self.automaton = station.automaton
        self.execution = Executor(self.automaton, supervisor)
        self.beliefs = Beliefs(self.execution)
        self.doubting = ConsistencyMonitor(self.execution, known)
        self.corrections = corrections(self.execution, self.doubting, self.beliefs)
        self.now = NOW
        self.measured = {name: self.automaton.initial_valuation[name] for name in self.automaton.names(Kind.MEASURED)}
        self.tick()

    def tick(self, **measured: Value | None) -> None:
        """One, 0.1 s later, with other measured values; for a dot in a name there are two lines."""
        self.measured |= {name.replace("__", "."): value for name, value in measured.items()}
        self.now = Timestamp(self.now.epoch + 0.1, self.now.monotonic + 0.1)
        self.execution.tick(self.measured, self.now)

    def correct(self, values: Mapping[str, Value], revision: int | None = None) -> None:
        seen = self.execution.revision if revision is None else revision
        command = CorrectEstimates(actor=EVA, reason=WHY, values=dict(values), revision=seen)
        carry_out(self.corrections, command, self.now)


def what_is_never_together() -> NeverTogether:
    station, supervisor, _ = truck_engine()
    found = never_together(station.automaton, supervisor, Budget.seconds(60))
    assert found is not None
    return found
