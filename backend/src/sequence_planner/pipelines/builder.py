"""Builder of a station's pipeline graph from documents: topics, flows, services, actions and overrides."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from sequence_planner.automaton.automaton import Automaton, Kind, State, VariableDeclaration
from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.field_paths import NoFieldError, feeds, fills, find_field
from sequence_planner.language.records.record import FieldType, RecordType
from sequence_planner.language.types import BooleanType, EnumerationType, IntegerRange, Place, Type
from sequence_planner.model.documents import FlowDocument, ResourceDocument, TopicDocument
from sequence_planner.model.loader import Station
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.stages.base import Patient
from sequence_planner.pipelines.chain_runtime import first_message
from sequence_planner.pipelines.chains import (
    ChainBuilding,
    PipelineFindings,
    check_override_names,
    names_of_constants,
    renamed_in,
    used_up,
)
from sequence_planner.pipelines.client_builder import client_of, is_part, parts
from sequence_planner.pipelines.graph import (
    ActionUse,
    Flow,
    GoalState,
    IncomingPipeline,
    Joining,
    OutgoingPipeline,
    ServiceUse,
    Setting,
    StationPipelines,
    Topic,
    VariableField,
)
from sequence_planner.pipelines.message_types import message_fields
from sequence_planner.ros.names import check_topic
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.types.errors import MessageDefinitionError, MessageValueError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.texts.message import Message, message

# Services and actions as the station uses them, from their documents and the pipelines of their parts.


class ClientBuilding:
    """The services and actions of a station; what is wrong with them is in `findings`."""

    def __init__(self, automaton: Automaton, findings: PipelineFindings) -> None:
        self._automaton = automaton
        self._findings = findings
        self.services: dict[str, ServiceUse] = {}
        self.actions: dict[str, ActionUse] = {}

    def add(
        self,
        resource: str,
        document: ResourceDocument,
        incoming: Mapping[str, IncomingPipeline],
        outgoing: Mapping[str, OutgoingPipeline],
    ) -> None:
        """Add those of a resource; the pipelines have all their parts, but for parts with findings."""
        for name, service in document.services.items():
            when = None if service.when is None else self._wanting(resource, service.when)
            request, response = outgoing.get(f"{name} request"), incoming.get(f"{name} response")
            if request is not None and response is not None:
                self.services[str(name)] = ServiceUse(
                    str(name), str(service.type), when, service.every, service.deadline, request, response
                )
        for name, action in document.actions.items():
            when = self._wanting(resource, action.when)
            self._check_status(resource, action.status)
            goal, status = outgoing.get(f"{name} goal"), incoming.get(f"{name} status")
            feedback, result = incoming.get(f"{name} feedback"), incoming.get(f"{name} result")
            if goal is not None and feedback is not None and result is not None and status is not None:
                self.actions[str(name)] = ActionUse(
                    str(name), str(action.type), when, action.deadline, goal, feedback, result, status
                )

    def _wanting(self, resource: str, name: SourceText) -> str:
        """The output that wants something of a device, or a finding."""
        full = f"{resource}.{name}"
        variable = self._automaton.variables.get(full)
        if variable is None:
            own = [v.name.removeprefix(f"{resource}.") for v in self._automaton.variables.values()]
            self._findings.add(
                name.place, message("wrong.no-output", resource=resource, name=str(name), hint=suggestion(name, own))
            )
        elif variable.kind is not Kind.OUTPUT or not isinstance(variable.type, BooleanType):
            said = message("wrong.when-output", name=full, kind=_kind_of(variable), type=str(variable.type))
            self._findings.add(name.place, said)
        return full

    def _check_status(self, resource: str, name: SourceText) -> None:
        """Check whether the variable can say all that may become of a goal."""
        full = f"{resource}.{name}"
        variable = self._automaton.variables.get(full)
        if variable is None or variable.kind is not Kind.MEASURED:
            said = (
                message("wrong.no-status", name=full)
                if variable is None
                else message("wrong.status-measured", name=full, kind=_kind_of(variable))
            )
            self._findings.add(name.place, said)
        elif not isinstance(variable.type, EnumerationType) or set(variable.type.values) != {*map(str, GoalState)}:
            states = f"{{{', '.join(GoalState)}}}"
            said = message("wrong.status-range", name=full, states=states, range=str(variable.type))
            self._findings.add(name.place, said)


# Flows from documents: what their sources are, in which order they stand, and what their records begin with.

_NAME = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True)
class WrittenFlow:
    """A flow as written, with its sources found: by alias, the full name of each."""

    name: str
    resource: str
    written: SourceText
    document: FlowDocument
    joining: Joining
    sources: Mapping[str, str]


def _why_no_name(text: str) -> Message:
    return message("wrong.name.keyword" if text in KEYWORDS else "wrong.name.letters")


def _kind_of(variable: VariableDeclaration) -> Message:
    return message(f"written.is.{variable.kind}")


def flow_name(resource: str, name: str) -> str:
    """The full name of a flow; topics have a slash before theirs."""
    return f"{resource}.{name}"


def found_flows(
    documents: Mapping[str, Mapping[SourceText, FlowDocument]],
    incoming: Iterable[str],
    outgoing: Iterable[str],
    findings: PipelineFindings,
) -> list[WrittenFlow]:
    """The flows of all resources, each behind its sources. Those with findings are left out, and those behind them."""
    names = {flow_name(resource, name) for resource, flows in documents.items() for name in flows}
    topics = set(incoming)
    finding = _Sources(names, topics, set(outgoing), findings)
    flows = {}
    for resource, written in documents.items():
        for name, document in written.items():
            if (flow := finding.flow(resource, name, document)) is not None:
                flows[flow.name] = flow
    return list(_in_order(flows, topics, findings))


@dataclass(frozen=True)
class _Sources:
    flows: set[str]
    topics: set[str]
    outgoing: set[str]
    findings: PipelineFindings

    def flow(self, resource: str, name: SourceText, document: FlowDocument) -> WrittenFlow | None:
        """A flow with its sources, or findings."""
        if not _NAME.fullmatch(name) or name in KEYWORDS:
            self.findings.add(name.place, message("wrong.no-flow-name", name=str(name), why=_why_no_name(name)))
            return None
        match document.source:
            case dict() as aliases:
                joining, written = Joining.MERGE, list(aliases.items())
            case list() as names:
                joining, written = Joining.INTERLEAVE, [(each, each) for each in names]
            case single:
                joining, written = Joining.BRANCH, [(single, single)]
        sources: dict[str, str] = {}
        is_sound = True
        for alias, source in written:
            if joining is Joining.MERGE and (not _NAME.fullmatch(alias) or alias in KEYWORDS):
                self.findings.add(
                    alias.place, message("wrong.no-source-name", name=str(alias), why=_why_no_name(alias))
                )
                is_sound = False
            full = self._full(resource, source)
            if full is None:
                is_sound = False
            elif full in sources.values() and joining is not Joining.MERGE:
                self.findings.add(source.place, message("wrong.source-already", name=str(source)))
                is_sound = False
            else:
                sources[str(alias) if joining is Joining.MERGE else full] = full
        return WrittenFlow(flow_name(resource, name), resource, name, document, joining, sources) if is_sound else None

    def _full(self, resource: str, source: SourceText) -> str | None:
        if source in self.topics:
            return str(source)
        for full in (flow_name(resource, source), str(source)):
            if full in self.flows:
                return full
        if source in self.outgoing:
            said = message("wrong.outgoing-source", name=str(source))
        else:
            own = [each.removeprefix(f"{resource}.") for each in self.flows]
            said = message("wrong.no-source", name=str(source), hint=suggestion(source, [*self.topics, *own]))
        self.findings.add(source.place, said)
        return None


def _in_order(flows: Mapping[str, WrittenFlow], topics: set[str], findings: PipelineFindings) -> Iterator[WrittenFlow]:
    placed = set(topics)
    waiting = dict(flows)
    while ready := [flow for flow in waiting.values() if placed.issuperset(flow.sources.values())]:
        for flow in ready:
            yield flow
            placed.add(flow.name)
            del waiting[flow.name]
    said: set[str] = set()
    for flow in waiting.values():
        if flow.name not in said and (cycle := _cycle(flow.name, waiting)):
            said.update(cycle)
            findings.add(flow.written.place, message("wrong.flow-from-itself", name=flow.name, names=" → ".join(cycle)))


def _cycle(name: str, flows: Mapping[str, WrittenFlow]) -> list[str] | None:
    """The way from a flow along what reads it back to itself, each behind its source."""
    ways = [[name]]
    seen = {name}
    while ways:
        way = ways.pop(0)
        for each in flows.values():
            if way[-1] in each.sources.values():
                if each.name == name:
                    return [*way, name]
                if each.name not in seen:
                    seen.add(each.name)
                    ways.append([*way, each.name])
    return None


def joined_fields(joining: Joining, ends: Mapping[str, RecordType]) -> dict[str, FieldType]:
    """The fields with which the records of a flow begin; `ends` has those of its sources by alias."""
    if joining is Joining.MERGE:
        return {f"{alias}.{name}": type_ for alias, fields in ends.items() for name, type_ in fields.items()}
    first, *others = ends.values()
    return {name: type_ for name, type_ in first.items() if all(each.get(name) == type_ for each in others)}


# The graph from documents: topics and flows with their chains, what they write, and all that is wrong with it.

# What a message declares beside its fields: constants by name.
Constants = Mapping[str, object]


class Resource:
    """A resource's variables, by their names without it."""

    def __init__(self, name: str, automaton: Automaton) -> None:
        self.name = name
        own = {v.name: v for v in automaton.variables.values() if v.resource == name}
        self.all: dict[str, Type] = {self.short(each): v.type for each, v in own.items()}
        self.measured: dict[str, Type] = {self.short(n): v.type for n, v in own.items() if v.kind is Kind.MEASURED}

    def short(self, variable: str) -> str:
        """The variable's name without the resource."""
        return variable.removeprefix(f"{self.name}.")

    def full(self, name: str) -> str:
        """The variable's full name."""
        return f"{self.name}.{name}"


def incoming_pipeline(
    resource: Resource, topic: Topic, document: TopicDocument, building: ChainBuilding, constants: Constants
) -> IncomingPipeline:
    """The pipeline of an incoming topic, with findings in `building`. What it gives may also be read by flows."""
    ignored = frozenset(map(str, document.ignore))
    building.add(document.pipeline)
    _check_ignored(document, building, building.fields[0])
    for name, variable in resource.measured.items():
        field = building.chain.end.get(name)
        numbers = names_of_constants(constants, variable)
        if building.is_sound and isinstance(field, IntegerRange) and numbers is not None and name not in ignored:
            building.map_constants(name, name, numbers, building.name.place)
    renamed = renamed_in(document.pipeline)
    names = set(building.chain.end) - ((ignored | renamed) - set(building.given))
    return IncomingPipeline(topic, document.deadline, building.chain, writings(resource, building, names))


def writings(resource: Resource, building: ChainBuilding, names: Iterable[str]) -> tuple[VariableField, ...]:
    """The fields at the end of a chain that are measured variables, by name and type; findings where only by name."""
    made = []
    among = set(names)
    for name, type_ in resource.measured.items():
        if name not in among or not building.is_sound:
            continue
        field = building.chain.end[name]
        if feeds(field, type_):
            made.append(VariableField(name, resource.full(name), type_, building.between.get(name)))
        else:
            types = {"type": str(field), "other": f"`{resource.full(name)}`", "other_type": str(type_)}
            said = message("wrong.no-correspondence", field=name, **types)
            building.findings.add(building.place_of(name), building.at_origin(name, said))
    return tuple(made)


def outgoing_pipeline(
    resource: Resource, topic: Topic, document: TopicDocument, building: ChainBuilding, constants: Constants
) -> OutgoingPipeline:
    """The pipeline of an outgoing topic, with findings in `building`."""
    record = building.wanted
    building.add(document.pipeline)
    _check_ignored(document, building, record)
    ignored = frozenset(map(str, document.ignore))
    if building.is_sound:
        for name, type_ in resource.all.items():
            numbers = names_of_constants(constants, type_)
            is_own = building.chain.end.get(name) == type_ and name not in building.given
            if isinstance(record.get(name), IntegerRange) and numbers is not None and is_own and name not in ignored:
                building.map_constants(name, name, numbers, building.name.place)
    origins = building.origins(resource.all)
    settings = [
        Setting(name, frozenset(map(resource.full, origins.get(name, ()))))
        for name in building.chain.end
        if building.is_sound and name not in ignored and _is_set(resource, building, name)
    ]
    deciding = [
        origins.get(key, frozenset())
        for index, stage in enumerate(building.stages)
        if stage.kind == "filter"
        for key in building.keys_read(index)
    ]
    depends = frozenset().union(*(each.depends for each in settings), *(map(resource.full, each) for each in deciding))
    read = {name: resource.full(name) for name in resource.all}
    return OutgoingPipeline(topic, document.every, building.chain, tuple(settings), read, depends)


def _is_set(resource: Resource, building: ChainBuilding, name: str) -> bool:
    """Check whether a field at the end is one of the message, of a type that it can hold; else a finding."""
    try:
        path, wanted = find_field(building.wanted, name)
    except NoFieldError:
        return False
    if any(isinstance(step, int) for step in path.steps):
        said = message("wrong.item-given", name=name, list=path.key)
        building.findings.add(building.place_of(name), building.at_origin(name, said))
        return False
    field = building.chain.end[name]
    if fills(field, wanted):
        return True
    is_variable = name in resource.all and name not in building.given
    named = f"`{resource.full(name)}`" if is_variable else message("wrong.what-is-given")
    types = {"type": str(wanted), "other_type": str(field)}
    said = message("wrong.no-correspondence", field=name, other=named, **types)
    building.findings.add(building.place_of(name), building.at_origin(name, said))
    return False


def _check_ignored(document: TopicDocument, building: ChainBuilding, record: RecordType) -> None:
    given = set(building.given)
    used = used_up(document.pipeline)
    for field in document.ignore:
        if field not in record:
            hint = suggestion(field, record)
            building.findings.add(field.place, message("wrong.no-message-field", name=str(field), hint=hint))
        elif field in (used if building.is_incoming else given):
            building.findings.add(field.place, message("wrong.ignored-and-used", name=str(field)))


# Pipelines from documents: the whole graph of a station, checked, with everything that is wrong with it at once.


def load_messages(station: Station) -> MessageRegistry:
    """The message types of a station. Raises `ModelError` with the place of a definition that cannot be used."""
    try:
        return MessageRegistry.from_folder(None, *station.message_folders)
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
        self.findings = PipelineFindings()
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
            id_ = "wrong.two-resources.service" if is_part(name) else "wrong.two-resources.topic"
            self.findings.add(name.place, message(id_, name=called))
            return
        topic = Topic(str(name), str(document.type), resource, _quality(document))
        record = message_fields(self._registry, topic.type_name)
        constants = self._registry.constants(topic.type_name)
        of = self._resources[resource]
        before = len(self.findings.found)
        if document.direction == "in":
            chain = self._begin(topic.name, name, record, of)
            self.incoming[topic.name] = incoming_pipeline(of, topic, document, chain, constants)
            self._feed(topic.name, name, self.incoming[topic.name].variables, frozenset())
            self._note(topic.name, before)
        else:
            chain = self._chain(name, False, record, of.all, of)
            chain.is_cut = topic.name in self._cut
            self.chains[topic.name] = chain
            self.outgoing[topic.name] = outgoing_pipeline(of, topic, document, chain, constants)
            self._check_read(topic.name, message("wrong.no-message-field-at-all"), record)
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
        """Return whether so many flows, which is all, could be made: else nobody knows what is of no use."""
        return len(self.flows) == flows and all(self.chains[name].is_sound for name in self.flows)

    def check_uses(self) -> None:
        """Check whether everything that topics and flows give has a use."""
        for name in (*self.incoming, *self.flows):
            chain = self.chains[name]
            node = self.incoming.get(name) or self.flows[name]
            resource = node.topic.resource if isinstance(node, IncomingPipeline) else node.resource
            before = len(self.findings.found)
            self._check_read(
                name, message("wrong.no-measured", resource=str(resource)), self._resources[resource].measured
            )
            self._note(name, before)
            if (
                chain.is_sound
                and name not in self._unsound
                and not node.variables
                and not self._readers(name)
                and not is_part(name)
            ):
                self.findings.add(chain.name.place, message("wrong.feeds-nothing", pipeline=str(chain.name)))

    def _note(self, name: str, before: int) -> None:
        if len(self.findings.found) > before:
            self._unsound.add(name)

    def _begin(self, full: str, name: SourceText, fields: RecordType, of: Resource) -> ChainBuilding:
        """A chain for what comes in."""
        self.chains[full] = self._chain(name, True, of.measured, fields, of)
        self.chains[full].is_cut = full in self._cut
        return self.chains[full]

    def _chain(
        self, name: SourceText, is_incoming: bool, wanted: RecordType, fields: RecordType, of: Resource
    ) -> ChainBuilding:
        known = (self._automaton.vocabulary, of.name)
        return ChainBuilding(name, is_incoming, wanted, self._folder, self.findings, [fields], *known)

    def _feed(self, full: str, name: SourceText, variables: tuple[str, ...], above: frozenset[str]) -> None:
        self._above[full] = above.union(variables)
        for variable in variables:
            if variable in self._fed:
                fed_by = str(self._fed[variable])
                self.findings.add(name.place, message("wrong.fed-twice", variable=variable, pipeline=fed_by))
            self._fed[variable] = name

    def _check_read(self, name: str, complaint: str, wanted: Iterable[str]) -> None:
        """Check whether all that the stages give is wanted at the end, or read."""
        chain = self.chains[name]
        if chain.is_sound:
            for given, edge in chain.unread(self._read_behind(name)):
                hint = suggestion(given, wanted)
                said = message("wrong.unread", what=complaint, name=given, hint=hint)
                self.findings.add(chain.place_of(given), message("wrong.at", where=edge, what=said))

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
            said = message("wrong.unwritable", why=str(error))
            self.findings.add(where, said if key is None else chain.at_origin(key, said))

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
