"""A station ready to run: its automaton, its pipelines and its message types, all checked."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from sequence_planner.analysis.checks.connections import Connections
from sequence_planner.analysis.checks.warning import ModelWarning, described
from sequence_planner.analysis.store import content_key, read, write
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.declarations import OPERATION, GroundBefore
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import TRUE, variables
from sequence_planner.model.documents import ExampleDocument
from sequence_planner.model.loader import ReadBefore, Station, load_station
from sequence_planner.model.source import Finding, ModelError
from sequence_planner.pipelines.builder import build_pipelines, flow_name, load_messages
from sequence_planner.pipelines.examples import PipelineExample, failures, loading_failures
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.pipelines.inference import with_inferred_variables, wrong_in_unused_types
from sequence_planner.planning.goals.monitor import TooManyStatesError, monitor_of
from sequence_planner.process.gc_tuning import collection_put_off
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.scenarios.suspicions import all_suspicions
from sequence_planner.texts.message import message


@dataclass(frozen=True)
class ReadyStation:
    """The station that the controller runs, and that the emulated devices are made from. `ros_1` are the topics of ROS
    1.

    `goes_on` says that nobody needs to confirm production where a hot standby has taken over. It is as it is `written`.
    """

    automaton: Automaton
    pipelines: StationPipelines
    registry: MessageRegistry
    ros_1: frozenset[str] = frozenset()
    examples: tuple[PipelineExample, ...] = ()
    goes_on: bool = False
    written: Station | None = None

    @property
    def approval_is_dual(self) -> bool:
        """Return whether a second person approves what takes the place of this model."""
        return self.written is not None and self.written.station.deployment_approval == "dual"

    @property
    def connections(self) -> Connections:
        """The connections that topics, services and actions feed and carry."""
        return Connections(frozenset(self.pipelines.feeds), self.pipelines.carried)

    def suspicions(self) -> list[ModelWarning]:
        """Return what is suspicious in its documents, its pipelines and its scenarios."""
        return list(all_suspicions(self.written, self.automaton, self.pipelines))

    def failures(self) -> list[Finding]:
        """Return what is wrong with the pipelines as they run: stages that cannot be loaded, and else examples that
        fail.
        """
        return loading_failures(self.pipelines) or failures(self.examples)


@dataclass
class Before:
    """The parts kept of a station that is read again and again while somebody edits it; reading it fills them in."""

    files: ReadBefore = field(default_factory=ReadBefore)
    abilities: GroundBefore = field(default_factory=GroundBefore)


@dataclass(frozen=True)
class MeantStation:
    """A station of which all texts mean something: with its inferred variables, its message types, its automaton."""

    station: Station
    registry: MessageRegistry
    automaton: Automaton


@collection_put_off()
def read_station(folder: Path, before: Before | None = None) -> MeantStation:
    """Load a station's folder, without its pipelines; what is the same as `before` is not read again.

    Raises `ModelError` with the findings.
    """
    before = before or Before()
    written = load_station(folder, before.files)
    registry = load_messages(written)
    station = with_inferred_variables(written, registry)
    unusable = wrong_in_unused_types(written, registry)
    try:
        automaton = ground(station, before.abilities)
    except ModelError as error:
        raise ModelError([*error.findings, *unusable]) from error
    if unusable:
        raise ModelError(unusable)
    _require_plannable(automaton)
    _require_possible_beginning(automaton)
    return MeantStation(station, registry, automaton)


@dataclass(frozen=True)
class ReadStation:
    """The parts kept of a station that was read: message types are classes, and made anew."""

    station: Station
    automaton: Automaton


def _read_or_kept(folder: Path) -> MeantStation:
    """Return what the files of a station mean: each of its processes needs that, and they have mostly been read
    before.
    """
    content = content_key(folder)
    known = None if content is None else read(content, ReadStation)
    if known is not None:
        return MeantStation(known.station, load_messages(known.station), known.automaton)
    meant = read_station(folder)
    if content is not None and content == content_key(folder):  # nobody has changed it meanwhile
        write(content, ReadStation(meant.station, meant.automaton))
    return meant


@collection_put_off()
def prepare_station(folder: Path) -> ReadyStation:
    """Load and check a station's folder. Raises `ModelError` with the findings."""
    meant = _read_or_kept(folder)
    station, registry, automaton = meant.station, meant.registry, meant.automaton
    pipelines = build_pipelines(station, automaton, registry)
    examples = tuple(
        PipelineExample(name, document, pipelines, automaton, registry)
        for name, written in _examples(station)
        for document in written
    )
    goes_on = station.station.takeover == "automatic"
    return ReadyStation(automaton, pipelines, registry, _of_ros_1(station), examples, goes_on, station)


def _examples(station: Station) -> Iterator[tuple[str, list[ExampleDocument]]]:
    """The examples of each topic and flow, by its name."""
    for resource, document in station.resources.items():
        for topic, written in document.topics.items():
            yield str(topic), written.examples
        for flow, made in document.flows.items():
            yield flow_name(resource, flow), made.examples


def _of_ros_1(station: Station) -> frozenset[str]:
    topics = [topic for resource in station.resources.values() for topic in resource.topics.items()]
    return frozenset(name for name, document in topics if document.ros == 1)


def _require_possible_beginning(automaton: Automaton) -> None:
    """Raises `ModelError` where a specification forbids the initial state: there is no supervisor then."""
    state = initial_state(automaton)
    findings = []
    for name, specification in automaton.specifications.items():
        if evaluate(specification.forbidden, state) is True:
            values = described(state, dict.fromkeys(variables(specification.forbidden)))
            said = message("wrong.forbids-initial", specification=name, values=values)
            findings.append(Finding(automaton.places[name], said))
    if findings:
        raise ModelError(findings)


def _require_plannable(automaton: Automaton) -> None:
    """Raises `ModelError` for formulas whose automata are too large to be followed."""
    findings: list[Finding] = []
    for operation in automaton.operations.values():
        try:
            monitor_of(operation.local or TRUE)
        except TooManyStatesError as error:
            findings.append(Finding(automaton.places[f"{OPERATION}.{operation.name}.local"], str(error)))
    if findings:
        raise ModelError(findings)
