"""Pipelines from documents: fields mapped by name and type, stages checked against the message and the variables."""

from __future__ import annotations

import re
from collections.abc import Iterable

from sequence_planner.automaton.structure import Automaton, Kind, VariableDeclaration
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import BooleanType, EnumerationType, IntegerRange, Type
from sequence_planner.model.documents import Coordinates as CoordinatesDocument
from sequence_planner.model.documents import StageDocument, TopicDocument
from sequence_planner.model.loading import Station
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.pipelines.pipeline import IncomingPipeline, OutgoingPipeline, StationPipelines, Topic
from sequence_planner.pipelines.stages import (
    ConstantStage,
    Coordinates,
    DiscretiseStage,
    FieldStage,
    RememberStage,
    UndiscretiseStage,
)
from sequence_planner.ros.errors import MessageDefinitionError, MessageValueError
from sequence_planner.ros.fields import FieldType
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.names import check_topic
from sequence_planner.ros.transport import QualityOfService


def load_messages(station: Station) -> MessageRegistry:
    """The message types of a station. Raises `ModelError` with the place of a definition that cannot be used."""
    try:
        return MessageRegistry.from_folder(station.messages if station.messages.is_dir() else None)
    except MessageDefinitionError as error:
        raise ModelError([Finding(Place(str(error.path), error.line, 1), error.text)]) from error


def build_pipelines(station: Station, automaton: Automaton, registry: MessageRegistry) -> StationPipelines:
    """The pipelines of all topics, whose message types `registry` knows. Raises `ModelError` with all findings."""
    building = _Building(automaton, registry)
    for resource, document in station.resources.items():
        for name, topic in document.topics.items():
            building.add(resource, name, topic)
    if building.findings:
        raise ModelError(building.findings)
    return StationPipelines(building.incoming, building.outgoing)


class _Building:
    def __init__(self, automaton: Automaton, registry: MessageRegistry) -> None:
        self.automaton = automaton
        self._registry = registry
        self.findings: list[Finding] = []
        self.incoming: dict[str, IncomingPipeline] = {}
        self.outgoing: dict[str, OutgoingPipeline] = {}
        self._fed: dict[str, SourceText] = {}

    def add(self, resource: str, name: SourceText, document: TopicDocument) -> None:
        """Add the pipeline of one topic."""
        try:
            check_topic(name)
        except ValueError as error:
            self.found(name, str(error).replace("'", "`"))
            return
        if name in self.incoming or name in self.outgoing:
            self.found(name, f"duplicate name `{name}`: a topic belongs to one resource")
            return
        incoming = document.direction == "in"
        stages = _TopicStages(
            self, resource, self._registry.fields(document.type), Kind.MEASURED if incoming else Kind.OUTPUT
        )
        before = len(self.findings)
        for stage in document.pipeline:
            stages.add(stage, incoming)
        stages.ignore(document.ignore)
        stages.map_remaining_fields(name)
        is_sound = len(self.findings) == before  # else what follows from that would be reported as well
        if is_sound:
            stages.check_remembered()
        topic = Topic(str(name), str(document.type), resource, QualityOfService(document.quality))
        if incoming:
            pipeline = IncomingPipeline(
                topic, document.deadline, tuple(stages.fields), tuple(stages.discretised), tuple(stages.remembered)
            )
            self._check_feeds(name, pipeline, is_sound)
            self.incoming[topic.name] = pipeline
        else:
            self.outgoing[topic.name] = OutgoingPipeline(
                topic, document.every, tuple(stages.fields), tuple(stages.undiscretised), tuple(stages.constants)
            )
            if is_sound:
                self._check_writable(name, document)

    def _check_feeds(self, name: SourceText, pipeline: IncomingPipeline, is_sound: bool) -> None:
        if is_sound and not pipeline.variables:
            self.found(name, f"`{name}` feeds no variable: no field bears the name of a measured variable")
        for variable in pipeline.variables:
            if variable in self._fed:
                self.found(name, f"`{variable}` is fed by `{self._fed[variable]}` already")
            self._fed[variable] = name

    def _check_writable(self, name: SourceText, document: TopicDocument) -> None:
        """Encode the initial outputs once: a constant that does not fit is found here and not on a running station."""
        pipeline = self.outgoing[str(name)]
        try:
            self._registry.encode(pipeline.topic.type_name, pipeline.write(self.automaton.initial_valuation))
        except MessageValueError as error:
            field = re.split(r"[.\[]", error.path)[0]
            constants = [key for stage in document.pipeline for key in stage.constant or ()]
            where = next((key for key in constants if key == field), document.type)
            self.found(where, f"the message cannot be written: {error}")

    def found(self, where: SourceText, message: str) -> None:
        """Note what is wrong at `where`."""
        self.findings.append(Finding(where.place, message))

    def variable(self, resource: str, name: SourceText, kind: Kind) -> VariableDeclaration | None:
        """The variable of a stage, or a finding."""
        variable = self.automaton.variables.get(f"{resource}.{name}")
        if variable is None or variable.kind is not kind:
            own = [v.name.removeprefix(f"{resource}.") for v in self.of(resource, kind)]
            self.found(name, f"`{resource}` has no {kind} variable `{name}`{suggestion(name, own)}")
            return None
        return variable

    def field(self, fields: dict[str, FieldType], name: SourceText) -> FieldType | None:
        """The field of a stage, or a finding."""
        if name not in fields:
            self.found(name, f"the message has no field `{name}`{suggestion(name, fields)}")
        return fields.get(name)

    def of(self, resource: str, kind: Kind) -> Iterable[VariableDeclaration]:
        """The variables of a resource and kind."""
        return [v for v in self.automaton.variables.values() if v.resource == resource and v.kind is kind]


class _TopicStages:
    """The stages of one topic, collected by kind."""

    def __init__(self, building: _Building, resource: str, fields: dict[str, FieldType], kind: Kind) -> None:
        self._building = building
        self._resource = resource
        self._message = fields
        self._kind = kind
        self._used: set[str] = set()
        self._fed: set[str] = set()
        self._remembering: list[tuple[SourceText, RememberStage]] = []
        self.fields: list[FieldStage] = []
        self.discretised: list[DiscretiseStage] = []
        self.remembered: list[RememberStage] = []
        self.undiscretised: list[UndiscretiseStage] = []
        self.constants: list[ConstantStage] = []

    def add(self, stage: StageDocument, incoming: bool) -> None:
        """Add one stage as written."""
        building, resource = self._building, self._resource
        if (discretise := stage.discretise) is not None:
            if not incoming:
                building.found(discretise.field, "`discretise` is for incoming topics; use `undiscretise` here")
                return
            variable = building.variable(resource, discretise.variable, Kind.MEASURED)
            names = [*discretise.values, discretise.otherwise]
            self._fed.add(f"{resource}.{discretise.variable}")
            if variable and self._coordinates_fit(discretise.field, discretise.values, names, variable.type):
                points = _coordinates(discretise.values)
                otherwise, tolerance = str(discretise.otherwise), discretise.tolerance
                self.discretised.append(
                    DiscretiseStage(str(discretise.field), variable.name, points, tolerance, otherwise)
                )
        elif (undiscretise := stage.undiscretise) is not None:
            if incoming:
                building.found(undiscretise.field, "`undiscretise` is for outgoing topics; use `discretise` here")
                return
            variable = building.variable(resource, undiscretise.variable, Kind.OUTPUT)
            names = list(undiscretise.values)
            if variable and self._coordinates_fit(undiscretise.field, undiscretise.values, names, variable.type):
                missing = sorted(set(map(str, variable.type.domain)) - set(map(str, names)))
                if missing:
                    building.found(undiscretise.variable, f"no coordinates for {', '.join(missing)}")
                    return
                points = _coordinates(undiscretise.values)
                self.undiscretised.append(UndiscretiseStage(variable.name, str(undiscretise.field), points))
        elif (remember := stage.remember) is not None:
            of = building.variable(resource, remember.of, Kind.MEASURED)
            variable = building.variable(resource, remember.variable, Kind.MEASURED)
            if not incoming:
                building.found(remember.variable, "`remember` is for incoming topics")
            elif of and variable:
                for value in remember.ignored:
                    if value not in of.type.domain:
                        near = suggestion(value, map(str, of.type.domain))
                        building.found(value, f"`{value}` is no value of `{remember.of}`{near}")
                ignored = frozenset(map(str, remember.ignored))
                kept = set(of.type.domain) - ignored
                if not kept <= set(variable.type.domain):
                    extra = ", ".join(sorted(map(str, kept - set(variable.type.domain))))
                    building.found(remember.variable, f"`{remember.variable}` cannot be {extra}: put it into `except`")
                self.remembered.append(RememberStage(variable.name, of.name, ignored))
                self._remembering.append((remember.of, self.remembered[-1]))
        elif stage.constant is not None:
            for name in stage.constant:
                if incoming:
                    building.found(name, "`constant` is for outgoing topics: an incoming message has its own values")
                building.field(self._message, name)
                self._used.add(name)
            self.constants.append(ConstantStage({str(name): _plain(value) for name, value in stage.constant.items()}))
        else:
            for field, name in (stage.rename or {}).items():
                variable = building.variable(self._resource, name, self._kind)
                found = building.field(self._message, field)
                if variable and found:
                    self._map(field, str(field), variable, found)

    def ignore(self, fields: Iterable[SourceText]) -> None:
        """Leave these fields out: they are no variables."""
        for field in fields:
            if field in self._used:
                self._building.found(field, f"`{field}` is used by a stage: it cannot be ignored as well")
            self._building.field(self._message, field)
            self._used.add(field)

    def map_remaining_fields(self, topic: SourceText) -> None:
        """Map each field that no stage uses to the variable of its name, if there is one."""
        for field, type_ in self._message.items():
            variable = self._building.automaton.variables.get(f"{self._resource}.{field}")
            if field not in self._used and variable is not None and variable.kind is self._kind:
                self._map(topic, field, variable, type_)

    def check_remembered(self) -> None:
        """Whether each variable that is remembered has its value from this very topic, by an earlier stage."""
        for of, stage in self._remembering:
            if stage.of not in self._fed:
                self._building.found(of, f"`{of}` has no value yet: only what this topic has said can be remembered")
            self._fed.add(stage.variable)

    def _map(self, where: SourceText, field: str, variable: VariableDeclaration, type_: FieldType) -> None:
        self._used.add(field)
        self._fed.add(variable.name)
        if not _corresponds(type_, variable.type):
            self._building.found(
                where, f"field `{field}` is a {type_}, and `{variable.name}` is {variable.type}: they do not correspond"
            )
            return
        self.fields.append(FieldStage(field, variable.name, variable.type))

    def _coordinates_fit(
        self, name: SourceText, values: CoordinatesDocument, names: list[SourceText], type_: Type
    ) -> bool:
        """Whether points named `names` make sense for the variable, and their coordinates for the field."""
        building = self._building
        field = building.field(self._message, name)
        self._used.add(name)
        before = len(building.findings)
        if not isinstance(type_, EnumerationType):
            building.found(name, f"points have names, so the variable must be an enumeration and not {type_}")
            return False
        for point in names:
            if point not in type_.values:
                building.found(point, f"`{point}` is none of {type_}{suggestion(point, type_.values)}")
        if field is None:
            return False
        if field.kind != "float" or field.array is None:
            building.found(name, f"`{name}` must be an array of numbers")
            return False
        lengths = {len(point) for point in values.values()}
        wanted = {field.array} if isinstance(field.array, int) else lengths
        if len(lengths) != 1 or lengths != wanted:
            building.found(name, f"all points need as many coordinates as `{name}` has: {field}")
        first: dict[tuple[float, ...], SourceText] = {}
        for point, numbers in values.items():
            if (twin := first.setdefault(tuple(numbers), point)) is not point:
                building.found(point, f"`{point}` is at the same coordinates as `{twin}`")
        return len(building.findings) == before


def _coordinates(values: CoordinatesDocument) -> Coordinates:
    return Coordinates({str(name): tuple(point) for name, point in values.items()})


def _plain(value: object) -> object:
    """`value` without the places of its texts."""
    match value:
        case dict():
            return {str(key): _plain(entry) for key, entry in value.items()}
        case list():
            return [_plain(entry) for entry in value]
        case SourceText():
            return str(value)
    return value


def _corresponds(field: FieldType, type_: Type) -> bool:
    if field.array is not None:
        return False
    match type_:
        case BooleanType():
            return field.kind == "bool"
        case EnumerationType():
            return field.kind == "string"
        case IntegerRange(minimum, maximum):
            return field.range is not None and field.range[0] <= minimum and maximum <= field.range[1]
