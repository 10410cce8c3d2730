"""Chains on their own, in time that is only told: what an example gives them, and what comes of it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping

from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import contains
from sequence_planner.pipelines.graph import Flow, IncomingPipeline, Joining, OutgoingPipeline, StationPipelines
from sequence_planner.pipelines.record import RealType, Record, RecordType
from sequence_planner.pipelines.running import written_values
from sequence_planner.pipelines.running_chain import RunningChain
from sequence_planner.pipelines.running_outgoing import message_of
from sequence_planner.pipelines.stages.values import fits, shown
from sequence_planner.ros.errors import MessageValueError
from sequence_planner.ros.messages import MessageRegistry

Plain = dict[str, object]


class GivenError(Exception):
    """What an example gives cannot be taken; the text says why."""


class Bench(ABC):
    """A chain on its own, in time that is told."""

    trouble: str | None = None

    def __init__(self, chain: RunningChain) -> None:
        self.chain = chain
        self.last: Record | None = None

    def pass_time(self, now: float) -> None:
        """Let stages have their time, one moment after the other."""
        while (due := self.chain.due) is not None and due <= now:
            for record in self.chain.wake(due):
                self.last = record
            if self.chain.due == due:
                return

    @abstractmethod
    def give(self, given: Plain, now: float) -> None:
        """Take what an example gives. Raises `GivenError`."""

    @abstractmethod
    def came(self) -> Plain:
        """What has come of it, by name; None is unknown."""

    def take(self, values: Plain, now: float) -> None:
        """Take a record."""
        record = self.chain.take(Record(values), now)
        if record is not None:
            self.last = record

    def read(self, node: IncomingPipeline | Flow) -> Plain:
        """The fields at the end, those that are variables as these take them."""
        if self.last is None:
            return dict.fromkeys(node.chain.end)
        variables, self.trouble = written_values(node.writings, self.last)
        own = {writing.field: variables[writing.variable] for writing in node.writings}
        return {**dict.fromkeys(node.chain.end), **self.last.values, **own}


class IncomingBench(Bench):
    """An incoming topic. `message` makes of what is given what would come over the network."""

    def __init__(self, pipeline: IncomingPipeline, message: Callable[[str, Plain], Plain]) -> None:
        super().__init__(RunningChain(pipeline.chain, patient=True))
        self._pipeline = pipeline
        self._message = message
        self._heard: float | None = None

    def pass_time(self, now: float) -> None:
        """As on a station, everything is forgotten when the topic has been silent beyond its deadline."""
        deadline = self._pipeline.deadline
        if self._heard is not None and deadline is not None and now - self._heard > deadline:
            self.chain.restart()
            self.last = self._heard = None
        super().pass_time(now)

    def give(self, given: Plain, now: float) -> None:
        """Take a message."""
        self._heard = now
        self.take(self._message(self._pipeline.topic.type_name, given), now)

    def came(self) -> Plain:
        """The variables and other fields at the end."""
        return self.read(self._pipeline)


class FlowBench(Bench):
    """A flow, whose sources are given."""

    def __init__(self, flow: Flow, pipelines: StationPipelines) -> None:
        super().__init__(RunningChain(flow.chain, patient=True))
        self._flow = flow
        self._ends = {alias: pipelines.node(source).chain.end for alias, source in flow.sources.items()}
        self._values: Plain = {}

    def give(self, given: Plain, now: float) -> None:
        """Take records of sources, by alias in a merge."""
        if self._flow.joining is not Joining.MERGE:
            self.take(_fitting(given, self._flow.chain.fields[0]), now)
            return
        for alias, values in _checked(given, self._ends).items():
            if not isinstance(values, dict):
                raise GivenError(f"`{alias}` is a source: give its fields")
            self._values |= {f"{alias}.{name}": value for name, value in _fitting(values, self._ends[alias]).items()}
        if all(any(name.startswith(f"{alias}.") for name in self._values) for alias in self._ends):
            self.take(dict(self._values), now)

    def came(self) -> Plain:
        """The variables and other fields at the end."""
        return self.read(self._flow)


class OutgoingBench(Bench):
    """An outgoing topic, whose variables are given."""

    def __init__(self, pipeline: OutgoingPipeline, automaton: Automaton, registry: MessageRegistry) -> None:
        super().__init__(RunningChain(pipeline.chain, patient=True))
        self._pipeline = pipeline
        self._types = {name: automaton.variables[full].type for name, full in pipeline.read.items()}
        self._state: Plain = {name: automaton.variables[full].initial for name, full in pipeline.read.items()}
        self._registry = registry

    def give(self, given: Plain, now: float) -> None:
        """Change variables; all others are as at the beginning."""
        for name, value in _checked(given, self._types).items():
            if value is not None and not contains(self._types[name], value):
                raise GivenError(f"`{name}` ranges over {self._types[name]}, and {shown(value)} is none of it")
        self._state |= given
        self.take(dict(self._state), now)

    def came(self) -> Plain:
        """The last message, as it goes over the network."""
        type_name = self._pipeline.topic.type_name
        if self.last is None:
            return dict.fromkeys(self._registry.fields(type_name))
        try:
            data = self._registry.encode(type_name, message_of(self._pipeline, self.last))
        except MessageValueError as error:
            self.trouble = str(error)
            return dict.fromkeys(self._registry.fields(type_name))
        return self._registry.decode(type_name, data)


def _fitting(given: Plain, known: RecordType) -> Plain:
    """`given`, if all its names are known and all its values of their types; raises `GivenError`.

    As in messages, real numbers need not be finite.
    """
    for name, value in _checked(given, known).items():
        may_be_any = value is None or (isinstance(value, float) and isinstance(known[name], RealType))
        if not may_be_any and not fits(known[name], value):
            raise GivenError(f"`{name}` is {known[name]}, and {shown(value)} is no value of that type")
    return given


def _checked(given: Plain, known: Mapping[str, object]) -> Plain:
    """`given`, if all its names are known; raises `GivenError`."""
    for name in given:
        if name not in known:
            raise GivenError(f"there is no `{name}`{suggestion(name, known)}")
    return given
