"""Everything that names mean in one draft of a station."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import PurePosixPath

from sequence_planner.automaton.grounding.declarations import FLAGS, OPERATION, Declarations
from sequence_planner.automaton.grounding.findings import Findings, instance_name
from sequence_planner.automaton.grounding.meaning import Meaning
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.types import BOOLEAN, Type
from sequence_planner.model.documents import ResourceDocument
from sequence_planner.model.loading import Station
from sequence_planner.model.reading import EntryPath
from sequence_planner.model.source import ModelError
from sequence_planner.pipelines.building import load_messages
from sequence_planner.pipelines.inference import variables_inferred
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.workshop.language.field import Field
from sequence_planner.workshop.language.names import Family, Visible, families_of, seen_from
from sequence_planner.workshop.language.resource_fields import field_of_resource, placed
from sequence_planner.workshop.language.station_fields import (
    field_of_operation,
    field_of_specification,
    field_of_station,
    field_of_work_master,
)


class Lexicon:
    """What is declared in a draft, which may be as wrong as drafts are; made when it is first asked for."""

    def __init__(self, station: Station, registry: MessageRegistry | None = None) -> None:
        self._written = station
        self._registry = registry
        self._seen: dict[str | None, tuple[Visible, ...]] = {}

    @classmethod
    def of(cls, station: Station, registry: MessageRegistry | None = None) -> Lexicon:
        """The lexicon of a draft; `registry` has its message types where they are read already."""
        return cls(station, registry)

    @cached_property
    def station(self) -> Station:
        """The draft with the variables that follow from its message types, as far as these are known."""
        registry = messages_of(self._written) if self._registry is None else self._registry
        return variables_inferred(self._written, registry)[0]

    @cached_property
    def declarations(self) -> Declarations:
        """Its names."""
        return Declarations(self.station, Findings())

    @cached_property
    def operations(self) -> tuple[str, ...]:
        """The ground operations."""
        return tuple(
            instance_name(name, binding)
            for name, document in self.station.operations.items()
            for binding in self.declarations.bindings(document.parameters)
        )

    @cached_property
    def families(self) -> tuple[Family, ...]:
        """All that is declared and can be read or written, in order of declaration."""
        return tuple(families_of(self.station, self.declarations))

    @cached_property
    def family(self) -> Mapping[str, Family]:
        """What each full name is one of."""
        return {name: family for family in self.families for name in family.instances(self.declarations.enumerations)}

    def seen_from(self, resource: str | None) -> tuple[Visible, ...]:
        """The same as they are seen from a resource, or from the station as a whole."""
        if resource not in self._seen:
            self._seen[resource] = tuple(seen_from(resource, self.families))
        return self._seen[resource]

    def field(self, file: str, path: EntryPath, parameters: Mapping[str, str] | None = None) -> Field | None:
        """What stands at an entry of a file of the station, or None where no names stand.

        What the entry belongs to may be new; its `parameters` can then be given, as the enumeration of each.
        """
        given = None if parameters is None else {placed(name): placed(each) for name, each in parameters.items()}
        station, meaning = self.station, Meaning(self.declarations, Findings())
        at = PurePosixPath(file)
        match at.parts:
            case ("resources", _) if at.suffix == ".yaml":
                document = station.resources.get(at.stem) or ResourceDocument()
                return field_of_resource(at.stem, document, path, given, meaning)
            case ("station.yaml",):
                return field_of_station(station, path, meaning)
            case ("operations.yaml",):
                return field_of_operation(station, path, given)
            case ("specifications.yaml",):
                return field_of_specification(station, path, given)
            case ("work_masters.yaml",):
                return field_of_work_master(station, path, self.operations)
        return None

    def meaning(self, field: Field, findings: Findings | None = None) -> Meaning:
        """What texts mean at a field; what is wrong with them is noted in `findings`."""
        noted = findings or Findings()
        return Meaning(self.declarations.noting(noted, self._types(field)), noted)

    def within(self, place: Place) -> Place:
        """A place with its file as it is called within the station."""
        return place._replace(file=place.file.removeprefix(f"{self._written.folder}/"))

    def _types(self, field: Field) -> dict[str, Type]:
        """The type of everything that can be read, with what the field's own part adds if it is new."""
        types = self.declarations.types
        own: list[str] = []
        for binding in self.declarations.bindings(field.parameters):
            if field.ability:
                own += (field.prefixes(binding)[0] + flag for flag in FLAGS)
            elif field.operation:
                own.append(f"{OPERATION}.{instance_name(field.operation, binding)}.active")
        new = [name for name in own if name not in types]
        return types | dict.fromkeys(new, BOOLEAN) if new else types


def messages_of(station: Station) -> MessageRegistry:
    """The message types of a draft; the standard ones alone where a definition of its own is wrong."""
    try:
        return load_messages(station)
    except ModelError:
        return MessageRegistry.from_folder(None)
