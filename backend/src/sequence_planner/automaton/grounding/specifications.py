"""Ground specifications, as forbidden states. The shorthands engineers use are defined by what they expand to here.

    forbidden: A                    A
    never: A, while: B              A and B
    exclusive: [a, b, ...]          a.executing and b.executing, for each two
    zone: {r: A, s: B, ...}         A and B, for each two
    order: [A, B, ...]              B and not A, for each two neighbours

An ability with parameters stands for all its ground abilities in `exclusive`: one of them executes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations, pairwise

from sequence_planner.automaton.automaton import Specification
from sequence_planner.automaton.findings import Binding, followed_by, instance_name, title_of, without_arguments
from sequence_planner.automaton.grounding.meaning import Meaning
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.parser import parse
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.syntax import (
    FALSE,
    Expression,
    ExpressionError,
    Name,
    Not,
    Or,
    Variable,
    conjunction,
    variables,
)
from sequence_planner.language.types import BOOLEAN
from sequence_planner.model.documents import SpecificationDocument
from sequence_planner.model.fields import Predicate
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message

Part = tuple[str, Expression]  # what of a specification is forbidden, and in which words


def ground_specifications(
    meaning: Meaning, documents: Mapping[SourceText, SpecificationDocument], resources: Iterable[str]
) -> dict[str, Specification]:
    """All specifications by name; `resources` are those that can share a zone."""
    specifications: dict[str, Specification] = {}
    known = list(resources)
    for name, document in documents.items():
        meaning.declarations.check_name(name, "specification")
        meaning.declarations.check_parameters(document.parameters, *(f"{name}." for name in document.zone or ()))
        for binding in meaning.declarations.bindings(document.parameters):
            full = instance_name(name, binding)
            title = title_of(document.title, name, binding, meaning.declarations.titles, apart=False)
            for words, forbidden in _parts(meaning, document, binding, known):
                part = f"{full}: {words}" if words else full
                specifications[part] = Specification(part, followed_by(title, words), simplify(forbidden))
                meaning.declarations.places[part] = name.place
    return specifications


def _parts(meaning: Meaning, document: SpecificationDocument, binding: Binding, resources: list[str]) -> Iterator[Part]:
    scope = meaning.scope(binding)
    if document.forbidden is not None:
        yield "", meaning.predicate(document.forbidden, scope)
    elif document.never is not None and document.during is not None:
        yield "", conjunction(meaning.predicate(document.never, scope), meaning.predicate(document.during, scope))
    elif document.exclusive is not None:
        yield from _at_most_one(exclusive_abilities(meaning, document.exclusive, scope))
    elif document.zone is not None:
        yield from _at_most_one([_inside(meaning, *entry, binding, resources) for entry in document.zone.items()])
    elif document.order is not None:
        stages = [(_words(text), meaning.predicate(text, scope)) for text in document.order]
        for (first, before), (then, after) in pairwise(stages):
            yield f"{first} before {then}", conjunction(after, Not(before))


def exclusive_abilities(meaning: Meaning, texts: Sequence[SourceText], scope: NameScope) -> list[Part]:
    """That each of the named abilities executes; none of them is named twice."""
    executing = [(str(text), _executing(meaning, text, scope)) for text in texts]
    for (one, (_, flags)), (other, (_, others)) in combinations(zip(texts, executing, strict=True), 2):
        if shared := sorted(set(variables(flags)) & set(variables(others))):
            ability = shared[0].removesuffix(".executing")
            meaning.findings.add(other, message("wrong.excludes-itself", ability=ability, other=one))
    return executing


def _at_most_one(parts: Iterable[Part]) -> Iterator[Part]:
    for (one, first), (other, second) in combinations(parts, 2):
        yield f"{one} and {other}", conjunction(first, second)


def _words(text: Predicate) -> str:
    return " ".join(str(text).split())


def _inside(meaning: Meaning, resource: SourceText, text: Predicate, binding: Binding, resources: list[str]) -> Part:
    """The condition, in its own words, under which a resource is in a zone."""
    if resource not in resources:
        hint = suggestion(resource, resources)
        meaning.findings.add(resource, message("wrong.no-resource", name=str(resource), hint=hint))
        return str(resource), FALSE
    return str(resource), meaning.predicate(text, meaning.scope(binding, f"{resource}."))


def _executing(meaning: Meaning, text: SourceText, scope: NameScope) -> Expression:
    """That the named ability executes, or one of those that bear its name with parameters."""
    try:
        named = parse(text)
        if not isinstance(named, Name):
            raise ExpressionError(message("wrong.expected-ability"), named.span)
        name = str(scope.substitute(named))
        flags = [flag for flag in scope.variables if flag.endswith(".executing")]
        found = [flag for flag in flags if flag == f"{name}.executing"]
        found = found or [flag for flag in flags if without_arguments(flag) == f"{name}.executing"]
        if not found:
            abilities = {each for flag in flags for each in (flag, without_arguments(flag))}
            near = suggestion(name, sorted(each.removesuffix(".executing") for each in abilities))
            if (entry := meaning.declarations.removed.get(name)) is not None:
                near = message("hint.removed", place=str(entry))
            raise ExpressionError(message("wrong.no-ability", name=name, hint=near), named.span)
    except ExpressionError as error:
        if without_arguments(str(text)) not in meaning.declarations.broken:
            meaning.findings.add_within(text, error.span, error.message)
        return FALSE
    flags_read = tuple(Variable(flag, BOOLEAN) for flag in found)
    return flags_read[0] if len(flags_read) == 1 else Or(flags_read)
