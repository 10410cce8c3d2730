"""Scope of a draft: declared names visible at each document field, and their shortest form."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import cached_property
from itertools import islice, product
from pathlib import PurePosixPath

from sequence_planner.automaton.declarations import FLAGS, OPERATION, Declarations
from sequence_planner.automaton.findings import Findings, instance_name, with_arguments
from sequence_planner.automaton.grounding.meaning import Meaning
from sequence_planner.editor.language.document_fields import (
    field_of_operation,
    field_of_resource,
    field_of_specification,
    field_of_station,
)
from sequence_planner.editor.language.families import SHORT, Family, Visible, families_of, seen_from, stub
from sequence_planner.editor.language.field import TextField, placed
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.sequences import field_of_sequence, field_of_work_master
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.names.suggestions import beginning_with
from sequence_planner.language.types import BOOLEAN, EnumerationType, Place, Type
from sequence_planner.model.documents import (
    ResourceDocument,
)
from sequence_planner.model.loader import Station
from sequence_planner.model.source import ModelError, SourceText
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.pipelines.builder import load_messages
from sequence_planner.pipelines.inference import variables_inferred
from sequence_planner.ros.types.messages import MessageRegistry

# Everything that names mean in one draft of a station.


class Lexicon:
    """The declarations of a draft, which may be as wrong as drafts are; made when it is first asked for."""

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
    def sets(self) -> Set[SourceText]:
        """The names of sets, which are among the enumerations as well; of those of resources the full ones."""
        found = dict.fromkeys(self.station.station.sets)
        for resource, document in self.station.resources.items():
            found |= {SourceText(f"{resource}.{name}", name.place, name.raw): None for name in document.sets}
        return found.keys()

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
        """The family that each full name is one of."""
        return {
            name: family
            for family in self.families
            if family.kind not in SHORT
            for name in family.instances(self.declarations.enumerations)
        }

    @cached_property
    def short(self) -> Mapping[str, Family]:
        """Each predicate, relation and map."""
        return {family.name: family for family in self.families if family.kind in SHORT}

    def seen_from(self, resource: str | None) -> tuple[Visible, ...]:
        """The same as they are seen from a resource, or from the station as a whole."""
        if resource not in self._seen:
            self._seen[resource] = tuple(seen_from(resource, self.families))
        return self._seen[resource]

    def field(self, file: str, path: EntryPath, parameters: Mapping[str, str] | None = None) -> TextField | None:
        """Return what stands at an entry of a file of the station, or None where no names stand.

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
                return field_of_station(station, path, meaning, given)
            case ("operations.yaml",):
                return field_of_sequence(station, path, self.operations) or field_of_operation(station, path, given)
            case ("specifications.yaml",):
                return field_of_specification(station, path, given)
            case ("work_masters.yaml",):
                return field_of_work_master(station, path, self.operations, meaning)
        return None

    def meaning(self, field: TextField, findings: Findings | None = None) -> Meaning:
        """Return what texts mean at a field; what is wrong with them is noted in `findings`."""
        noted = findings or Findings()
        return Meaning(self.declarations.noting(noted, self._types(field)), noted)

    def within(self, place: Place) -> Place:
        """A place with its file as it is called within the station."""
        return place._replace(file=place.file.removeprefix(f"{self._written.folder}/"))

    def _types(self, field: TextField) -> dict[str, Type]:
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


# How the names of a draft are written at a field: in their shortest form, with parameters where these can stand.

_MOST_FORMS = 2000  # of one family


class VisibleNames:
    """The names that can be seen from one field, or from within quantifiers in its text that have `bound` words."""

    def __init__(
        self, lexicon: Lexicon, field: TextField, bound: Mapping[str, str | tuple[str, ...]] | None = None
    ) -> None:
        self.lexicon = lexicon
        self._field = field
        self._meaning = lexicon.meaning(field)
        domains = ((word, self._domain(domain)) for word, domain in (bound or {}).items())
        self.bound: Mapping[str, EnumerationType] = {word: type_ for word, type_ in domains if type_ is not None}
        """The words of quantifiers, with what they stand for."""

    @property
    def resource(self) -> str | None:
        """The resource whose names need no prefix."""
        return self._field.resource

    def _domain(self, domain: str | tuple[str, ...]) -> EnumerationType | None:
        if not isinstance(domain, str):
            return EnumerationType(domain)
        return self.enumerations.get(self.lexicon.declarations.domain_in(placed(domain), self.resource))

    @cached_property
    def scope(self) -> NameScope:
        """The meaning of names, for the first choice of the parameters."""
        first = next(self._field.scopes(self._meaning), None) or self._meaning.scope({}, *self._field.prefixes({}))
        return first.binding({word: (type_.values[0], type_) for word, type_ in self.bound.items()})

    @cached_property
    def parameters(self) -> Mapping[str, EnumerationType]:
        """The parameters with what they range over."""
        enumerations = self.enumerations
        written = ((str(name), enumerations.get(each)) for name, each in self._field.parameters.items())
        return {**{name: type_ for name, type_ in written if type_ is not None}, **self.bound}

    @property
    def enumerations(self) -> Mapping[str, EnumerationType]:
        """The enumerations of the draft."""
        return self.lexicon.declarations.enumerations

    def flags(self) -> Iterator[str]:
        """The flags of the field's own ability, by their bare names."""
        if self._field.ability:
            own = self.scope.prefixes[0]
            yield from (name.removeprefix(own) for name in beginning_with(own, self.scope.names))

    def values(self) -> Iterator[tuple[str, str]]:
        """Each value of each enumeration, with the enumeration."""
        for name, type_ in self.enumerations.items():
            for value in type_.values:
                yield value, name

    @property
    def families(self) -> tuple[Visible, ...]:
        """All families that have a name here."""
        return self.lexicon.seen_from(self._field.resource)

    def forms(self, seen: Visible, long: bool = False) -> Iterator[str]:
        """The names of a family as they can be written here: one for each choice of values or parameters."""
        name = seen.family.name if long or not seen.own else seen.family.name.removeprefix(f"{self._field.resource}.")
        for words in islice(self._arguments(seen.family), _MOST_FORMS):
            written = with_arguments(name, words, seen.family.indexed) + seen.family.suffix
            if written not in self.parameters and self._found(name, words, seen.family) == seen.family.instance(
                tuple(map(self._value, words))
            ):
                yield written

    def indices(self, family: Family, index: int) -> Iterator[str]:
        """What has a value and can stand as that argument of a family: a name, or the beginning of one."""
        wanted = self.enumerations[family.arguments[index]].values
        for seen in self.families:
            type_, own = seen.family.type, seen.family
            if isinstance(type_, EnumerationType) and not set(type_.values).isdisjoint(wanted):
                yield stub(seen, not seen.own) if own.arguments else seen.short

    def has_parameter(self, form: str) -> bool:
        """Return whether a parameter is among the arguments of a name."""
        return any(word in self.parameters for word in re.findall(r"\w+", form))

    def _arguments(self, family: Family) -> Iterator[tuple[str, ...]]:
        if not family.arguments:
            return iter([()])
        choices: list[Sequence[str]] = []
        for argument in family.arguments:
            values = self.enumerations[argument].values
            fitting = [name for name, type_ in self.parameters.items() if set(type_.values) <= set(values)]
            choices.append([*fitting, *values])
        return product(*choices)

    def _value(self, word: str) -> str:
        return self.scope.parameters[word][0] if word in self.scope.parameters else word

    def _found(self, name: str, words: tuple[str, ...], family: Family) -> str | None:
        """The full name that a written one has here."""
        text = with_arguments(name, map(self._value, words), family.indexed) + family.suffix
        for prefix in (*self.scope.prefixes, ""):
            if prefix + text in self.scope.variables:
                return prefix + text
        if family.kind is NameKind.PREDICATE:
            named = (prefix + name for prefix in (*self.scope.prefixes, ""))
            found = next((each for each in named if each in self.scope.vocabulary.predicates), None)
            return None if found is None else with_arguments(found, map(self._value, words))
        return text if family.kind in SHORT else None


def abilities(families: Iterable[Visible]) -> Iterator[Visible]:
    """One of the families of each ability."""
    for seen in families:
        if seen.family.kind is NameKind.FLAG and seen.family.suffix == ".executing":
            yield seen
