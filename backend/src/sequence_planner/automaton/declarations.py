"""The declarations of a station: its enumerations, variables, flags and operations, each under one name."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import NamedTuple

from sequence_planner.automaton.automaton import Ability, Effect, Kind, OperationGroup, VariableDeclaration
from sequence_planner.automaton.findings import Binding, Findings, instance_name, without_arguments
from sequence_planner.automaton.lifting.titles import TitleReader
from sequence_planner.automaton.shorthand import (
    ShorthandReader,
    own_values,
    parts_of,
    read_enumerations,
    written_predicates,
)
from sequence_planner.language.lexer import MOST_DIGITS
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.shorthand.vocabulary import Vocabulary
from sequence_planner.language.types import (
    BOOLEAN,
    EnumerationType,
    IntegerRange,
    Place,
    Type,
    Value,
    contains,
)
from sequence_planner.model import fields
from sequence_planner.model.documents import (
    AbilityDocument,
    EffectDocument,
    EnumerationDocument,
    Parameters,
    VariableDocument,
)
from sequence_planner.model.fields import SHORT, Predicate, fault_of_name
from sequence_planner.model.loader import Station
from sequence_planner.model.paths import parse_path
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.texts.message import message

FLAGS = fields.FLAGS
OPERATION = fields.OPERATION
MOST_VALUES = 1000  # of a range; every value costs memory in plans and supervisors

_RANGE = re.compile(r"(-?[0-9]{1,18})\s*\.\.\s*(-?[0-9]{1,18})")
_KINDS = (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED)


class Declarations:
    """The names of a station. `types` has the type of everything an expression can read.

    `broken` are names that are declared, but of no usable type, and `unusable` those of enumerations, sets, relations,
    maps and predicates that mean nothing: their uses are not wrong as well. `removed` are those that instances do not
    have of their types, each with the entry that says so.
    """

    def __init__(self, station: Station, findings: Findings) -> None:
        self._station = station
        self._findings = findings
        self.enumerations: dict[str, EnumerationType] = {}
        self.variables: dict[str, VariableDeclaration] = {}
        self.types: dict[str, Type] = {}
        self.places: dict[str, Place] = {}
        self.groups: list[OperationGroup] = []
        self.broken: set[str] = set()
        self.unusable: set[str] = set()
        self.removed = dict(_removed(station))
        self._check_resources()
        self._read_enumerations()
        self._read_variables()
        self._check_values()
        self._declare_flags()
        self._declare_activities()
        self.vocabulary = self._read_vocabulary()
        self.titles = TitleReader(station, self.enumerations, self.types, findings).read_titles()

    def noting(self, findings: Findings, types: dict[str, Type] | None = None) -> Declarations:
        """The same names, and what is found by them from now on is noted in `findings`; `types` replaces theirs."""
        other = copy.copy(self)
        other._findings = findings
        if types is not None:
            other.types = types
        return other

    def all(self) -> tuple[object, ...]:
        """All that a text can mean something by, in order: where two of these are equal, each text means the same."""
        return (
            list(self.types.items()),
            list(self.variables.items()),
            list(self.enumerations.items()),
            frozenset(self.broken | self.unusable),
            self.vocabulary.declared(),
            self.titles,
            self.removed,
        )

    def written_abilities(self) -> Iterator[tuple[str, SourceText, AbilityDocument]]:
        """Each ability as it is written: its resource, its name and its document."""
        for resource, document in self._station.resources.items():
            for name, ability in document.abilities.items():
                yield resource, name, ability

    def abilities(self) -> Iterator[tuple[str, SourceText, AbilityDocument, Binding]]:
        """Each ground ability: its resource, its name as written, its document, and the values of its parameters."""
        for resource, name, ability in self.written_abilities():
            for binding in self.bindings(ability.parameters):
                yield resource, name, ability, binding

    def written_predicates(self) -> Iterator[tuple[str, tuple[str, ...], Parameters, Predicate]]:
        """Each predicate: its full name, what is tried before bare names there, its parameters and its condition."""
        resources = {name: document.predicates for name, document in self._station.resources.items()}
        for resource, name, document in written_predicates(self._station.station.predicates, resources):
            full, prefixes = (str(name), ()) if resource is None else (f"{resource}.{name}", (f"{resource}.",))
            yield full, prefixes, *parts_of(document)

    def indices(self) -> dict[str, dict[str, str]]:
        """The parameters of what is written once for several, by its full name; see `Automaton`."""
        station, found = self._station, dict[str, Parameters]()
        for kind, documents in ((OPERATION, station.operations), ("specification", station.specifications)):
            found |= {f"{kind}.{name}": each.parameters for name, each in documents.items()}
        found |= {str(name): variable.each for name, variable in station.station.estimated.items()}
        for resource, document in station.resources.items():
            for kind in _KINDS:
                found |= {f"{resource}.{name}": each.each for name, each in getattr(document, kind.value).items()}
            for name, ability in document.abilities.items():
                found[f"{resource}.{name}"] = ability.parameters
                found |= {f"{resource}.{name}.{each}": effect.each for each, effect in ability.effects.items()}
        return {name: {str(word): str(of) for word, of in each.items()} for name, each in found.items() if each}

    def bindings(self, parameters: Parameters) -> list[Binding]:
        """Every choice of values for `parameters`; one empty choice when there are none, none for an unknown type."""
        if any(enumeration not in self.enumerations for enumeration in parameters.values()):
            return []
        types = [self.enumerations[enumeration] for enumeration in parameters.values()]
        return [
            {str(name): (value, type_) for name, value, type_ in zip(parameters, values, types, strict=True)}
            for values in product(*(type_.values for type_ in types))
        ]

    def domain_in(self, name: SourceText, resource: str | None) -> SourceText:
        """The name of an enumeration or a set in full: within a resource its sets have short ones."""
        full = f"{resource}.{name}"
        return SourceText(full, name.place, name.raw) if full in self.enumerations else name

    def check_name(self, name: SourceText, kind: str) -> bool:
        """Return whether a part of this kind can have a name; what is wrong with it is noted."""
        if (fault := fault_of_name(name, kind)) is not None:
            self._findings.add(name, fault)
        return fault is None

    def check_parameters(self, parameters: Mapping[SourceText, SourceText], *prefixes: str) -> None:
        """Note parameters that are none, and those that would hide something: a variable of the station or under
        `prefixes`, a flag, or a value of an enumeration.
        """
        values = {value: each for each, type_ in self.enumerations.items() for value in type_.values}
        for name, enumeration in parameters.items():
            self.check_name(name, "parameter")
            if name in values:
                hidden = str(values[name])
                self._findings.add(name, message("wrong.hides-value", name=str(name), enumeration=hidden))
            for hidden in (f"{prefix}{name}" for prefix in (*prefixes, "")):
                if hidden in self.types or hidden in self.broken:
                    self._findings.add(name, message("wrong.hides-variable", name=str(name), variable=hidden))
            if enumeration not in self.enumerations and enumeration not in self.unusable:
                near = suggestion(enumeration, self.enumerations)
                said = message("wrong.unknown-enumeration", name=str(enumeration), hint=near)
                self._findings.add(enumeration, said)

    def _check_resources(self) -> None:
        for name in self._station.resources:
            file = str(self._station.folder / "resources" / f"{name}.yaml")
            self.check_name(SourceText(name, Place(file, 1, 1), name), "resource")

    def _declare(self, name: str, key: SourceText) -> bool:
        """Return whether `name` is new; a second declaration is a finding."""
        if name in self.places:
            self._findings.add(key, message("wrong.declared", name=name, place=str(self.places[name])))
            return False
        self.places[name] = key.place
        return True

    def _read_enumerations(self) -> None:
        for name, document in self._station.station.enumerations.items():
            self.check_name(name, "enumeration")
            values = own_values(document)
            for index, value in enumerate(values):
                self.check_name(value, "value")
                if value in values[:index]:
                    self._findings.add(value, message("wrong.duplicate-value", value=str(value), name=str(name)))
        self.enumerations |= read_enumerations(self._station, self._findings, self.unusable)
        for name, type_ in ShorthandReader(self, self._station, self._findings).read_sets():
            own = name.rpartition(".")[2]
            self.check_name(SourceText(own, name.place, name.raw), "set")
            if own in self._station.station.enumerations:
                self._findings.add(name, message("wrong.set-is-enumeration", name=own))
                self.unusable |= {str(name)} - {own}
            else:
                self.enumerations[str(name)] = type_

    def _read_vocabulary(self) -> Vocabulary:
        """The names that stand for something longer."""
        reader = ShorthandReader(self, self._station, self._findings)
        station = self._station.station
        for full, name in self._short_names():
            self._declare_short(full, name)
        ordered = [
            self.enumerations[str(name)]
            for name, document in station.enumerations.items()
            if isinstance(document, EnumerationDocument) and document.ordered and str(name) in self.enumerations
        ]
        relations, maps = dict(reader.read_relations()), dict(reader.read_maps())
        resources = {name: document.predicates for name, document in self._station.resources.items()}
        predicates = reader.read_predicates(resources)
        self.unusable |= {full for full, _ in self._short_names()} - {*relations, *maps, *predicates}
        return Vocabulary(self.enumerations, tuple(ordered), relations, maps, predicates, frozenset(self.unusable))

    def _short_names(self) -> Iterator[tuple[str, SourceText]]:
        """All relations, maps and predicates: the full name of each, and that as it is written."""
        station = self._station.station
        for name in (*station.relations, *station.maps, *station.predicates):
            yield str(name), name
        for resource, document in self._station.resources.items():
            for name in (*document.relations, *document.maps, *document.predicates):
                yield f"{resource}.{name}", name

    def _declare_short(self, full: str, name: SourceText) -> None:
        if self.check_name(name, SHORT[0]):
            self._declare(full, name)

    def _read_variables(self) -> None:
        for name, document in self._station.station.estimated.items():
            self._read_variable(None, name, document, Kind.ESTIMATED)
        for resource, resource_document in self._station.resources.items():
            for kind in _KINDS:
                for name, document in getattr(resource_document, kind.value).items():
                    self._read_variable(resource, name, document, kind)

    def _check_values(self) -> None:
        """Note values of enumerations that a variable of the same name hides where both can be meant: among the texts
        of a resource that has something of the enumeration, and everywhere if the variable is the station's.
        """
        for enumeration, values in self._station.station.enumeration_values().items():
            for value in values:
                for resource in (None, *self._resources_with(str(enumeration))):
                    variable = value if resource is None else f"{resource}.{value}"
                    if variable in self.places:
                        names = {"value": str(value), "enumeration": str(enumeration), "variable": variable}
                        self._findings.add(value, message("wrong.hidden-value", **names))

    def _resources_with(self, enumeration: str) -> list[str]:
        """The resources with a variable of the type, or an ability with a parameter of it."""
        return [
            name
            for name, document in self._station.resources.items()
            if any(each.type == enumeration for kind in _KINDS for each in getattr(document, kind.value).values())
            or any(enumeration in each.parameters.values() for each in document.abilities.values())
        ]

    def _read_variable(self, resource: str | None, name: SourceText, document: VariableDocument, kind: Kind) -> None:
        self.check_name(name, "variable")
        full = name if resource is None else f"{resource}.{name}"
        type_ = self.type_of(name, document.type, kind)
        self.check_parameters(document.each)
        if not self._declare(full, name):
            return
        bindings = self.bindings(document.each)
        if type_ is None or not bindings:
            self.broken.add(full)
            return
        initial = self.initial_of(name, full, document.initial, type_)
        dual = document.approval == "dual"
        for binding in bindings:
            ground_name = instance_name(full, binding, indexed=True)
            self.variables[ground_name] = VariableDeclaration(ground_name, type_, kind, initial, resource, dual)
            self.types[ground_name] = type_
            self.places[ground_name] = name.place

    def type_of(self, name: SourceText, text: SourceText | None, kind: Kind | None) -> Type | None:
        """The type of the variable `name` that `text` means; if it means none, that is noted."""
        if text is None:
            id_ = "wrong.needs-type" if kind is Kind.ESTIMATED else "wrong.needs-type-or-field"
            self._findings.add(name, message(id_, name=str(name)))
            return None
        if text == "bool":
            return BOOLEAN
        if match := _RANGE.fullmatch(text):
            return self._range(text, int(match[1]), int(match[2]))
        if text in self.unusable:
            return None
        if text not in self.enumerations:
            near = suggestion(text, ["bool", *self.enumerations])
            self._findings.add(text, message("wrong.unknown-type", name=str(text), hint=near))
            return None
        return self.enumerations[text]

    def initial_of(self, name: SourceText, full: str, written: Value | None, type_: Type) -> Value:
        """The initial value of the variable `full`; if the `written` one is none of its type, that is noted."""
        initial: Value = written if written is not None else type_.domain[0]
        if isinstance(initial, SourceText):
            initial = str(initial)
        if not contains(type_, initial):
            where = written if isinstance(written, SourceText) else name
            near = suggestion(str(initial), map(str, type_.domain))
            said = message("wrong.no-initial", value=str(initial), name=str(full), range=str(type_), hint=near)
            self._findings.add(where, said)
        return initial

    def _range(self, text: SourceText, low: int, high: int) -> IntegerRange | None:
        if low > high:
            self._findings.add(text, message("wrong.empty-range", range=str(text)))
        elif high - low >= MOST_VALUES:
            self._findings.add(text, message("wrong.large-range", range=str(text), most=MOST_VALUES))
        elif max(-low, high) >= 10**MOST_DIGITS:
            self._findings.add(text, message("wrong.integer-digits", most=MOST_DIGITS))
        else:
            return IntegerRange(low, high)
        return None

    def _declare_flags(self) -> None:
        for resource, document in self._station.resources.items():
            for name, ability in document.abilities.items():
                self.check_name(name, "ability")
                self.check_parameters(ability.parameters, f"{resource}.")
                for effect in ability.effects.values():
                    self._check_effect(resource, ability, effect)
                if self._declare(f"{resource}.{name}", name) and not self.bindings(ability.parameters):
                    self.broken.add(f"{resource}.{name}")
        for resource, name, _, binding in self.abilities():
            full = instance_name(f"{resource}.{name}", binding)
            self.types |= {f"{full}.{flag}": BOOLEAN for flag in FLAGS}

    def _check_effect(self, resource: str, ability: AbilityDocument, effect: EffectDocument) -> None:
        """Note what is wrong with the words for which an effect is written once."""
        self.check_parameters(effect.each, f"{resource}.")
        for word in effect.each:
            if word in ability.parameters:
                self._findings.add(word, message("wrong.parameter-taken", word=str(word)))

    def _declare_activities(self) -> None:
        for name, document in self._station.operations.items():
            self.check_name(name, OPERATION)
            self.check_parameters(document.parameters)
            bindings = self.bindings(document.parameters)
            if not bindings:
                self.broken.add(f"{OPERATION}.{name}")
            for binding in bindings:
                self.types[f"{OPERATION}.{instance_name(name, binding)}.active"] = BOOLEAN


# What abilities meant when they were ground before, for as long as the names in them mean the same.

_NAMED_SECTIONS = (*(kind.value for kind in _KINDS), "abilities", "predicates", "relations", "maps", "sets")


def _removed(station: Station) -> Iterator[tuple[str, Place]]:
    """The full names that instances do not have of their types, each with where it is removed."""
    for resource, layers in station.layers.items():
        document, kind = station.resources.get(resource), layers[0].written.head.type
        if document is None or kind is None:
            continue
        for layer in layers[:-1]:
            for text in layer.written.head.remove:
                section, *rest = parse_path(text)
                is_name = section in _NAMED_SECTIONS and len(rest) == 1
                if is_name and rest[0] not in getattr(document, str(section)):
                    own = "" if layer is layers[0] else f"{resource} ({kind.place})"
                    yield f"{resource}.{rest[0]}", text.place._replace(instance=own)


_WORD = re.compile(r"\w+")


class GroundAbility(NamedTuple):
    """An ability as its document means it, with all that grounding noted of it and of nothing else.

    `effects` are with what makes two of them one, and where each is written.
    """

    ability: Ability
    places: dict[str, Place]
    effects: tuple[tuple[tuple[object, ...], Effect, Place], ...]
    findings: tuple[Finding, ...]
    activities: tuple[str, ...]


class _Names(NamedTuple):
    """What is declared: the types of all that can be read, variables, those that are wrong, and all else."""

    types: Mapping[str, object]
    variables: Mapping[str, object]
    broken: frozenset[str]
    others: object


class GroundBefore:
    """The meaning that the abilities of one station had when they were ground before.

    An ability means the same for as long as its document is the same object and what is declared is the same, but for
    names that are not in it.
    """

    def __init__(self) -> None:
        self._declared: tuple[object, ...] | None = None
        self._names: _Names | None = None
        self._known: dict[tuple[str, str], tuple[SourceText, AbilityDocument, list[GroundAbility]]] = {}
        self._words: dict[tuple[str, str], tuple[AbilityDocument, frozenset[str]]] = {}
        self._used: set[tuple[str, str]] = set()

    def begin(self, declarations: Declarations) -> None:
        """The station is ground with these names now."""
        declared = declarations.all()
        if declared != self._declared:
            words = self._changed_words(declarations)
            self._known = {key: known for key, known in self._known.items() if self._is_unaffected(key, known, words)}
        self._declared = declared
        self._used = set()

    def _changed_words(self, declarations: Declarations) -> set[str] | None:
        """The last words of the names of variables that are others than before; None where more is."""
        before, self._names = self._names, _Names(
            declarations.types,
            dict(declarations.variables),
            frozenset(declarations.broken),
            (dict(declarations.enumerations), declarations.vocabulary.declared(), declarations.titles),
        )  # fmt: skip
        now = self._names
        if before is None or before.others != now.others:
            return None
        changed = before.broken ^ now.broken
        for old, new in ((before.types, now.types), (before.variables, now.variables)):
            changed |= {name for name in old.keys() | new.keys() if old.get(name) != new.get(name)}
        words = {without_arguments(name).rpartition(".")[2] for name in changed}
        return None if words & _words_in(declarations.vocabulary.predicates) else words

    def _is_unaffected(
        self,
        key: tuple[str, str],
        known: tuple[SourceText, AbilityDocument, list[GroundAbility]],
        words: set[str] | None,
    ) -> bool:
        """Return whether nothing is wrong with an ability, which would name others, and none of these words in it."""
        _, document, ground = known
        if words is None or any(each.findings for each in ground):
            return False
        if (found := self._words.get(key)) is None or found[0] is not document:
            found = self._words[key] = document, frozenset(_words_in(document))
        return found[1].isdisjoint(words)

    def end(self) -> None:
        """All abilities were asked for."""
        self._known = {key: known for key, known in self._known.items() if key in self._used}
        self._words = {key: words for key, words in self._words.items() if key in self._used}

    def ground(
        self, resource: str, name: SourceText, document: AbilityDocument, ground: Callable[[], list[GroundAbility]]
    ) -> list[GroundAbility]:
        """The ability for all choices of its parameters, made by `ground` unless it is known."""
        key = resource, str(name)
        self._used.add(key)
        known = self._known.get(key)
        if known is None or known[0] is not name or known[1] is not document:
            known = self._known[key] = name, document, ground()
        return known[2]


def _words_in(written: object) -> set[str]:
    """All words in texts of a document, or of what was made of one."""
    return set(_WORD.findall(repr(written)))
