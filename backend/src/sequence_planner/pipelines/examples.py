"""Examples of pipelines, carried out in time that is only told: what goes in, what must come of it.

An example is of one topic or flow alone, with its own stages. It begins with nothing remembered.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.model.flow_documents import ExampleDocument, ExampleStepDocument
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.pipelines.benches import (
    Bench,
    FlowBench,
    GivenError,
    IncomingBench,
    OutgoingBench,
    Plain,
)
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.pipelines.observation import EdgeView
from sequence_planner.pipelines.stage import Loadable
from sequence_planner.pipelines.stages.values import shown
from sequence_planner.ros.errors import MessageValueError
from sequence_planner.ros.messages import MessageRegistry


@dataclass(frozen=True)
class PipelineExample:
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
        """What happens when."""
        document = self.document
        return document.steps or [ExampleStepDocument(at=0.0, given=document.given, gives=document.gives)]

    def failures(self) -> list[Finding]:
        """What does not come as the example says, at most one finding for each name and moment."""
        bench = bench_of(self.pipeline, self.pipelines, self.automaton, self.registry)
        try:
            return [Finding(place.place, f"example `{self}`{text}") for place, text in self._run(bench)]
        finally:
            bench.chain.close()

    def _run(self, bench: Bench) -> Iterator[tuple[SourceText, str]]:
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

    def disagreements(self, step: ExampleStepDocument, moment: Moment) -> Iterator[tuple[SourceText, str]]:
        """What has not come of a step as the example says, by name."""
        for key, value in (step.gives or {}).items():
            wanted = plain(value)
            if key not in moment.came:
                yield key, f"nothing named `{key}` comes of it{suggestion(key, moment.came)}"
            elif not agrees(moment.came[key], wanted):
                came = moment.came[key]
                why = f" ({moment.trouble})" if moment.trouble and came is None else ""
                yield key, f"expected `{key}` to be {_said(wanted)}, and it is {_said(came)}{why}"


@dataclass(frozen=True)
class Moment:
    """What has come of a pipeline by some moment, and what of it makes no sense; and what has passed each edge."""

    came: Plain
    trouble: str | None
    edges: tuple[EdgeView, ...]


def given_by(step: ExampleStepDocument) -> Plain | None:
    """What comes in a step of an example."""
    return None if step.given is None else {str(key): plain(value) for key, value in step.given.items()}


def moment_of(bench: Bench, at: float, given: Plain | None) -> Moment:
    """Let time pass, and give what comes then, if anything does. Raises `GivenError`."""
    bench.pass_time(at)
    if given is not None:
        bench.give(given, at)
    return Moment(bench.came(), bench.trouble, bench.chain.edges(""))


def bench_of(name: str, pipelines: StationPipelines, automaton: Automaton, registry: MessageRegistry) -> Bench:
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
    """Whether a value is as wanted: numbers but for rounding, and of nested messages the fields that are mentioned."""
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
    """What does not come as the examples say."""
    return [finding for example in examples for finding in example.failures()]


def loading_failures(pipelines: StationPipelines) -> list[Finding]:
    """The stages that cannot be loaded on this machine, such as functions that import what is not there."""
    chains = [node.chain for node in (*pipelines.nodes, *pipelines.outgoing.values())]
    stages = [stage for chain in chains for stage in chain.stages if isinstance(stage, Loadable)]
    return [Finding(stage.place, trouble) for stage in stages if (trouble := stage.loading_trouble()) is not None]
