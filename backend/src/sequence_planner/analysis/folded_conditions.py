"""Conditions that relations, maps, quantifiers and orders make true or false for good.

In an automaton most are constants, which nobody can tell from what was meant so; here they are as they were written.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import product
from math import prod
from typing import NamedTuple

from sequence_planner.analysis.checks.warning import ModelWarning, shortened
from sequence_planner.automaton.declarations import Declarations
from sequence_planner.automaton.findings import Binding, Findings, instance_name
from sequence_planner.language.evaluator import holds
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse
from sequence_planner.language.resolver import resolve_predicate
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.syntax import And, Constant, Expression, ExpressionError, Span, occurrences
from sequence_planner.language.types import Place
from sequence_planner.model.documents import AbilityDocument
from sequence_planner.model.fields import RESERVED
from sequence_planner.model.loader import Station
from sequence_planner.model.source import ExpandedText, SourceText
from sequence_planner.texts.message import message

MOST_VALUES = 1000  # of what a condition reads, all combinations


class _Condition(NamedTuple):
    """A text, with what names mean there for one choice of the parameters."""

    text: SourceText
    scope: NameScope


def check_folded(station: Station) -> Iterator[ModelWarning]:
    """Yield the parts of conditions that always hold or never do, for all values of parameters and in all instances, by
    what relations, maps, quantifiers and orders say alone.
    """
    declarations = Declarations(station, Findings())
    vocabulary = declarations.vocabulary
    names = {name.rpartition(".")[2] for name in (*vocabulary.relations, *vocabulary.maps)}
    told = re.compile(rf"\b(?:{'|'.join(map(re.escape, sorted({*names, *RESERVED})))})\b")
    found: dict[Place, tuple[str, set[bool | None]]] = {}
    for condition in _conditions(station, declarations):
        if not told.search(condition.text):
            continue
        for span, truth in _parts(condition):
            written = condition.text[span.start : span.end]
            if told.search(written) and not _is_given(condition.text, span):
                is_whole = written == condition.text.strip()  # told at the same place as what the automaton says of it
                place = (condition.text.place if is_whole else condition.text.at(span))._replace(instance="")
                found.setdefault(place, (written, set()))[1].add(truth)
    for place, (written, truths) in sorted(found.items()):
        if truths in ({True}, {False}):
            kind = "always-holds" if truths == {True} else "never-holds"
            yield ModelWarning(place, kind, message(f"found.{kind}", condition=shortened(written)))


def _conditions(station: Station, declarations: Declarations) -> Iterator[_Condition]:
    """The conditions of abilities, operations, alarms and of rest, for each choice of their parameters."""

    def scope(binding: Binding, *prefixes: str) -> NameScope:
        return NameScope(declarations.types, prefixes, binding, declarations.vocabulary)

    for resource, name, document in declarations.written_abilities():
        for binding in declarations.bindings(document.parameters):
            inside = scope(binding, f"{instance_name(f'{resource}.{name}', binding)}.", f"{resource}.")
            yield from _of(inside, *_of_ability(document))
    for operation in station.operations.values():
        for binding in declarations.bindings(operation.parameters):
            yield from _of(scope(binding), operation.precondition, operation.goal)
    for resource, written in station.resources.items():
        yield from _of(scope({}, f"{resource}."), *(each.when for each in written.alarms.values()))
    yield from _of(scope({}), station.station.rest, *(each.when for each in station.station.alarms.values()))


def _of_ability(document: AbilityDocument) -> Iterator[object]:
    yield from (document.enabled, document.start.when, document.until, document.executing, document.finished)
    if document.finish is not None:
        yield document.finish.when
    yield from (effect.when for effect in document.effects.values())


def _of(scope: NameScope, *texts: object) -> Iterator[_Condition]:
    return (_Condition(text, scope) for text in texts if isinstance(text, SourceText))


def _parts(condition: _Condition) -> Iterator[tuple[Span, bool | None]]:
    """What must all hold, each with whether it does whatever the state is; None where that depends on it."""
    try:
        whole = parse(condition.text)
    except ExpressionError:
        return
    for part in whole.operands if isinstance(whole, And) else (whole,):
        if not isinstance(part, Constant):
            yield part.span, _truth(part, condition.scope)


def _truth(part: Expression, scope: NameScope) -> bool | None:
    try:
        found = simplify(resolve_predicate(part, scope))
    except ExpressionError:
        return None
    if isinstance(found, Constant):
        return found.value if isinstance(found.value, bool) else None
    return True if _always_holds(found) else None


def _always_holds(condition: Expression) -> bool:
    """Return whether a condition holds for all values, as one on a map does that has it for each; false where these are
    too many.
    """
    read = {each.name: each.type.domain for each in occurrences(condition)}
    if prod(map(len, read.values())) > MOST_VALUES:
        return False
    return all(holds(condition, dict(zip(read, values, strict=True))) for values in product(*read.values()))


def _is_given(text: SourceText, span: Span) -> bool:
    """Return whether an argument of an instance is a part of it: another instance may give another one."""
    return isinstance(text, ExpandedText) and any(span.start <= each.start < span.end for each in text.pieces)
