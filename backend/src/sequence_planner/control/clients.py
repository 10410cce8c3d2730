"""All services and actions that a running station uses: requests as the state wants them, answers heard as messages.

Nothing is asked for before production is started.
"""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence

from sequence_planner.automaton.structure import State
from sequence_planner.control.feeds import Feeds
from sequence_planner.control.goal_client import GoalClient
from sequence_planner.control.service_client import Hear, ServiceClient
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.pipelines.observation import PipelineView
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Endpoint, Transport


class Clients:
    """The clients of a station. `hear` is given what servers answer; it belongs on the event loop, and never waits."""

    def __init__(
        self, pipelines: StationPipelines, registry: MessageRegistry, transport: Transport, feeds: Feeds, hear: Hear
    ) -> None:
        services = [ServiceClient(use, registry, transport, feeds, hear) for use in pipelines.services.values()]
        self._actions = [GoalClient(use, registry, transport, feeds, hear) for use in pipelines.actions.values()]
        self._all: list[ServiceClient | GoalClient] = [*services, *self._actions]
        makers = (client.maker.running for client in self._all)
        self.requests = dict(zip(pipelines.requests, makers, strict=True))

    def heed(self, state: State, now: float) -> None:
        """The state is so now, and production runs: call, send and cancel what is wanted."""
        for client in self._all:
            client.heed(state, now)

    def look(self, graph: Sequence[Endpoint]) -> None:
        """The network is so now."""
        for client in self._actions:
            client.look(graph)

    def set_override(self, request: str, name: str, fields: Mapping[str, object], now: float, actor: str) -> None:
        """A person sets fields of the requests to come. Raises ValueError for what the model does not allow."""
        self.requests[request].set_override(name, fields, now, actor)

    def clear_override(self, request: str, name: str, now: float) -> None:
        """A person takes back what was set."""
        self.requests[request].clear_override(name, now)

    def observed(self, among: Container[str] | None = None) -> dict[str, PipelineView]:
        """What has passed each edge of each request's pipeline, or of those `among` these."""
        chosen = ((name, each) for name, each in self.requests.items() if among is None or name in among)
        return {name: running.observed() for name, running in chosen}

    def close(self) -> None:
        """Ask for nothing more. May be repeated."""
        for client in self._all:
            client.close()
