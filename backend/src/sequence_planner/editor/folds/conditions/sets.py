"""Folds of lists of values: the name of a set or an enumeration in place of the list, and enumerations in others."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import reduce

from pydantic import JsonValue

from sequence_planner.editor.draft import AddEntry, SetEntry
from sequence_planner.editor.folds.conditions.quantifiers import is_membership, runs
from sequence_planner.editor.folds.proposal import NAME, FoldProposal, apart, place_between
from sequence_planner.editor.folds.texts import FoldableStation, FoldableText, Rewriting
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.editor.symbols.texts import STATION, entry, pairs
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import And, Comparison, Membership, Name, Or, Span
from sequence_planner.model.source import SourceText

_WORD_IN_NAME = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_FEWEST_NAMED = 3  # values that are worth a name
_FEWEST_SHARED = 3  # values that an enumeration is worth to be included for


def set_proposals(station: FoldableStation) -> Iterator[FoldProposal]:
    """A proposal for each list of values that has a name, or could have one."""
    groups: dict[frozenset[str], list[Rewriting]] = defaultdict(list)
    for text in station.texts:
        for node in text.nodes:
            for listed, part in _lists(station, text, node):
                groups[frozenset(listed)].append(part)
    for values, parts in groups.items():
        found = apart(parts)
        places = f"{len(found)} places" if len(found) > 1 else "one place"
        if known := station.with_values(values):
            named = tuple(Rewriting(each.text, each.span, each.now.replace(NAME, known[0])) for each in found)
            yield FoldProposal(FoldKind.SET, f"Name `{known[0]}` in place of its values, in {places}", named)
        elif len(found) > 1 and len(values) >= _FEWEST_NAMED and (whole := station.smallest_with(values)) is not None:
            members: list[JsonValue] = [*_as_members(station, values, whole)]
            added = AddEntry(file=STATION, path=["sets", NAME], value={"of": whole, "values": members})
            title = f"Name a set `{NAME}` of {len(values)} values of `{whole}`, in {places}"
            yield FoldProposal(FoldKind.SET, title, found, added=added, name=_name_for(station, values, whole))


def _lists(station: FoldableStation, text: FoldableText, node: object) -> Iterator[tuple[Sequence[str], Rewriting]]:
    """The lists of values that something is, or is not, one of."""
    if isinstance(node, Membership):
        values = [str(each) for each in node.options if isinstance(each, Name) and str(each) in station.every_value]
        if len(set(values)) == len(node.options) > 1:
            start = text.text.rfind("{", node.span.start, node.options[0].span.start)
            yield values, Rewriting(text, Span(start, node.span.end), NAME)
    elif isinstance(node, And | Or):
        for run in runs(station, node):
            body = run.body
            if not is_membership(body) or not isinstance(body, Comparison):
                continue
            if body.operator == ("!=" if isinstance(node, And) else "=="):
                span = text.with_brackets(text.of_operands(node, run.first, run.last))
                is_not = "not " if isinstance(node, And) else ""
                yield run.values, Rewriting(text, span, f"{is_not}{print_expression(body.left)} in {NAME}")


def _as_members(station: FoldableStation, values: Iterable[str], whole: str) -> list[str]:
    """Values of an enumeration in its order, with sets among them that have a name already."""
    left, order = set(values), station.domains[whole].values
    inside = sorted(
        (name for name, each in station.domains.items() if len(each.values) > 1 and set(each.values) < left),
        key=lambda name: -len(station.domains[name].values),
    )
    members: list[str] = []
    for name in inside:
        if set(station.domains[name].values) <= left:
            members.append(name)
            left -= set(station.domains[name].values)
    return [*members, *(value for value in order if value in left)]


def _name_for(station: FoldableStation, values: Iterable[str], whole: str) -> str:
    """A name of the words that all values have; of the enumeration's where there are none."""
    split = [_WORD_IN_NAME.findall(value) for value in sorted(values)]
    common = reduce(lambda one, other: [word for word in one if word in other], split)
    name = "_".join(word.lower() for word in common if not word.isdigit())
    enumerations = (station.domains[each] for each in (whole,))
    is_telling = any(not all(name in _flat(value) for value in each.values) for each in enumerations)
    return station.unused(name if len(name) > 3 and is_telling else f"some_{whole}s")


def _flat(value: str) -> str:
    return "_".join(word.lower() for word in _WORD_IN_NAME.findall(value))


# Enumerations that others have at their end


def include_proposals(station: FoldableStation) -> Iterator[FoldProposal]:
    """A proposal for each enumeration that ends with all values of another one, in their order."""
    written = entry(station.content.get(STATION), "enumerations")
    lists = {key: value for key, value in pairs(written) if isinstance(value, list)}
    for name, values in lists.items():
        plain = [str(each) for each in values]
        ends = [
            other
            for other in station.domains
            if other != name and other in map(str, dict(pairs(written))) and _ends(plain, station.domains[other].values)
        ]
        best = max(ends, key=lambda other: len(station.domains[other].values), default=None)
        if best is None or any(not isinstance(each, SourceText) for each in values):
            continue
        own = plain[: len(plain) - len(station.domains[best].values)]
        now: dict[str, JsonValue] = {"values": [*own]} if own else {}
        now["includes"] = [best]
        edit = SetEntry(file=STATION, path=["enumerations", str(name)], was=list(plain), value=now)
        place = place_between(STATION, name, values[-1], f"{len(plain)} values", f"includes: [{best}]")
        yield FoldProposal(FoldKind.INCLUDES, f"Include `{best}` in `{name}`", entries=((edit, place),))


def _ends(values: list[str], other: Sequence[str]) -> bool:
    return len(other) >= _FEWEST_SHARED and values[-len(other) :] == list(other)
