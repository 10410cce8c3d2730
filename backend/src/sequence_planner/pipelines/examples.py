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
from sequence_planner.pipelines.benches import Bench, FlowBench, GivenError, IncomingBench, OutgoingBench, Plain
from sequence_planner.pipelines.graph import StationPipelines
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

    def failures(self) -> list[Finding]:
        """What does not come as the example says, at most one finding for each name and moment."""
        name = self.pipeline
        bench: Bench
        if name in self.pipelines.outgoing:
            bench = OutgoingBench(self.pipelines.outgoing[name], self.automaton, self.registry)
        elif name in self.pipelines.incoming:
            bench = IncomingBench(self.pipelines.incoming[name], self._message)
        else:
            bench = FlowBench(self.pipelines.flows[name], self.pipelines)
        try:
            return [Finding(place.place, f"example `{self}`{text}") for place, text in self._run(bench)]
        finally:
            bench.chain.close()

    def _run(self, bench: Bench) -> Iterator[tuple[SourceText, str]]:
        document = self.document
        steps = document.steps or [ExampleStepDocument(at=0.0, given=document.given, gives=document.gives)]
        for step in steps:
            when = f" at {step.at:g} s" if document.steps else ""
            bench.pass_time(step.at)
            try:
                if step.given is not None:
                    bench.give({str(key): _plain(value) for key, value in step.given.items()}, step.at)
            except GivenError as error:
                yield document.name, f"{when}: what is given does not fit: {error}"
                return
            came = bench.came()
            for key, value in (step.gives or {}).items():
                wanted = _plain(value)
                if key not in came:
                    yield key, f"{when}: nothing named `{key}` comes of it{suggestion(key, came)}"
                elif not _agrees(came[key], wanted):
                    why = f" ({bench.trouble})" if bench.trouble and came[key] is None else ""
                    yield key, f"{when}: expected `{key}` to be {_said(wanted)}, and it is {_said(came[key])}{why}"

    def _message(self, type_name: str, given: Plain) -> Plain:
        """The message as it would come over the network, with defaults."""
        try:
            return self.registry.decode(type_name, self.registry.encode(type_name, given))
        except MessageValueError as error:
            raise GivenError(str(error)) from error


def _plain(value: object) -> object:
    """`value` without the places of its texts."""
    match value:
        case Mapping():
            return {str(key): _plain(entry) for key, entry in value.items()}
        case list():
            return [_plain(entry) for entry in value]
        case SourceText():
            return str(value)
    return value


def _agrees(came: object, wanted: object) -> bool:
    """Whether a value is as wanted: numbers but for rounding, and of nested messages the fields that are mentioned."""
    match came, wanted:
        case dict(), dict():
            return all(name in came and _agrees(came[name], value) for name, value in wanted.items())
        case list(), list():
            return len(came) == len(wanted) and all(map(_agrees, came, wanted))
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
