"""Types that no instance has yet: what can be said of them before anybody knows the arguments."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from pydantic import ValidationError

from sequence_planner.language.parser import parse, parse_assignment
from sequence_planner.language.syntax import ExpressionError
from sequence_planner.model.documents import AbilityDocument, Parameters, PredicateDocument, ResourceDocument
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.model.types.documents import ParameterKind
from sequence_planner.model.types.layers import (
    UnusedType,
    WrittenInstance,
    content_of,
    document_of,
    layers_of,
    read_instance,
)
from sequence_planner.model.validation import findings_of
from sequence_planner.model.yaml.reader import read_text


class _StandIns(NamedTuple):
    """Arguments in the place of those that nobody has given: a number, and how a text and a name begin."""

    number: int
    text: str
    name: str


# What is wrong with one may be right with another.
_STAND_INS = (_StandIns(1, "", ""), _StandIns(1000, "/", "_"))


def unused_types(
    names: Collection[str], types: Mapping[str, WrittenInstance | None]
) -> tuple[dict[str, UnusedType], list[Finding]]:
    """These types as far as all is right with them, but for those of which another one is; and what is wrong with their
    form and the grammar of their texts, whatever the arguments are.
    """
    found: dict[str, UnusedType] = {}
    wrong: dict[Finding, None] = {}
    bases = {each.base for each in types.values() if each is not None}
    for name in names:
        type_ = types[name]
        assert type_ is not None
        made = [_made_with(name, type_, types, arguments) for arguments in _STAND_INS]
        readable = [_unreadable(each) for each in made if isinstance(each, ResourceDocument)]
        known = _in_all(readable or [each for each in made if isinstance(each, list)])
        wrong |= dict.fromkeys(known)
        if not known and name not in bases and isinstance(made[0], ResourceDocument):
            kinds = {str(each): parameter.kind for each, parameter in type_.parameters.items()}
            found[name] = UnusedType(made[0], kinds, type_.package)
    return found, list(wrong)


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
    for each in texts_of(resource):
        try:
            (parse_assignment if each.is_action else parse)(each.text)
        except ExpressionError as error:
            found.append(Finding(each.text.at(error.span), error.message))
    return found


def _argument(parameter: str, kind: ParameterKind, arguments: _StandIns) -> str:
    if kind == "number":
        return str(arguments.number)
    return f"'{arguments.text if kind == 'text' else arguments.name}{parameter}'"


class ReadText(NamedTuple):
    """A condition or an action of a resource, with the parameters around it; in an ability the flags of that are known
    by their bare names.
    """

    text: SourceText
    parameters: Parameters
    is_action: bool = False
    in_ability: bool = False


def texts_of(resource: ResourceDocument) -> Iterator[ReadText]:
    """All conditions and actions of a resource."""
    for ability in resource.abilities.values():
        yield from _of_ability(ability)
    for predicate in resource.predicates.values():
        parameters = predicate.parameters if isinstance(predicate, PredicateDocument) else {}
        condition = predicate.when if isinstance(predicate, PredicateDocument) else predicate
        if isinstance(condition, SourceText):
            yield ReadText(condition, parameters)
    for alarm in resource.alarms.values():
        if isinstance(alarm.when, SourceText):
            yield ReadText(alarm.when, {})


def _of_ability(ability: AbilityDocument) -> Iterator[ReadText]:
    conditions: list[object] = [ability.enabled, ability.start.when, ability.until, ability.executing, ability.finished]
    if ability.finish is not None:
        conditions.append(ability.finish.when)
    yield from _read(conditions, ability.parameters)
    for part in (ability.start, ability.finish, ability.cancel):
        yield from _read([] if part is None else part.do, ability.parameters, is_action=True)
    for effect in ability.effects.values():
        parameters = {**ability.parameters, **effect.each}
        yield from _read([effect.when], parameters)
        yield from _read(effect.do, parameters, is_action=True)


def _read(texts: Iterable[object], parameters: Parameters, *, is_action: bool = False) -> Iterator[ReadText]:
    for text in texts:
        if isinstance(text, SourceText):
            yield ReadText(text, parameters, is_action, in_ability=True)
