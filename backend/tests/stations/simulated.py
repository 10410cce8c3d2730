"""The station in the hall in simulated time: its world and its drivers, and the execution and planner of the product.

Nodes speak and hear as their processes do, without a network: whether a step is wrong is judged by the world alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from sequence_planner.controller.features.tasks import TaskHandler
from sequence_planner.language.types import Value
from sequence_planner.pipelines.chain_runtime import first_message
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.simulation.truck_station.drivers import Driver
from sequence_planner.simulation.truck_station.nodes import NODE_TYPES, PACKAGE, PREFIX
from sequence_planner.simulation.truck_station.signals import read, set_signals
from sequence_planner.simulation.truck_station.world import World
from support.places import TRUCK_ENGINE_STATION
from support.simulated import Rig, never

SAYS = {f"{PREFIX}/{kind.says[0]}": name for name, kind in NODE_TYPES.items()}
HEARS = {
    f"{PREFIX}/{kind.hears[0]}": (name, f"{PACKAGE}/{kind.hears[1]}")
    for name, kind in NODE_TYPES.items()
    if kind.hears is not None
}
STEP = 0.01  # seconds of the world between two looks at it
REPEATED = 1.0  # seconds after which the controller says again what it wants
DEADLINE = 1.0  # seconds after which what a node said counts no more


class SimulatedHall:
    """World and drivers, in the place of the emulated devices of a rig. Times in seconds."""

    def __init__(self, registry: MessageRegistry, seed: int, now: float) -> None:
        self.world = World(seed)
        self._registry = registry
        self._drivers: dict[str, Driver] = {name: kind.driver() for name, kind in NODE_TYPES.items()}
        self._reports: dict[str, dict[str, object]] = {}
        self._silent: dict[str, float] = {}  # node: until when
        self._frozen: dict[str, float] = {}
        self._away: dict[str, float] = {}
        self._now = self._heard = now
        self.advance(now)

    def silence(self, node: str, seconds: float) -> None:
        """It hears and acts, and says nothing."""
        self._silent[node] = self._now + seconds

    def freeze(self, node: str, seconds: float) -> None:
        """It hears, and repeats what it said last; its device is not reached."""
        self._frozen[node] = self._now + seconds

    def leave(self, node: str, seconds: float) -> None:
        """It is not on the network; its device is reached."""
        self._away[node] = self._now + seconds

    def restart(self, node: str, seconds: float) -> None:
        """It ends, and is there again after so long; what it has heard is forgotten."""
        self._drivers[node] = NODE_TYPES[node].driver()
        self.leave(node, seconds)

    def speaks(self, topic: str) -> bool:
        """Whether the node behind a topic is heard."""
        node = SAYS[topic]
        return self._now >= max(self._silent.get(node, 0.0), self._away.get(node, 0.0))

    def advance(self, now: float) -> None:
        """Let time pass."""
        while self._now + STEP <= now:
            self._now += STEP
            self.world.advance(STEP)
        for topic, node in SAYS.items():
            if self._now < self._frozen.get(node, 0.0) and topic in self._reports:
                continue
            driver = self._drivers[node]
            set_signals(self.world, node, driver.signals(self._now))
            kind = f"{PACKAGE}/{NODE_TYPES[node].says[1]}"
            said = self._registry.encode(kind, driver.say(read(self.world, node), self._now))
            self._reports[topic] = self._registry.decode(kind, said)

    def report(self, topic: str) -> dict[str, object]:
        """What the node behind an incoming topic says now."""
        return self._reports[topic]

    def command(self, topic: str, message: Mapping[str, object]) -> None:
        """A message of the controller; a node that is away does not hear it."""
        node, kind = HEARS[topic]
        if self._now >= self._away.get(node, 0.0):
            self._drivers[node].on_command(self._registry.decode(kind, self._registry.encode(kind, message)), self._now)


class HallRig(Rig):
    """The controller's execution at the hall; what it wants it says again and again."""

    def __init__(self, seed: int = 0, folder: Path = TRUCK_ENGINE_STATION) -> None:
        super().__init__(folder=folder, seed=seed, acknowledges=never)
        self.desk = TaskHandler(self.station.automaton, self.station.pipelines.feeds)
        self.hall = SimulatedHall(self.station.registry, seed, self.now)
        self._spoke = dict.fromkeys(SAYS, self.now)
        self._repeated = self.now

    def live(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass; whether `until` came true. AssertionError at the first wrong step."""
        end = self.now + seconds
        while self.now < end:
            self.now += self.step
            self.hall.advance(self.now)
            if self.now >= self._repeated + REPEATED:
                self._repeated = self.now
                self._publish(self.station.automaton.outputs)
            self.tick()
            while self.ticks[-1].changed:
                self.tick()
            assert not self.hall.world.verdict.wrong, self.hall.world.verdict.events[-10:]
            if until():
                return True
        return False

    def measured(self) -> dict[str, Value | None]:
        """What the nodes say that are heard; unknown is what was not heard of for longer than the deadline."""
        for topic in SAYS:
            if self.hall.speaks(topic):
                self._spoke[topic] = self.now
                self.pipelines.take(topic, self.hall.report(topic), self.now)
        fresh = {topic: self.now - spoke <= DEADLINE for topic, spoke in self._spoke.items()}
        for topic in (topic for topic, is_fresh in fresh.items() if not is_fresh):
            self.pipelines.forget(topic)
        return self.pipelines.values(fresh)

    def _publish(self, outputs: frozenset[str]) -> None:
        for topic, pipeline in self.station.pipelines.outgoing.items():
            if self.execution.production == "started" and outputs & set(pipeline.variables):
                message = first_message(pipeline, self.execution.state)
                assert message is not None
                self.hall.command(topic, message)
