"""The clients of the mixer, with outputs as a test sets them, and an action server that does what a test says."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping, Sequence

from controller.mixing import STIR, STIR_TYPE, Plant
from sequence_planner.controller.io.clients import Clients
from sequence_planner.controller.io.inputs import Inputs, one_per_topic
from sequence_planner.language.types import Value
from sequence_planner.ros.actions import ActionServer, GoalOutcome, GoalStatus, GoalWork, cancelled
from sequence_planner.ros.transport import Sample


class Asking:
    """The clients as a controller has them. `seen` has every state of the goal, in order."""

    def __init__(self, plant: Plant) -> None:
        station = plant.station
        self._initial = station.automaton.initial_valuation
        self._outputs: dict[str, Value | None] = {}
        self.transport = plant.join("sequence_planner")
        self.feeds = Inputs(station.pipelines, station.registry, self._initial)
        self.seen: list[Value | None] = []
        self.clients = Clients(station.pipelines, station.registry, self.transport, self.feeds, self._hear)
        self._heed()
        self._task = asyncio.create_task(self._live())

    def set(self, **outputs: Value) -> None:
        """Set outputs of the tank, as abilities would."""
        self._outputs |= {f"tank.{name}": value for name, value in outputs.items()}
        self._heed()

    def value(self, name: str) -> Value | None:
        """What is known of a variable of the tank."""
        return self.feeds.measured(time.monotonic())[f"tank.{name}"]

    def reported(self, place: str) -> list[tuple[str, int]]:
        """What is reported of a topic, a service or an action, and how often it was so."""
        return [(each.text, each.count) for at, _, each in self.feeds.reports.current(time.monotonic()) if at == place]

    def end(self) -> None:
        """End as a controller does that is stopped."""
        self._task.cancel()
        self.clients.close()
        self.transport.close()

    async def _live(self) -> None:
        while True:
            self._heed()
            self.clients.look(self.transport.graph())
            await asyncio.sleep(0.01)

    def _heed(self) -> None:
        self.clients.heed({**self._initial, **self._outputs}, time.monotonic())
        self._note()

    def _hear(self, samples: Sequence[Sample]) -> None:
        for part in one_per_topic(samples):
            self.feeds.take(part)
            self._note()

    def _note(self) -> None:
        state = self.value("stirring")
        if self.seen[-1:] != [state]:
            self.seen.append(state)


class Stirrer:
    """A server of the action that goes on until it is told how to end; `taken` has the goals that it was sent."""

    def __init__(self, plant: Plant, accepts: bool = True) -> None:
        self.taken: list[object] = []
        self.cancelled = 0
        self.accepts = accepts
        self.work: GoalWork | None = None
        self._outcome: asyncio.Future[GoalOutcome] = asyncio.get_running_loop().create_future()
        self._transport = plant.join("stirrer")
        self._server = ActionServer(
            self._transport, plant.station.registry, STIR, STIR_TYPE, self._execute, self._is_taken
        )

    def end(self, status: GoalStatus, turns: int = 0) -> None:
        """End the goal that is under way."""
        self._outcome.set_result(GoalOutcome(status, {"turns": turns}))

    def die(self) -> None:
        """Go without a word."""
        self._server.close()
        self._transport.close()

    def _is_taken(self, goal: Mapping[str, object]) -> bool:
        self.taken.append(goal["speed"])
        return self.accepts

    async def _execute(self, work: GoalWork) -> GoalOutcome:
        self.work = work
        self._outcome = asyncio.get_running_loop().create_future()
        while not self._outcome.done():
            if await cancelled(work.cancel_wanted, 0.01):
                self.cancelled += 1
                return GoalOutcome(GoalStatus.CANCELED, {})
        return self._outcome.result()
