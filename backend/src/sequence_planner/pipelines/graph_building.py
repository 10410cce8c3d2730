"""The graph from documents: topics and flows with their chains, what they write, and all that is wrong with it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.automaton.structure import Automaton, Kind
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import IntegerRange, Type
from sequence_planner.model.documents import TopicDocument
from sequence_planner.pipelines.chains import ChainBuilding, names_of_constants, used_up
from sequence_planner.pipelines.graph import IncomingPipeline, OutgoingPipeline, Setting, Topic, Writing
from sequence_planner.pipelines.message_types import feeds, fills
from sequence_planner.pipelines.paths import NoFieldError, find_field
from sequence_planner.pipelines.record import RecordType

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
    renamed = {str(field) for stage in document.pipeline for field in stage.rename or ()}
    names = set(building.chain.end) - ((ignored | renamed) - set(building.given))
    return IncomingPipeline(topic, document.deadline, building.chain, writings(resource, building, names))


def writings(resource: Resource, building: ChainBuilding, names: Iterable[str]) -> tuple[Writing, ...]:
    """The fields at the end of a chain that are measured variables, by name and type; findings where only by name."""
    made = []
    among = set(names)
    for name, type_ in resource.measured.items():
        if name not in among or not building.is_sound:
            continue
        field = building.chain.end[name]
        if feeds(field, type_):
            made.append(Writing(name, resource.full(name), type_, building.between.get(name)))
        else:
            said = f"field `{name}` is {field}, and `{resource.full(name)}` is {type_}: they do not correspond"
            building.findings.add(building.place_of(name), f"{building.origin(name)}{said}")
    return tuple(made)


def outgoing_pipeline(
    resource: Resource, topic: Topic, document: TopicDocument, building: ChainBuilding, constants: Constants
) -> OutgoingPipeline:
    """The pipeline of an outgoing topic, with findings in `building`."""
    message = building.wanted
    building.add(document.pipeline)
    _check_ignored(document, building, message)
    ignored = frozenset(map(str, document.ignore))
    if building.is_sound:
        for name, type_ in resource.all.items():
            numbers = names_of_constants(constants, type_)
            is_own = building.chain.end.get(name) == type_ and name not in building.given
            if isinstance(message.get(name), IntegerRange) and numbers is not None and is_own and name not in ignored:
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
    """Whether a field at the end is one of the message, of a type that it can hold; else a finding."""
    try:
        path, wanted = find_field(building.wanted, name)
    except NoFieldError:
        return False
    if any(isinstance(step, int) for step in path.steps):
        said = f"`{name}` is an item of a list, and lists are sent as a whole: give `{path.key}`"
        building.findings.add(building.place_of(name), f"{building.origin(name)}{said}")
        return False
    field = building.chain.end[name]
    if fills(field, wanted):
        return True
    named = f"`{resource.full(name)}`" if name in resource.all and name not in building.given else "what is given"
    said = f"field `{name}` is {wanted}, and {named} is {field}: they do not correspond"
    building.findings.add(building.place_of(name), f"{building.origin(name)}{said}")
    return False


def _check_ignored(document: TopicDocument, building: ChainBuilding, message: RecordType) -> None:
    given = set(building.given)
    used = {field for stage in document.pipeline for field in used_up(stage)}
    for field in document.ignore:
        if field not in message:
            building.findings.add(field.place, f"the message has no field `{field}`{suggestion(field, message)}")
        elif field in (used if building.is_incoming else given):
            building.findings.add(field.place, f"`{field}` is used by a stage: it cannot be ignored as well")
