"""Folds of pairs of values: a relation in place of a condition that lists them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

from pydantic import JsonValue

from sequence_planner.editor.draft import AddEntry
from sequence_planner.editor.folds.proposal import NAME, FoldProposal, apart
from sequence_planner.editor.folds.texts import FoldableStation, FoldableText, Rewriting
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.editor.symbols.texts import STATION
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import (
    And,
    Comparison,
    Expression,
    Membership,
    Name,
    NamedMembership,
    Or,
)
from sequence_planner.language.types import EnumerationType

_FEWEST_PAIRS = 3  # lines of pairs that are worth a relation


class PairOfLists(NamedTuple):
    """Values of two subjects that belong together: each of one with each of the other."""

    left: tuple[str, ...]
    right: tuple[str, ...]


class PairRun(NamedTuple):
    """Operands next to each other that are about pairs of values of the same two subjects."""

    first: int
    last: int
    subjects: tuple[Expression, Expression]
    pairs: tuple[PairOfLists, ...]


def relation_proposals(station: FoldableStation) -> Iterator[FoldProposal]:
    """A proposal for each list of pairs of values."""
    groups: dict[tuple[frozenset[tuple[str, str]], str, str], list[tuple[Rewriting, PairRun]]] = defaultdict(list)
    for text in station.texts:
        scope = next(text.field.scopes(station.lexicon.meaning(text.field)), None)
        for node in text.nodes if scope is not None else ():
            if isinstance(node, Or) and (run := _longest(station, node)) is not None:
                assert scope is not None
                domains = [_domain_of(station, scope, text, each) for each in run.subjects]
                if domains[0] is None or domains[1] is None:
                    continue
                span = text.with_brackets(text.of_operands(node, run.first, run.last))
                one, other = map(print_expression, run.subjects)
                part = Rewriting(text, span, f"{NAME}({one}, {other})")
                groups[_all_pairs(run.pairs), *_widened(station, domains[0], domains[1])].append((part, run))
    for (_, left, right), found in groups.items():
        parts = apart([part for part, _ in found])
        is_symmetric, rows = _rows(station, left == right, found[0][1].pairs)
        value: dict[str, JsonValue] = {"between": [left, right]}
        value |= {"symmetric": True, "pairs": rows} if is_symmetric else {"pairs": rows}
        added = AddEntry(file=STATION, path=["relations", NAME], value=value)
        title = f"Name a relation `{NAME}` of {len(rows)} lines of pairs"
        yield FoldProposal(FoldKind.RELATION, title, parts, added=added, name=station.unused("belong_together"))


def _longest(station: FoldableStation, node: Or) -> PairRun | None:
    """The longest run of pairs among the operands, if it is long enough."""
    read = [_pair(station, each) for each in node.operands]
    best: PairRun | None = None
    for first in range(len(read)):
        subjects: tuple[Expression, Expression] | None = None
        pairs: list[PairOfLists] = []
        for found in read[first:]:
            if found is None:
                break
            one, other = found
            subjects = subjects or (one[0], other[0])
            if subjects == (one[0], other[0]):
                pairs.append(PairOfLists(one[1], other[1]))
            elif subjects == (other[0], one[0]):
                pairs.append(PairOfLists(other[1], one[1]))
            else:
                break
        if subjects and len(pairs) >= _FEWEST_PAIRS and (best is None or len(pairs) > len(best.pairs)):
            best = PairRun(first, first + len(pairs) - 1, subjects, tuple(pairs))
    return best


_Side = tuple[Expression, tuple[str, ...]]


def _pair(station: FoldableStation, operand: Expression) -> tuple[_Side, _Side] | None:
    """The two things that an operand says the values of, each with these."""
    if not isinstance(operand, And) or len(operand.operands) != 2:
        return None
    one, other = (_side(station, each) for each in operand.operands)
    return None if one is None or other is None else (one, other)


def _side(station: FoldableStation, part: Expression) -> _Side | None:
    match part:
        case Comparison("==", Name() as left, Name() as right) if str(right) in station.every_value:
            return left, (str(right),)
        case Membership(Name() as left, options):
            values = tuple(str(each) for each in options if isinstance(each, Name) and str(each) in station.every_value)
            return (left, values) if len(values) == len(options) else None
        case NamedMembership(Name() as left, domain) if str(domain) in station.domains:
            return left, station.domains[str(domain)].values
    return None


def _domain_of(station: FoldableStation, scope: NameScope, text: FoldableText, subject: Expression) -> str | None:
    """The enumeration that a subject is of."""
    assert isinstance(subject, Name)
    for parameter, domain in text.field.parameters.items():
        if str(parameter) == str(subject):
            return str(domain)
    found = scope.find(subject)
    if found is None or not isinstance(found.type, EnumerationType):
        return None
    return next((name for name, each in station.domains.items() if each == found.type), None)


def _widened(station: FoldableStation, one: str, other: str) -> tuple[str, str]:
    """Two enumerations; twice the larger one where it has all values of the other, as of what is one kind of thing."""
    first, second = (set(station.domains[each].values) for each in (one, other))
    if first >= second:
        return one, one
    return (other, other) if second >= first else (one, other)


def _all_pairs(pairs: tuple[PairOfLists, ...]) -> frozenset[tuple[str, str]]:
    return frozenset(each for lists in pairs for each in product(*lists))


def _rows(station: FoldableStation, is_of_one: bool, pairs: tuple[PairOfLists, ...]) -> tuple[bool, list[JsonValue]]:
    """Whether pairs hold both ways, which only those of one enumeration can, and the lines that they then need."""
    whole = _all_pairs(pairs)
    is_symmetric = is_of_one and whole == {(other, one) for one, other in whole}
    rows: list[JsonValue] = []
    known: set[tuple[str, str]] = set()
    for lists in pairs:
        own = set(product(*lists))
        if own <= known:
            continue
        known |= own | ({(other, one) for one, other in own} if is_symmetric else set())
        rows.append([_shortly(station, lists.left), _shortly(station, lists.right)])
    return is_symmetric, rows


def _shortly(station: FoldableStation, values: tuple[str, ...]) -> JsonValue:
    """Values as they are written in a pair: one by itself, several by the name of their set, or as a list."""
    if len(values) == 1:
        return values[0]
    names = station.with_values(values)
    return names[0] if names else list(values)
