"""Types that no instance has yet: what can be said of them before anybody knows the arguments."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

from pydantic import ValidationError

from sequence_planner.language.parser import parse, parse_assignment
from sequence_planner.language.syntax import ExpressionError
from sequence_planner.model.documents import AbilityDocument, PredicateDocument, ResourceDocument
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.model.types.documents import ParameterKind
from sequence_planner.model.types.layers import WrittenInstance, content_of, document_of, layers_of, read_instance
from sequence_planner.model.validation import findings_of
from sequence_planner.model.yaml.reader import read_text


class _StandIns(NamedTuple):
    """Arguments in the place of those that nobody has given: a number, and how a text and a name begin."""

    number: int
    text: str
    name: str


# What is wrong with one may be right with another.
_STAND_INS = (_StandIns(1, "", ""), _StandIns(1000, "/", "_"))


def wrong_in_unused(name: str, types: Mapping[str, WrittenInstance | None]) -> list[Finding]:
    """Return what is wrong in a type whatever its arguments are: its form, and the grammar of its texts."""
    type_ = types[name]
    assert type_ is not None
    made = [_made_with(name, type_, types, arguments) for arguments in _STAND_INS]
    readable = [_unreadable(each) for each in made if isinstance(each, ResourceDocument)]
    return _in_all(readable or [each for each in made if isinstance(each, list)])


def _in_all(found: Sequence[list[Finding]]) -> list[Finding]:
    return [each for each in found[0] if all(each in other for other in found)]


def _made_with(
    name: str, type_: WrittenInstance, types: Mapping[str, WrittenInstance | None], arguments: _StandIns
) -> ResourceDocument | list[Finding]:
    """The resource that an instance with these arguments would be, or what is wrong with its form."""
    given = [f"{each}: {_argument(each, parameter.kind, arguments)}" for each, parameter in type_.parameters.items()]
    instance, _ = read_instance(read_text(f"type: {name}\narguments: {{{', '.join(given)}}}\n", name))
    assert isinstance(instance, WrittenInstance)
    layers, wrong, is_whole = layers_of("", instance, types)
    if not is_whole:
        return [] if wrong is None else [wrong]
    found: list[Finding] = []
    content = content_of("", layers, found)
    try:
        return found or ResourceDocument.model_validate(content)
    except ValidationError as error:
        return findings_of(error, document_of("", layers), (), ResourceDocument)


def _unreadable(resource: ResourceDocument) -> list[Finding]:
    """What is wrong with the grammar of its conditions and actions."""
    found: list[Finding] = []
    for text, read in _texts(resource):
        if isinstance(text, SourceText):
            try:
                read(text)
            except ExpressionError as error:
                found.append(Finding(text.at(error.span), error.message))
    return found


def _argument(parameter: str, kind: ParameterKind, arguments: _StandIns) -> str:
    if kind == "number":
        return str(arguments.number)
    return f"'{arguments.text if kind == 'text' else arguments.name}{parameter}'"


def _texts(resource: ResourceDocument) -> Iterator[tuple[object, Callable[[str], object]]]:
    """All conditions and actions, each with what reads it."""
    for ability in resource.abilities.values():
        yield from ((text, parse) for text in _conditions(ability))
        yield from ((text, parse_assignment) for text in _actions(ability))
    for predicate in resource.predicates.values():
        yield predicate.when if isinstance(predicate, PredicateDocument) else predicate, parse
    for alarm in resource.alarms.values():
        yield alarm.when, parse


def _conditions(ability: AbilityDocument) -> Iterator[object]:
    yield from (ability.enabled, ability.start.when, ability.until, ability.executing, ability.finished)
    if ability.finish is not None:
        yield ability.finish.when
    yield from (effect.when for effect in ability.effects.values())


def _actions(ability: AbilityDocument) -> Iterator[SourceText]:
    yield from ability.start.do
    for part in (ability.finish, ability.cancel, *ability.effects.values()):
        yield from () if part is None else part.do
