"""Execution of pipeline examples in simulated time, and comparison with expected results."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.field_paths import fits, shown
from sequence_planner.language.records.record import RealType, Record, RecordType
from sequence_planner.language.types import contains
from sequence_planner.model.documents import ExampleDocument, ExampleStepDocument
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.model.stages.base import Loadable
from sequence_planner.pipelines.chain_runtime import RunningChain, message_of
from sequence_planner.pipelines.graph import (
    EdgeView,
    Flow,
    IncomingPipeline,
    Joining,
    OutgoingPipeline,
    StationPipelines,
)
from sequence_planner.pipelines.runtime import written_values
from sequence_planner.ros.types.errors import MessageValueError
from sequence_planner.ros.types.messages import MessageRegistry

# Chains on their own, in time that is only told: what an example gives them, and what comes of it.

Plain = dict[str, object]


class GivenError(Exception):
    """The error for what an example gives and cannot be taken; the text says why."""


class ExampleHarness(ABC):
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
        """Return what has come of it, by name; None is unknown."""

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


class IncomingBench(ExampleHarness):
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


class FlowBench(ExampleHarness):
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


class OutgoingBench(ExampleHarness):
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


# Examples of pipelines, carried out in time that is only told: what goes in, what must come of it.
#
# An example is of one topic or flow alone, with its own stages. It begins with nothing remembered.


class PipelineExample(Immutable):
    """One example with what it is of."""

    pipeline: str
    document: ExampleDocument
    pipelines: StationPipelines
    automaton: Automaton
    registry: MessageRegistry

    def __str__(self) -> str:
        return f"{self.pipeline}: {self.document.name}"

    @property
    def steps(self) -> list[ExampleStepDocument]:
        """The steps that say what happens when."""
        document = self.document
        return document.steps or [ExampleStepDocument(at=0.0, given=document.given, gives=document.gives)]

    def failures(self) -> list[Finding]:
        """Return what does not come as the example says, at most one finding for each name and moment."""
        bench = bench_of(self.pipeline, self.pipelines, self.automaton, self.registry)
        try:
            return [Finding(place.place, f"example `{self}`{text}") for place, text in self._run(bench)]
        finally:
            bench.chain.close()

    def _run(self, bench: ExampleHarness) -> Iterator[tuple[SourceText, str]]:
        for step in self.steps:
            try:
                moment = moment_of(bench, step.at, given_by(step))
            except GivenError as error:
                yield self.document.name, f"{self._when(step)}: what is given does not fit: {error}"
                return
            for key, message in self.disagreements(step, moment):
                yield key, f"{self._when(step)}: {message}"

    def _when(self, step: ExampleStepDocument) -> str:
        return f" at {step.at:g} s" if self.document.steps else ""

    def disagreements(self, step: ExampleStepDocument, moment: ExampleMoment) -> Iterator[tuple[SourceText, str]]:
        """Yield what has not come of a step as the example says, by name."""
        for key, value in (step.gives or {}).items():
            wanted = plain(value)
            if key not in moment.came:
                yield key, f"nothing named `{key}` comes of it{suggestion(key, moment.came)}"
            elif not agrees(moment.came[key], wanted):
                came = moment.came[key]
                why = f" ({moment.trouble})" if moment.trouble and came is None else ""
                yield key, f"expected `{key}` to be {_said(wanted)}, and it is {_said(came)}{why}"


class ExampleMoment(Immutable):
    """The outcome of a pipeline by some moment, and what of it makes no sense; and what has passed each edge."""

    came: Plain
    trouble: str | None
    edges: tuple[EdgeView, ...]


def given_by(step: ExampleStepDocument) -> Plain | None:
    """Return what comes in a step of an example."""
    return None if step.given is None else {str(key): plain(value) for key, value in step.given.items()}


def moment_of(bench: ExampleHarness, at: float, given: Plain | None) -> ExampleMoment:
    """Let time pass, and give what comes then, if anything does. Raises `GivenError`."""
    bench.pass_time(at)
    if given is not None:
        bench.give(given, at)
    return ExampleMoment(bench.came(), bench.trouble, bench.chain.edges(""))


def bench_of(name: str, pipelines: StationPipelines, automaton: Automaton, registry: MessageRegistry) -> ExampleHarness:
    """The pipeline of a topic, of a flow, or of a part of a service or action, on its own. Raises KeyError."""

    def message(type_name: str, given: Plain) -> Plain:
        """The message as it would come over the network, with defaults."""
        try:
            return registry.decode(type_name, registry.encode(type_name, given))
        except MessageValueError as error:
            raise GivenError(str(error)) from error

    outgoing = pipelines.outgoing.get(name) or pipelines.requests.get(name)
    if outgoing is not None:
        return OutgoingBench(outgoing, automaton, registry)
    if name in pipelines.flows:
        return FlowBench(pipelines.flows[name], pipelines)
    return IncomingBench(pipelines.sources[name], message)


def plain(value: object) -> object:
    """`value` without the places of its texts."""
    match value:
        case Mapping():
            return {str(key): plain(entry) for key, entry in value.items()}
        case list():
            return [plain(entry) for entry in value]
        case SourceText():
            return str(value)
    return value


def agrees(came: object, wanted: object) -> bool:
    """Return whether a value is as wanted: numbers but for rounding, and of nested messages the fields that are
    mentioned.
    """
    match came, wanted:
        case dict(), dict():
            return all(name in came and agrees(came[name], value) for name, value in wanted.items())
        case list(), list():
            return len(came) == len(wanted) and all(map(agrees, came, wanted))
        case (bool(), _) | (_, bool()):
            return came is wanted
        case float(), float() | int():
            return math.isclose(came, wanted, rel_tol=1e-6, abs_tol=1e-9)
    return came == wanted


def _said(value: object) -> str:
    match value:
        case None:
            return "unknown"
        case bool():
            return "true" if value else "false"
        case str():
            return value if value.isidentifier() and value not in ("true", "false", "unknown") else shown(value)
    return shown(value)


def failures(examples: Sequence[PipelineExample]) -> list[Finding]:
    """Return what does not come as the examples say."""
    return [finding for example in examples for finding in example.failures()]


def loading_failures(pipelines: StationPipelines) -> list[Finding]:
    """The stages that cannot be loaded on this machine, such as functions that import what is not there."""
    chains = [node.chain for node in (*pipelines.nodes, *pipelines.outgoing.values())]
    stages = [stage for chain in chains for stage in chain.stages if isinstance(stage, Loadable)]
    return [Finding(stage.place, trouble) for stage in stages if (trouble := stage.loading_trouble()) is not None]
