"""Pipelines from documents: the whole graph of a station, checked, with everything that is wrong with it at once."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.model.documents import TopicDocument
from sequence_planner.model.loading import Station
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.pipelines.chains import ChainBuilding, Findings
from sequence_planner.pipelines.client_building import ClientBuilding
from sequence_planner.pipelines.client_parts import client_of, is_part, parts
from sequence_planner.pipelines.flow_building import WrittenFlow, found_flows, joined_fields
from sequence_planner.pipelines.graph import Flow, IncomingPipeline, Joining, OutgoingPipeline, StationPipelines, Topic
from sequence_planner.pipelines.graph_building import Resource, incoming_pipeline, outgoing_pipeline, writings
from sequence_planner.pipelines.message_types import message_fields
from sequence_planner.pipelines.override_names import check_override_names
from sequence_planner.pipelines.record import RecordType
from sequence_planner.pipelines.running_outgoing import first_message
from sequence_planner.pipelines.stage import Patient
from sequence_planner.ros.errors import MessageDefinitionError, MessageValueError
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.names import check_topic
from sequence_planner.ros.transport import QualityOfService


def load_messages(station: Station) -> MessageRegistry:
    """The message types of a station. Raises `ModelError` with the place of a definition that cannot be used."""
    try:
        return MessageRegistry.from_folder(station.messages if station.messages.is_dir() else None)
    except MessageDefinitionError as error:
        raise ModelError([Finding(Place(str(error.path), error.line, 1), error.text)]) from error


@dataclass(frozen=True)
class Built:
    """The pipelines as far as they are sound, and what is wrong with them. `chains` has all that were begun, by name;
    those with findings are among the `pipelines` too.
    """

    pipelines: StationPipelines
    chains: Mapping[str, ChainBuilding]
    findings: Sequence[Finding]


def build_pipelines(station: Station, automaton: Automaton, registry: MessageRegistry) -> StationPipelines:
    """The pipelines of all topics, whose message types `registry` knows. Raises `ModelError` with all findings."""
    built = build_what_is_sound(station, automaton, registry)
    if built.findings:
        raise ModelError(list(built.findings))
    return built.pipelines


def build_what_is_sound(
    station: Station, automaton: Automaton, registry: MessageRegistry, cut: Collection[str] = ()
) -> Built:
    """The same, for a station that may be wrong: `cut` are topics, parts and flows of which not all stages are read."""
    building = _Building(station, automaton, registry, frozenset(cut))
    for resource, document in station.resources.items():
        for name, topic in document.topics.items():
            building.add(resource, name, topic, name)
        for name, part in parts(document, registry).items():
            building.add(resource, name, part, client_of(name))
    flows = {resource: document.flows for resource, document in station.resources.items()}
    for flow in found_flows(flows, building.incoming, building.outgoing, building.findings):
        building.add_flow(flow)
    if building.has_all(sum(map(len, flows.values()))):
        building.check_uses()
    check_override_names(station.resources.values(), building.findings)
    clients = ClientBuilding(automaton, building.findings)
    for resource, document in station.resources.items():
        clients.add(resource, document, building.incoming, building.outgoing)
    incoming = {name: each for name, each in building.incoming.items() if not is_part(name)}
    outgoing = {name: each for name, each in building.outgoing.items() if not is_part(name)}
    made = StationPipelines(incoming, outgoing, building.flows, clients.services, clients.actions)
    return Built(made, building.chains, building.findings.found)


class _Building:
    def __init__(self, station: Station, automaton: Automaton, registry: MessageRegistry, cut: frozenset[str]) -> None:
        self._cut = cut
        self._folder = station.folder
        self._automaton = automaton
        self._registry = registry
        self._resources = {name: Resource(name, automaton) for name in station.resources}
        self.chains: dict[str, ChainBuilding] = {}
        self._fed: dict[str, SourceText] = {}
        self._above: dict[str, frozenset[str]] = {}  # the variables written by a topic or flow, or before it
        self._unsound: set[str] = set()  # topics and flows with findings: what follows from these is not said as well
        self.findings = Findings()
        self.incoming: dict[str, IncomingPipeline] = {}
        self.outgoing: dict[str, OutgoingPipeline] = {}
        self.flows: dict[str, Flow] = {}

    def add(self, resource: str, name: SourceText, document: TopicDocument, called: str) -> None:
        """Add the pipeline of one topic, or of a part of the service or action that is `called` so."""
        try:
            check_topic(called)
        except ValueError as error:
            self.findings.add(name.place, str(error).replace("'", "`"))
            return
        if name in self.chains:
            what = "a service or an action" if is_part(name) else "a topic"
            self.findings.add(name.place, f"duplicate name `{called}`: {what} belongs to one resource")
            return
        topic = Topic(str(name), str(document.type), resource, _quality(document))
        message = message_fields(self._registry, topic.type_name)
        constants = self._registry.constants(topic.type_name)
        of = self._resources[resource]
        before = len(self.findings.found)
        if document.direction == "in":
            chain = self._begin(topic.name, name, message, of)
            self.incoming[topic.name] = incoming_pipeline(of, topic, document, chain, constants)
            self._feed(topic.name, name, self.incoming[topic.name].variables, frozenset())
            self._note(topic.name, before)
        else:
            chain = ChainBuilding(name, False, message, self._folder, self.findings, [of.all])
            chain.is_cut = topic.name in self._cut
            self.chains[topic.name] = chain
            self.outgoing[topic.name] = outgoing_pipeline(of, topic, document, chain, constants)
            self._check_read(topic.name, "the message has no field", message)
            if len(self.findings.found) == before and chain.is_sound:
                self._check_writable(name, document)

    def add_flow(self, flow: WrittenFlow) -> None:
        """Add a flow, unless one of its sources could not be made."""
        if not all(source in self.chains and self.chains[source].is_sound for source in flow.sources.values()):
            return
        ends = {alias: self.chains[source].chain.end for alias, source in flow.sources.items()}
        of = self._resources[flow.resource]
        before = len(self.findings.found)
        chain = self._begin(flow.name, flow.written, joined_fields(flow.joining, ends), of)
        chain.add(flow.document.pipeline)
        above = frozenset().union(*(self._above[source] for source in flow.sources.values()))
        names = set(chain.chain.end) - set(map(of.short, above)) | set(chain.given)
        made = writings(of, chain, names)
        self.flows[flow.name] = Flow(flow.name, flow.resource, flow.joining, flow.sources, chain.chain, made)
        self._feed(flow.name, flow.written, self.flows[flow.name].variables, above)
        self._note(flow.name, before)

    def has_all(self, flows: int) -> bool:
        """Whether so many flows, which is all, could be made: else nobody knows what is of no use."""
        return len(self.flows) == flows and all(self.chains[name].is_sound for name in self.flows)

    def check_uses(self) -> None:
        """Whether everything that topics and flows give has a use."""
        for name in (*self.incoming, *self.flows):
            chain = self.chains[name]
            node = self.incoming.get(name) or self.flows[name]
            resource = node.topic.resource if isinstance(node, IncomingPipeline) else node.resource
            before = len(self.findings.found)
            self._check_read(name, f"`{resource}` has no measured variable", self._resources[resource].measured)
            self._note(name, before)
            if (
                chain.is_sound
                and name not in self._unsound
                and not node.variables
                and not self._readers(name)
                and not is_part(name)
            ):
                what = "no field bears the name of a measured variable"
                self.findings.add(chain.name.place, f"`{chain.name}` feeds no variable: {what}")

    def _note(self, name: str, before: int) -> None:
        if len(self.findings.found) > before:
            self._unsound.add(name)

    def _begin(self, full: str, name: SourceText, fields: RecordType, of: Resource) -> ChainBuilding:
        """A chain for what comes in."""
        self.chains[full] = ChainBuilding(name, True, of.measured, self._folder, self.findings, [fields])
        self.chains[full].is_cut = full in self._cut
        return self.chains[full]

    def _feed(self, full: str, name: SourceText, variables: tuple[str, ...], above: frozenset[str]) -> None:
        self._above[full] = above.union(variables)
        for variable in variables:
            if variable in self._fed:
                self.findings.add(name.place, f"`{variable}` is fed by `{self._fed[variable]}` already")
            self._fed[variable] = name

    def _check_read(self, name: str, complaint: str, wanted: Iterable[str]) -> None:
        """Whether all that the stages give is wanted at the end, or read."""
        chain = self.chains[name]
        if chain.is_sound:
            for given, edge in chain.unread(self._read_behind(name)):
                said = f"{complaint} `{given}`, and no later stage reads it{suggestion(given, wanted)}"
                self.findings.add(chain.place_of(given), f"{edge}: {said}")

    def _readers(self, name: str) -> list[Flow]:
        return [flow for flow in self.flows.values() if name in flow.sources.values()]

    def _read_behind(self, name: str) -> frozenset[str]:
        """The keys at the end of a topic or flow that flows behind it read or write."""
        found: set[str] = set()
        for flow in self._readers(name):
            chain = self.chains[flow.name]
            read = frozenset().union(*(chain.keys_read(index) for index in range(len(chain.stages))))
            keys = read | self._read_behind(flow.name) | {each.field for each in flow.writings}
            if flow.joining is Joining.MERGE:
                aliases = [f"{alias}." for alias, source in flow.sources.items() if source == name]
                keys = frozenset(key.removeprefix(alias) for key in keys for alias in aliases if key.startswith(alias))
            found |= keys
        return frozenset(found)

    def _check_writable(self, name: SourceText, document: TopicDocument) -> None:
        """Encode what is said of the initial state, and of each other value of a variable on which it depends.

        A value that does not fit is found here, and not on a running station.
        """
        pipeline = self.outgoing[str(name)]
        try:
            for state in self._states(pipeline):
                self._registry.encode(pipeline.topic.type_name, first_message(pipeline, state) or {})
        except MessageValueError as error:
            field = re.split(r"[.\[]", error.path)[0]
            chain = self.chains[str(name)]
            key = next((each for each in (error.path, field) if each in chain.given), None)
            where = document.type.place if key is None else chain.place_of(key)
            origin = "" if key is None else chain.origin(key)
            self.findings.add(where, f"{origin}the message cannot be written: {error}")

    def _states(self, pipeline: OutgoingPipeline) -> Iterator[State]:
        """The initial state and, where no process must be asked, those that differ from it in one variable."""
        initial = self._automaton.initial_valuation
        yield initial
        if not any(isinstance(stage, Patient) for stage in pipeline.chain.stages):
            for name in pipeline.variables:
                for value in self._automaton.variables[name].type.domain:
                    yield {**initial, name: value}


def _quality(document: TopicDocument) -> QualityOfService:
    """As the transports take it."""
    written = document.quality
    return QualityOfService.of(written if isinstance(written, str) else written.model_dump(exclude_none=True))
