"""The checked pipeline graph of a station, its edge statistics, and the goal states of actions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from sequence_planner.core.immutable import Immutable
from sequence_planner.language.records.record import Record, RecordType
from sequence_planner.language.types import Type
from sequence_planner.model.stages.base import Override, Stage
from sequence_planner.ros.qos import QualityOfService

# What can become of the goal of an action, as a measured variable says it.


class GoalState(StrEnum):
    """The state of the goal of an action.

    `IDLE`: none is wanted, or the one that is wanted has not been answered yet. `LOST`: nobody knows, for the server is
    not there, does not answer or has been started anew.
    """

    IDLE = "idle"
    ACCEPTED = "accepted"
    EXECUTING = "executing"
    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"
    REJECTED = "rejected"
    LOST = "lost"


# A goal that a server has taken up and not done with is in one of these states, for however short a time.
GOAL_ON_ITS_WAY = (GoalState.ACCEPTED, GoalState.EXECUTING)

# The enumeration that a `status` has without being declared.
GOAL_STATE = "goal_state"

# The state of a goal is told as a text.
STATUS_TYPE, STATUS_FIELD = "std_msgs/msg/String", "data"


# The pipelines of a station as checked: a graph of topics, flows and variables, joined by chains of stages.
#
# Everything here is immutable and shared; what changes while the station runs is in `runtime`.


class Topic(Immutable):
    """A topic as the station uses it."""

    name: str
    type_name: str
    resource: str
    quality: QualityOfService


class Chain(Immutable):
    """Stages, one after the other, and the fields of a record before the first and after each."""

    stages: tuple[Stage, ...]
    fields: tuple[RecordType, ...]

    @property
    def end(self) -> RecordType:
        """The fields of a record that has passed all stages."""
        return self.fields[-1]

    @property
    def is_timed(self) -> bool:
        """True if a record that says the same as the one before can make a difference."""
        return any(stage.is_timed for stage in self.stages)


class VariableField(Immutable):
    """A field that is a variable at the end of a chain. `between` is what a discretised one is between its points."""

    field: str
    variable: str
    type: Type
    between: str | None = None


class IncomingPipeline(Immutable):
    """From messages to measured variables. Without a message for `deadline` seconds they are unknown."""

    topic: Topic
    deadline: float | None
    chain: Chain
    writings: tuple[VariableField, ...] = ()

    @property
    def name(self) -> str:
        """The name of the topic."""
        return self.topic.name

    @property
    def variables(self) -> tuple[str, ...]:
        """The variables that this topic feeds by itself."""
        return tuple(writing.variable for writing in self.writings)


class Joining(StrEnum):
    """The way a flow comes of its sources."""

    BRANCH = "branch"  # the records of one source, a second time
    INTERLEAVE = "interleave"  # the records of several, in the order of arrival
    MERGE = "merge"  # the latest record of each, as one


class Flow(Immutable):
    """A chain behind topics or other flows. `sources` has them by alias, which outside a merge is their own name."""

    name: str
    resource: str
    joining: Joining
    sources: Mapping[str, str]
    chain: Chain
    writings: tuple[VariableField, ...] = ()

    @property
    def variables(self) -> tuple[str, ...]:
        """The variables that this flow feeds by itself."""
        return tuple(writing.variable for writing in self.writings)


class Setting(Immutable):
    """A field of an outgoing message and the field of the last record that it takes; `depends` are its variables."""

    field: str
    depends: frozenset[str]


class OutgoingPipeline(Immutable):
    """From variables to messages, repeated `every` so many seconds.

    `read` has the variables of the resource by their names without it, as they stand in the first record.
    """

    topic: Topic
    every: float | None
    chain: Chain
    settings: tuple[Setting, ...]
    read: Mapping[str, str]
    depends: frozenset[str]

    @property
    def variables(self) -> tuple[str, ...]:
        """The variables whose change makes a new message, in the order of their declaration."""
        return tuple(variable for variable in self.read.values() if variable in self.depends)


class ServiceUse(Immutable):
    """A service that the station calls when the output `when` rises, every so many seconds, or both."""

    name: str
    type_name: str
    when: str | None
    every: float | None
    deadline: float
    request: OutgoingPipeline
    response: IncomingPipeline


class ActionUse(Immutable):
    """An action that is sent a goal when the output `when` rises, which is cancelled when that falls."""

    name: str
    type_name: str
    when: str
    deadline: float
    goal: OutgoingPipeline
    feedback: IncomingPipeline
    result: IncomingPipeline
    status: IncomingPipeline


@dataclass(frozen=True)
class StationPipelines:
    """All pipelines of a station, by topic, and the flows in an order in which each stands behind its sources.

    Those of `services` and `actions` are called after their part, such as `/mir/state response`.
    """

    incoming: Mapping[str, IncomingPipeline]
    outgoing: Mapping[str, OutgoingPipeline]
    flows: Mapping[str, Flow] = field(default_factory=dict)
    services: Mapping[str, ServiceUse] = field(default_factory=dict)
    actions: Mapping[str, ActionUse] = field(default_factory=dict)

    @property
    def answers(self) -> Mapping[str, IncomingPipeline]:
        """The pipelines of what services and actions answer."""
        responses = [use.response for use in self.services.values()]
        told = [part for use in self.actions.values() for part in (use.feedback, use.result, use.status)]
        return {part.name: part for part in (*responses, *told)}

    @property
    def requests(self) -> Mapping[str, OutgoingPipeline]:
        """The pipelines of what services and actions are asked."""
        asked = (*(use.request for use in self.services.values()), *(use.goal for use in self.actions.values()))
        return {part.topic.name: part for part in asked}

    @property
    def sources(self) -> Mapping[str, IncomingPipeline]:
        """Everything from which measured variables come: topics, and answers of services and actions."""
        return {**self.incoming, **self.answers}

    @property
    def carried(self) -> frozenset[str]:
        """The variables of which devices hear."""
        said = (name for part in (*self.outgoing.values(), *self.requests.values()) for name in part.variables)
        return self.heeded.union(said)

    @property
    def heeded(self) -> frozenset[str]:
        """The outputs whose rise asks something of a device."""
        of_services = (use.when for use in self.services.values() if use.when is not None)
        return frozenset((*of_services, *(use.when for use in self.actions.values())))

    @property
    def feeds(self) -> Mapping[str, str]:
        """The topic, or the flow, that feeds each measured variable."""
        return {variable: node.name for node in self.nodes for variable in node.variables}

    @property
    def heard_on(self) -> Mapping[str, str]:
        """The topics from which each measured variable comes, in words."""
        return {variable: " and ".join(sorted(self.topics_of(name))) for variable, name in self.feeds.items()}

    @property
    def timed(self) -> frozenset[str]:
        """The measured variables that time alone can change: a stage on their way goes by it."""
        return frozenset(
            name for name, node in self.feeds.items() if any(each.chain.is_timed for each in self.passed_through(node))
        )

    def passed_through(self, name: str) -> tuple[IncomingPipeline | Flow, ...]:
        """Everything through which the records of a topic or a flow come, each behind its sources, and itself."""
        found = {name}
        for flow in reversed(list(self.flows.values())):
            if flow.name in found:
                found.update(flow.sources.values())
        return tuple(node for node in self.nodes if node.name in found)

    @property
    def nodes(self) -> tuple[IncomingPipeline | Flow, ...]:
        """The incoming topics and the flows, each behind its sources; answers are like topics."""
        return (*self.sources.values(), *self.flows.values())

    def node(self, name: str) -> IncomingPipeline | Flow:
        """An incoming topic or a flow by its name. Raises KeyError."""
        return self.flows.get(name) or self.sources[name]

    def topics_of(self, name: str) -> frozenset[str]:
        """The topics from which a flow comes; a topic comes from itself."""
        if name not in self.flows:
            return frozenset({name})
        return frozenset().union(*(self.topics_of(source) for source in self.flows[name].sources.values()))

    def readers(self, name: str) -> list[Flow]:
        """The flows that read a topic or a flow directly."""
        return [flow for flow in self.flows.values() if name in flow.sources.values()]


# What can be seen of running pipelines: how much has passed each edge, and what last.
#
# An edge leads to a stage, or from the last one to the end. While a pipeline runs, an edge only counts and keeps a
# reference to the record; a view of it is made when somebody asks.


@dataclass(slots=True)
class Edge:
    """A view of what has passed an edge while the station runs; `at` is on the clock of the pipelines."""

    records: int = 0
    last: Record | None = None
    at: float | None = None

    def passed(self, record: Record, now: float) -> None:
        """A record passes."""
        self.records += 1
        self.last = record
        self.at = now


class EdgeView(Immutable):
    """One edge: where it leads (`3 discretise`, or the name of the end), and what has passed it.

    `held` are the records the stage has not let through so far: dropped, held back, or made one of several.
    """

    to: str
    records: int
    held: int
    last: Mapping[str, object] | None
    troubles: tuple[str, ...]
    at: float | None


class PipelineView(Immutable):
    """The pipeline of one topic or flow, from its source to its end; `repeated` messages said nothing new."""

    name: str
    sources: tuple[str, ...]
    edges: tuple[EdgeView, ...]
    repeated: int
    overrides: Mapping[str, Override | None]
