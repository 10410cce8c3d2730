"""The document of a plain automaton, `*.efa.json`: what other tools exchange, and the benchmarks are written in.

JSON is read as the YAML that it is, so that whatever is wrong in it has a place.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from pydantic import Discriminator, Field, StrictBool, StrictInt, Tag, ValidationError

from sequence_planner.model.fields import DocumentPart, Predicate
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.validation import findings_of, shown
from sequence_planner.model.yaml.reader import YamlDocument, read_text, read_yaml


class RangeDocument(DocumentPart):
    """The integers from `min` to `max`, both included."""

    least: StrictInt = Field(alias="min")
    most: StrictInt = Field(alias="max")


def _form(domain: object) -> str | None:
    forms = {list: "list", dict: "range", SourceText: "text"}
    return next((form for kind, form in forms.items() if isinstance(domain, kind)), None)


ListDocument = Annotated[list[SourceText | StrictInt], Field(min_length=1)]
# Names of values, or "bool", or a range. Only the form that a domain has says what is wrong with it.
DomainDocument = Annotated[
    Annotated[ListDocument, Tag("list")] | Annotated[SourceText, Tag("text")] | Annotated[RangeDocument, Tag("range")],
    Discriminator(_form, "domain", '"bool", a list of values, or {"min": 0, "max": 3}'),
]
# A text is an expression: a value's name, another variable, or `n + 1`.
UpdateDocument = StrictBool | StrictInt | SourceText


class TransitionDocument(DocumentPart):
    """One transition of an event. The values of `set` are those of the state before it."""

    event: SourceText
    """Its name; several transitions may share one."""
    controllable: StrictBool
    """True if a supervisor can keep it from happening."""
    guard: Predicate = True
    """The condition under which it can happen."""
    updates: dict[SourceText, UpdateDocument] = Field(default_factory=dict, alias="set")
    """New values, all at once: JSON values, or expressions such as `n + 1`."""


class PlainDocument(DocumentPart):
    """A whole plain automaton. `goal` holds formulas of LTL over finite traces."""

    name: SourceText
    """The automaton's name."""
    variables: dict[SourceText, DomainDocument]
    """Each with its values: a list of names, "bool", or a range such as {"min": 0, "max": 3}."""
    initial: Predicate
    """The initial states."""
    transitions: list[TransitionDocument] = Field(default_factory=list)
    """Events, of which one happens at a time."""
    forbidden: list[Predicate] = Field(default_factory=list)
    """Conditions that must never hold."""
    marked: Predicate = True
    """States that can always be reached again."""
    invariant: Predicate = True
    """States that do not satisfy it do not exist."""
    goal: list[SourceText] = Field(default_factory=list)
    """Formulas about a run, such as `F (u1 == has)`."""


@dataclass(frozen=True)
class PlainModel:
    """A plain automaton as written; `source` has the place of each of its entries."""

    source: YamlDocument
    content: PlainDocument


def load_plain(path: Path) -> PlainModel:
    """Read the file of a plain automaton. Raises `ModelError` with every finding about its form."""
    return _validated(read_yaml(path, str(path)))


def read_plain(text: str, name: str) -> PlainModel:
    """Read the text of a plain automaton; `name` is how it is called in messages. Raises `ModelError`."""
    return _validated(read_text(text, name))


def _validated(source: YamlDocument) -> PlainModel:
    if not isinstance(source.content, dict):
        message = f"expected a plain automaton with its name, variables and transitions, found {shown(source.content)}"
        raise ModelError([Finding(source.place(()), message)])
    try:
        return PlainModel(source, PlainDocument.model_validate(source.content))
    except ValidationError as error:
        raise ModelError(findings_of(error, source, (), PlainDocument)) from error
