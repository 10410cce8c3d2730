"""The rig with devices that have a fault at some step of the main job. The work goes on, or the advisor has a way."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable
from functools import cache

from sequence_planner.controller.io.inputs import LastKnown
from sequence_planner.execution.timeouts import overdue
from sequence_planner.language.types import Value
from sequence_planner.pipelines.chain_runtime import first_message
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.manual_plans import stalled_effects
from sequence_planner.planning.recovery.proposals import Advice
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.simulation.faults import Clear, Fault, FaultKind, FaultyDevices
from support.simulated import Rig, truck_engine

KINDS = (FaultKind.SILENT, FaultKind.STUCK, FaultKind.WRONG, FaultKind.OFFLINE, FaultKind.RESTARTED)
RESOURCES = ("robot", "nutrunner")
STEPS = 14  # starts of the main job, before each of which a fault may begin
STALE = 2.0  # seconds after which a device that says nothing is not heard any more
LONGEST = 30.0  # seconds without any work, after which the advisor is asked


class FaultyRig(Rig):
    """Its devices may have faults. Those that are not heard are offline, as they are for a controller."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.faulty = FaultyDevices(self.devices, self.station.pipelines, self.seed)
        self.last = LastKnown(self.execution)
        self._heard: dict[str, float] = {}

    def run(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        end = self.now + seconds
        while self.now < end:
            self.now += self.step
            self.faulty.advance(self.now)
            self.tick()
            while self.ticks[-1].changed:
                self.tick()
            if until():
                return True
        return False

    def measured(self) -> dict[str, Value | None]:
        for name in self.station.pipelines.incoming:
            if (message := self.faulty.says(name)) is not None:
                self.pipelines.take(name, message, self.now)
                self._heard[name] = self.now
        fresh = {name: self._is_fresh(name) for name in self.station.pipelines.incoming}
        return self.pipelines.values(fresh)

    @property
    def offline(self) -> frozenset[str]:
        """The resources that are not heard."""
        incoming = self.station.pipelines.incoming
        return frozenset(each.topic.resource for name, each in incoming.items() if not self._is_fresh(name))

    def advice(self) -> Advice:
        """What the advisor says, as the controller would ask it."""
        execution = self.execution
        late = [
            self.station.automaton.abilities[step.ability].resource
            for step in execution.plan.order.running
            if overdue(step, self.station.automaton.abilities[step.ability], self.now) is not None
        ]
        stalled = stalled_effects(self.station.automaton, execution.state, late)
        goals = execution.pursued.select(execution.active & execution.pursued.goals.keys())
        circumstances = execution.circumstances
        return advisor().advise(
            AdviceRequest(execution.state, goals, circumstances, stalled, last=self.last.values, deadline=60)
        )

    def _is_fresh(self, topic: str) -> bool:
        return self.now - self._heard.get(topic, self.now - 2 * STALE) <= STALE

    def _publish(self, outputs: frozenset[str]) -> None:
        for name, pipeline in self.station.pipelines.outgoing.items():
            if outputs & set(pipeline.variables) and self.faulty.hears(name):
                message = first_message(pipeline, self.execution.state)
                assert message is not None
                assert not self.devices.command(name, message)

    def repeat(self) -> None:
        """As a controller does: a device that was away hears again what it was told."""
        self._publish(self.station.automaton.outputs)


@cache
def advisor() -> Advisor:
    """The advisor of the truck engine station."""
    station, supervisor, _ = truck_engine()
    return Advisor(station.automaton, supervisor)


def drawn(chance: random.Random, kind: FaultKind, resource: str, seconds: float | None) -> Fault:
    """A fault of one kind at one of the devices."""
    if kind is not FaultKind.WRONG:
        return Fault(kind, resource, seconds=seconds)
    automaton, feeds = truck_engine()[0].automaton, truck_engine()[0].pipelines.feeds
    names = sorted(name for name in feeds if automaton.variables[name].resource == resource)
    name = chance.choice(names)
    return Fault(kind, name, value=chance.choice(automaton.variables[name].type.domain), seconds=seconds)


def after_fault(seed: str) -> Counter[str]:
    """A fault at a step of the main job, which passes or stays. AssertionError when there is no way on from it."""
    chance = random.Random(seed)
    kind, resource, step = chance.choice(KINDS), chance.choice(RESOURCES), chance.randrange(STEPS)
    return after(chance, kind, resource, step, passes=chance.random() < 0.5)


def after(chance: random.Random, kind: FaultKind, resource: str, step: int, *, passes: bool) -> Counter[str]:
    """What comes of a fault at a device, as so many abilities have started."""
    rig = FaultyRig(seed=chance.randrange(1000), improves=False)
    rig.start_production()
    assert rig.run(300, lambda: len(rig.started) > step), "it does no work"
    rig.run(chance.uniform(0, 2))
    fault = drawn(chance, kind, resource, chance.uniform(0.5, 8) if passes else None)
    rig.faulty.start(fault, rig.now)
    case = f"{fault} as start {step} was made"
    done, worked, said = len(rig.completed), rig.now, len(rig.started)
    while len(rig.completed) < done + 3:
        rig.run(1)
        rig.repeat()
        if len(rig.started) > said:
            worked, said = rig.now, len(rig.started)
        if rig.now - worked > LONGEST:
            return _way(rig, case, kind)
    return Counter({f"{kind}: the work went on": 1})


def _way(rig: FaultyRig, case: str, kind: FaultKind) -> Counter[str]:
    """Nothing goes on: once the fault is over the work does, or else the advisor has a way, as it had before."""
    advice = rig.advice()
    assert advice.offers, (
        f"{case}: no way on ({advice.seconds:.0f} s, complete: {advice.complete}), {rig.execution.plan.reason}"
    )
    offered = advice.offers[0].kind
    rig.faulty.clear(Clear())
    said = len(rig.started)
    for _ in range(round(LONGEST)):
        rig.run(1)
        rig.repeat()
        if len(rig.started) > said:
            return Counter({f"{kind}: the work went on when it was over; before, the first offer was {offered}": 1})
    ways = rig.advice().offers
    assert ways, f"{case}: no way on after it"
    return Counter({f"{kind}: the first offer was {ways[0].kind}": 1})
