"""Families of a draft: the names of one declaration, and how they are seen from a resource."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import NamedTuple

from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.declarations import FLAGS, OPERATION, Declarations
from sequence_planner.automaton.findings import with_arguments, without_arguments
from sequence_planner.automaton.shorthand import parts_of, written_in, written_predicates
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.language.names.scope import ENDS, STEPS
from sequence_planner.language.printer import print_value
from sequence_planner.language.types import BOOLEAN, EnumerationType, Place, Type, Value
from sequence_planner.model.documents import (
    AbilityDocument,
    Parameters,
    PredicateDocument,
    VariableDocument,
)
from sequence_planner.model.fields import Predicate, Words, main_text
from sequence_planner.model.loader import Station
from sequence_planner.model.source import SourceText
from sequence_planner.model.types.expansion import Expansion, GivenArgument

# What is declared in a draft, one entry for each declaration: a variable, a flag or an activity.


@dataclass(frozen=True)
class Family:
    """The names of one declaration: `bolts[…]`, or the flag `robot.move(…).executing`.

    A full name is `name`, its arguments, and `suffix`; `arguments` are the enumerations these are of. `owner` is the
    resource, or None for what belongs to the station, and `indexed` whether brackets are around the arguments.
    """

    name: str
    kind: NameKind
    type: Type
    place: Place
    arguments: tuple[str, ...] = ()
    suffix: str = ""
    indexed: bool = False
    owner: str | None = None
    initial: Value | None = None
    title: str | None = None

    @cached_property
    def skeleton(self) -> str:
        """The full name without arguments."""
        return self.name + self.suffix

    @cached_property
    def step(self) -> str:
        """The resource, or what stands for the operations, with its dot; empty for a variable of the station."""
        head, dot, _ = self.name.partition(".")
        return head + dot if dot else ""

    def instance(self, words: tuple[str, ...]) -> str:
        """The full name with these arguments."""
        return with_arguments(self.name, words, self.indexed) + self.suffix

    def instances(self, enumerations: Mapping[str, EnumerationType]) -> Iterator[str]:
        """All full names."""
        for words in product(*(enumerations[argument].values for argument in self.arguments)):
            yield self.instance(words)


class Visible(NamedTuple):
    """A family as it is seen from a resource: `short` is what its name is there without arguments.

    `own` says whether it belongs to that resource; the lower its `distance`, the likelier is it meant.
    """

    family: Family
    short: str
    own: bool
    distance: int

    @property
    def long(self) -> str:
        """The full name without arguments."""
        return self.family.skeleton


# Whose names come first, where all fit what is typed as well.
_DISTANCES = {NameKind.FLAG: 2, NameKind.ACTIVITY: 4, NameKind.KEYWORD: 3}
# What is no variable, and is written out.
SHORT = (NameKind.PREDICATE, NameKind.RELATION, NameKind.MAP, NameKind.KEYWORD)


def seen_from(resource: str | None, families: Iterable[Family]) -> Iterator[Visible]:
    """All families as they are seen from a resource, or from the station as a whole."""
    for family in families:
        own = resource is not None and family.owner == resource
        short = family.skeleton[len(family.step) :] if own else family.skeleton
        far = 0 if own else 1 if family.owner is None else 4
        yield Visible(family, short, own, far + _DISTANCES.get(family.kind, 0))


def families_of(station: Station, declarations: Declarations) -> Iterator[Family]:
    """Everything declared that has a type."""
    for name, document in station.station.estimated.items():
        yield from _variable(None, name, document, Kind.ESTIMATED, declarations)
    for resource, whole in station.resources.items():
        for kind in (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED):
            for name, document in getattr(whole, kind.value).items():
                yield from _variable(resource, name, document, kind, declarations)
        for name, ability in whole.abilities.items():
            if (arguments := _arguments(ability.parameters, declarations)) is not None:
                yield from _flags(resource, name, ability, arguments)
    for name, operation in station.operations.items():
        if (arguments := _arguments(operation.parameters, declarations)) is not None:
            title = _in_english(operation.title)
            full = f"{OPERATION}.{name}"
            yield Family(full, NameKind.ACTIVITY, BOOLEAN, name.place, arguments, ".active", title=title)
    yield from _short(station, declarations)


def _short(station: Station, declarations: Declarations) -> Iterator[Family]:
    """What is written out: predicates, relations, maps, and the functions of ordered enumerations."""
    vocabulary, written = declarations.vocabulary, station.station
    resources = {name: document.predicates for name, document in station.resources.items()}
    for resource, name, document in written_predicates(written.predicates, resources):
        full = str(name) if resource is None else f"{resource}.{name}"
        if full in vocabulary.predicates:
            arguments = tuple(map(str, parts_of(document)[0].values()))
            title = _in_english(document.title) if isinstance(document, PredicateDocument) else None
            yield Family(full, NameKind.PREDICATE, BOOLEAN, name.place, arguments, owner=resource, title=title)
    relations = {resource: document.relations for resource, document in station.resources.items()}
    for full, name, relation in written_in(written.relations, relations):
        if full in vocabulary.relations:
            arguments = tuple(map(str, relation.between))
            owner = full.rpartition(".")[0] or None
            yield Family(full, NameKind.RELATION, BOOLEAN, name.place, arguments, owner=owner)
    maps = {resource: document.maps for resource, document in station.resources.items()}
    for full, name, table in written_in(written.maps, maps):
        if full in vocabulary.maps:
            target, owner = vocabulary.maps[full].target, full.rpartition(".")[0] or None
            yield Family(full, NameKind.MAP, target, name.place, (str(table.source),), indexed=True, owner=owner)
    for domain, type_ in declarations.enumerations.items():
        if type_ in vocabulary.ordered:
            for step in STEPS:
                yield Family(step, NameKind.KEYWORD, type_, Place("", 1, 1), (domain,))
        if vocabulary.order_of(type_) is not None:
            for end in ENDS:
                yield Family(f"{end}({domain})", NameKind.KEYWORD, type_, Place("", 1, 1))


def predicate_of(station: Station, family: Family) -> tuple[SourceText, Parameters, Predicate]:
    """The name of a predicate as it is written, its parameters, and its condition."""
    owner = station.station if family.owner is None else station.resources[family.owner]
    key = next(each for each in owner.predicates if f"{family.step}{each}" == family.name)
    return key, *parts_of(owner.predicates[key])


def definition_of(station: Station, family: Family, arguments: tuple[str, ...]) -> str:
    """The condition of a predicate as it is written, with arguments in the place of its parameters."""
    key, parameters, condition = predicate_of(station, family)
    if not isinstance(condition, SourceText):
        return print_value(condition)
    given = {
        str(parameter): GivenArgument("value", condition, None, word, None)
        for parameter, word in zip(parameters, arguments, strict=False)
    }
    plain = SourceText(" ".join(condition.split()), condition.place, str(condition))
    return str(Expansion("", given).text_at(plain, ("predicates", str(key), "when")))


def _variable(
    resource: str | None, name: SourceText, document: VariableDocument, kind: Kind, declarations: Declarations
) -> Iterator[Family]:
    full = str(name) if resource is None else f"{resource}.{name}"
    arguments = _arguments(document.each, declarations)
    if arguments is None:
        return
    family = Family(full, NameKind(kind.value), BOOLEAN, name.place, arguments, indexed=True)
    first = next(family.instances(declarations.enumerations), "")
    declared = declarations.variables.get(first)
    if declared is not None and declared.kind is kind and declared.resource == resource:
        yield Family(
            full, family.kind, declared.type, name.place, arguments, "", True, resource, declared.initial,
            _in_english(document.title or document.phrase),
        )  # fmt: skip


def _in_english(text: Words | None) -> str | None:
    """A text for people as engineers read it."""
    return None if (found := main_text(text)) is None else str(found)


def _flags(resource: str, name: SourceText, document: AbilityDocument, arguments: tuple[str, ...]) -> Iterator[Family]:
    title = _in_english(document.title)
    for flag in FLAGS:
        text = getattr(document, flag)
        place = text.place if isinstance(text, SourceText) else name.place
        yield Family(
            f"{resource}.{name}", NameKind.FLAG, BOOLEAN, place, arguments, f".{flag}", owner=resource, title=title
        )


def _arguments(parameters: Parameters, declarations: Declarations) -> tuple[str, ...] | None:
    """The enumerations of `parameters`, or None if one of them is unknown."""
    written = tuple(map(str, parameters.values()))
    return written if all(each in declarations.enumerations for each in written) else None


def stub(seen: Visible, long: bool) -> str:
    """The name of a family up to its arguments."""
    name = without_arguments(seen.long if long else seen.short).removesuffix(seen.family.suffix)
    return f"{name}{'[' if seen.family.indexed else '('}"
