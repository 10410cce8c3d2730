"""Tells people what happens as a draft is tried."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.views.wording import reason_text
from sequence_planner.editor.schemas.draft import StepChangeView
from sequence_planner.editor.schemas.simulation import (
    DisturbableView,
    ScenarioRunView,
    SimulatedFaultView,
    SimulatedModelView,
    SimulatedStartView,
    SimulatedTaskView,
    SimulationMomentView,
    SimulationStop,
    SimulationView,
)
from sequence_planner.editor.simulating.simulation import DraftSimulation, SimulatedMoment
from sequence_planner.execution.forecast import Forecast
from sequence_planner.execution.vocabulary import PlanStatus
from sequence_planner.language.evaluator import evaluate
from sequence_planner.simulation.faults import Clear, Fault, FaultKind
from sequence_planner.texts.message import Argument, Message, message


class SimulationTelling:
    """Tells a `simulation` in the words of its model."""

    def __init__(self, simulation: DraftSimulation) -> None:
        self.simulation = simulation
        self.is_new = True  # nobody has been told of its model
        self._said = sentences_of(simulation.automaton)

    def view(
        self,
        id: str,
        number: int,
        since: float,
        moments: Sequence[SimulatedMoment],
        stopped: SimulationStop | None,
        *,
        model: SimulatedModelView | None = None,
        obstacle: Message | None = None,
        scenario: ScenarioRunView | None = None,
    ) -> SimulationView:
        """Return the simulation as it stands, and what has happened since."""
        self.is_new = self.is_new and model is None
        return SimulationView(
            id=id,
            number=number,
            obstacle=obstacle,
            seconds=self.simulation.passed,
            since=since,
            model=model,
            moments=[self._moment(each) for each in moments],
            tasks=list(self._tasks()),
            faults=list(self._faults()),
            plan=list(self._plan()),
            unplanned=self._unplanned(),
            violated=list(self._violated()),
            stopped=stopped,
            scenario=scenario,
        )

    def model(self) -> SimulatedModelView:
        """Return the model, and the present state as that before all moments that are told next."""
        simulation, automaton = self.simulation, self.simulation.automaton
        devices, execution = simulation.station.devices.devices, simulation.station.execution
        fed = {name: automaton.variables[name] for name in devices.topics}
        resources = dict.fromkeys(declared.resource for declared in fed.values() if declared.resource is not None)
        return SimulatedModelView(
            before={name: simulation.present[name] for name in automaton.variables},
            running=sorted(execution.running()),
            active=sorted(execution.active),
            safe=execution.safe,
            abilities={each.name: each.resource for each in automaton.abilities.values()},
            titles={each.name: each.title for each in automaton.abilities.values()},
            operations={each.name: each.title for each in automaton.operations.values()},
            resources=dict(automaton.resources),
            failing=list(resources),
            disturbable={
                name: DisturbableView(resource=declared.resource or "", domain=list(declared.type.domain))
                for name, declared in fed.items()
            },
        )

    def _moment(self, moment: SimulatedMoment) -> SimulationMomentView:
        return SimulationMomentView(
            seconds=moment.seconds,
            did=list(self._did(moment)),
            changes=list(self._changes(moment)),
            started=list(moment.started),
            ended=list(moment.ended),
            completed=sorted(moment.completed),
            running=sorted(moment.running),
            active=sorted(moment.active),
            safe=moment.safe,
        )

    def _did(self, moment: SimulatedMoment) -> Iterator[Message]:
        for fault in moment.began:
            yield self._fault(fault)
        for name, value in moment.sets.items():
            yield message("try.by-hand", so=self._said.tell_value(name, value))
        for ability in moment.done:
            yield message("try.done", ability=self.simulation.automaton.abilities[ability].title)

    def _fault(self, fault: Fault | Clear) -> Message:
        if fault.target is None:
            return message("try.clear-all")
        target = self._called(fault.target)
        if isinstance(fault, Clear):
            return message("try.clear", target=target)
        match fault.kind:
            case FaultKind.WRONG if fault.value is not None:
                return message("try.wrong", target=target, value=self._said.call_value(fault.target, fault.value))
            case FaultKind.SLOW:
                return message("try.slow", target=target, times=f"{fault.amount:g}")
            case kind:
                return message(f"try.{kind}", target=target)

    def _called(self, target: str) -> Argument:
        automaton = self.simulation.automaton
        if target in automaton.variables:
            return self._said.call_variable(target)
        return automaton.resources.get(target, target)

    def _changes(self, moment: SimulatedMoment) -> Iterator[StepChangeView]:
        for name, (before, after) in moment.changes.items():
            so = None if after is None else message("step.so", so=self._said.tell_value(name, after))
            yield StepChangeView(name=name, before=before, after=after, so=so)

    def _tasks(self) -> Iterator[SimulatedTaskView]:
        abilities = self.simulation.automaton.abilities
        for task in self.simulation.station.tasks.open.values():
            yield SimulatedTaskView(
                task=task.id,
                ability=task.ability,
                title=task.title,
                text=task.text,
                resource=abilities[task.ability].resource,
                since=task.created,
            )

    def _faults(self) -> Iterator[SimulatedFaultView]:
        for fault in self.simulation.station.devices.faults:
            yield SimulatedFaultView(line=str(fault), target=fault.target, said=self._fault(fault))

    def _plan(self) -> Iterator[SimulatedStartView]:
        abilities = self.simulation.automaton.abilities
        execution = self.simulation.station.execution
        forecast = Forecast(execution)
        forecast.look_through(self.simulation.passed)
        expected = forecast.expected()
        for step in execution.plan.order.ahead:
            if (due := expected.get(step.number)) is not None:
                yield SimulatedStartView(
                    ability=step.ability,
                    title=abilities[step.ability].title,
                    resource=abilities[step.ability].resource,
                    start=due.start,
                    end=due.end,
                )

    def _violated(self) -> Iterator[str]:
        """Yield the titles of the specifications that do not hold for certain."""
        for each in self.simulation.automaton.specifications.values():
            if evaluate(each.forbidden, self.simulation.present) is not False:
                yield each.title

    def _unplanned(self) -> Message | None:
        plan = self.simulation.station.execution.plan
        why = self.simulation.station.unplanned or (plan.reason if plan.status is PlanStatus.NONE else "")
        return reason_text(why) if why else None


def unusable_view(number: int, why: Message) -> SimulationView:
    """Return what is told where nothing can be tried."""
    return SimulationView(
        id=None,
        number=number,
        obstacle=why,
        seconds=0.0,
        since=0.0,
        model=None,
        moments=[],
        tasks=[],
        faults=[],
        plan=[],
        unplanned=None,
        violated=[],
        stopped=None,
    )
