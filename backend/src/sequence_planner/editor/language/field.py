"""A field of the editor: what kind of text stands there, what names mean in it, and what grounding makes of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from sequence_planner.automaton.findings import Binding, instance_name, with_arguments
from sequence_planner.automaton.grounding.meaning import Meaning, Writing
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.syntax import Expression, conjunction
from sequence_planner.language.types import Place, Type
from sequence_planner.model.documents import Parameters
from sequence_planner.model.fields import Predicate
from sequence_planner.model.source import SourceText

# What grounding does with the text of a field, for one choice of the parameters.
Reading = Callable[[Meaning, SourceText, NameScope], object]


class FieldKind(StrEnum):
    """The kind of text that stands in a field."""

    CONDITION = "condition"
    FORMULA = "formula"
    ACTION = "action"
    TYPE = "type"
    INITIAL = "initial"
    MEMBER = "member"
    ENUMERATION = "enumeration"
    ABILITY = "ability"
    OPERATION = "operation"
    ACKNOWLEDGEMENT = "acknowledgement"


@dataclass(frozen=True)
class TextField:
    """A place for a text. `resource` and `ability` are those whose names are seen without their prefix; `each` are the
    parameters that are not the ability's, but of its effect alone.

    `choices` are what can be written where that is one of few names; `type` is that of a value.
    """

    kind: FieldKind
    read: Reading = field(compare=False, repr=False)
    parameters: Parameters = field(default_factory=dict)
    resource: str | None = None
    ability: str | None = None
    operation: str | None = None
    writing: Writing | None = None
    choices: tuple[str, ...] = ()
    type: Type | None = None
    each: Parameters = field(default_factory=dict)

    def prefixes(self, binding: Binding) -> tuple[str, ...]:
        """Return what is tried before a bare name, in order, for one choice of the parameters."""
        own = (f"{self.resource}.",) if self.resource else ()
        known = {name: value for name, value in binding.items() if name not in self.each}
        return (f"{instance_name(self._ability, known)}.", *own) if self.ability else own

    @property
    def prefix_patterns(self) -> tuple[str, ...]:
        """The same for all choices at once, with the parameters as they are written."""
        own = (f"{self.resource}.",) if self.resource else ()
        known = [str(name) for name in self.parameters if name not in self.each]
        return (f"{with_arguments(self._ability, known)}.", *own) if self.ability else own

    def scopes(self, meaning: Meaning) -> Iterator[NameScope]:
        """Yield what names mean here, for each choice of the parameters."""
        for binding in meaning.declarations.bindings(self.parameters):
            yield meaning.scope(binding, *self.prefixes(binding))

    @property
    def _ability(self) -> str:
        return f"{self.resource}.{self.ability}"


def condition(meaning: Meaning, text: SourceText, scope: NameScope) -> object:
    """Return what grounding makes of a condition."""
    return meaning.predicate(text, scope)


def all_of(meaning: Meaning, texts: Iterable[Predicate], scope: NameScope) -> Expression:
    """The condition that all of `texts` hold."""
    return conjunction(*(meaning.predicate(text, scope) for text in texts))


def with_text(texts: Sequence[SourceText], index: int, text: SourceText) -> list[SourceText]:
    """`texts` with `text` as that entry, or as their last if there are not so many."""
    return [*texts[:index], text, *texts[index + 1 :]]


def field_of_parameter(name: str, resource: str | None = None) -> TextField:
    """The enumeration of the parameter `name`."""
    key = placed(name)

    def reading(meaning: Meaning, text: SourceText, scope: NameScope) -> None:
        meaning.declarations.check_parameters({key: meaning.declarations.domain_in(text, resource)})

    return TextField(FieldKind.ENUMERATION, reading, resource=resource)


def placed(name: str) -> SourceText:
    """A name as a key of documents, at no place in particular."""
    return SourceText(name, Place("", 1, 1), name)
