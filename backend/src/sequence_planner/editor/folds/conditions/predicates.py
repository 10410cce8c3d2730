"""Folds of conditions that stand in several places: a predicate, by its name, in place of each."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from sequence_planner.editor.draft import AddEntry
from sequence_planner.editor.folds.conditions.quantifiers import is_membership, over, quantified, runs, words_for
from sequence_planner.editor.folds.proposal import NAME, FoldProposal, apart, is_within
from sequence_planner.editor.folds.texts import (
    FoldableStation,
    FoldableText,
    Rewriting,
    names_in,
    nodes_of,
    words_of,
)
from sequence_planner.editor.language.service import check
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.editor.symbols.texts import STATION
from sequence_planner.language.parser import parse
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import (
    And,
    Comparison,
    Component,
    Expression,
    Implies,
    Membership,
    Name,
    NamedMembership,
    Not,
    Or,
    Quantified,
    Span,
    first_temporal,
)
from sequence_planner.model.paths import resource_of

_SHORTEST = 60  # characters of a condition that is worth a name
_MOST_OPERANDS = 16  # of a junction of which all parts are looked at
_LONGEST_NAME = 40


@dataclass(frozen=True)
class _Part:
    """A condition within a text, in full names."""

    text: FoldableText
    span: Span
    tree: Expression


def predicate_proposals(station: FoldableStation) -> Iterator[FoldProposal]:
    """A proposal for each condition that stands in several places, the longest first."""
    places = _Names(station)
    groups: dict[str, list[_Part]] = defaultdict(list)
    for text in station.texts:
        for span, tree in _conditions(text):
            if (full := places.in_full(text, tree)) is not None and len(written := print_expression(full)) >= _SHORTEST:
                groups[written].append(_Part(text, span, full))
    shown: list[FoldProposal] = []
    for _, parts in sorted(groups.items(), key=lambda each: -len(each[0]) * (len(each[1]) - 1)):
        found = _proposal(station, parts)
        if found is not None and not any(_says_more(other, found) for other in shown):
            shown.append(found)
            yield found


def _says_more(one: FoldProposal, other: FoldProposal) -> bool:
    """Return whether all places of a proposal lie in those of another one."""
    return all(any(is_within(part, whole) for whole in one.replacements) for part in other.replacements)


def _proposal(station: FoldableStation, parts: list[_Part]) -> FoldProposal | None:
    known = next((each for each in parts if _is_predicate(each)), None)
    found = apart(
        [Rewriting(each.text, each.text.with_brackets(each.span), NAME) for each in parts if not _is_predicate(each)]
    )
    tree = parts[0].tree
    if known is not None and found:
        home = resource_of(known.text.file)
        full = str(known.text.path[1]) if home is None else f"{home}.{known.text.path[1]}"
        named = tuple(Rewriting(each.text, each.span, full) for each in found)
        return FoldProposal(FoldKind.PREDICATE, f"Write `{full}` for what it says, in {_counted(len(named))}", named)
    if len(found) < 2:
        return None
    files = {each.text.file for each in found}
    own = resource_of(min(files)) if len(files) == 1 else None
    file = STATION if own is None else min(files)
    when = _over_sets(station, print_expression(tree), file)
    if own is not None:
        when = _without_prefix(when, own)
    added = AddEntry(file=file, path=["predicates", NAME], value=when)
    title = f"Name a predicate `{NAME}`, in {_counted(len(found))}"
    return FoldProposal(FoldKind.PREDICATE, title, found, added=added, name=station.unused(_called(station, tree)))


def _counted(places: int) -> str:
    return f"{places} places" if places > 1 else "one place"


def _is_predicate(part: _Part) -> bool:
    """Return whether a part is all that a predicate without parameters says."""
    text = part.text
    is_all = not text.text[: part.span.start].strip(" (") and not text.text[part.span.end :].strip(" )")
    return text.path[0] == "predicates" and not text.field.parameters and is_all


def _conditions(text: FoldableText) -> Iterator[tuple[Span, Expression]]:
    """All conditions in a text that could have a name, those among them that are some of the operands of others."""
    for node in text.nodes:
        if isinstance(node, And | Or):
            count = len(node.operands)
            for first in range(count if count <= _MOST_OPERANDS else 1):
                for last in range(first + 1, count) if count <= _MOST_OPERANDS else (count - 1,):
                    yield text.of_operands(node, first, last), type(node)(node.operands[first : last + 1])
        elif isinstance(node, Quantified | Implies):
            yield node.span, node


class _Names:
    """The full names of what conditions read."""

    def __init__(self, station: FoldableStation) -> None:
        self._station = station

    @cached_property
    def _declared(self) -> frozenset[str]:
        lexicon = self._station.lexicon
        return frozenset(each.skeleton for each in (*lexicon.families, *lexicon.short.values()))

    def in_full(self, text: FoldableText, tree: Expression) -> Expression | None:
        """A condition with all its names in full; None for one about a run, and where it depends on a parameter of what
        it belongs to.
        """
        if first_temporal(tree) is not None:
            return None
        parameters = set(map(str, text.field.parameters))
        if parameters and parameters & {*words_of(tree), *_domains_of(tree)}:
            return None
        longer: dict[str, str] = {}
        for name in names_in(tree):
            prefix = self._prefix(text, ".".join(part.name for part in name.path))
            if prefix is None:
                return None
            longer[str(name)] = prefix + str(name)
        return _with_names(tree, {short: full for short, full in longer.items() if short != full})

    def _prefix(self, text: FoldableText, name: str) -> str | None:
        field = text.field
        if field.ability is not None and f"{field.resource}.{field.ability}.{name}" in self._declared:
            return None if field.parameters else f"{field.resource}.{field.ability}."
        if field.resource is not None and f"{field.resource}.{name}" in self._declared:
            return f"{field.resource}."
        return ""


def _domains_of(tree: Expression) -> set[str]:
    return {str(each.domain) for each in nodes_of(tree) if isinstance(each, NamedMembership)}


def _with_names(tree: Expression, names: dict[str, str]) -> Expression:
    """`tree` with other names: written anew, as its places are of no more use."""
    text = print_expression(tree)
    if not names:
        return parse(text)
    found = sorted(names_in(parse(text)), key=lambda name: name.span.start, reverse=True)
    for name in found:
        if (full := names.get(str(name))) is not None:
            text = text[: name.span.start] + full + text[name.span.end :]
    return parse(text)


def _without_prefix(text: str, resource: str) -> str:
    """A condition as it is written in a resource's own file."""
    for name in sorted(names_in(parse(text)), key=lambda name: name.span.start, reverse=True):
        if name.path[0] == Component(resource) and len(name.path) > 1:
            own = str(Name(name.path[1:]))
            text = text[: name.span.start] + own + text[name.span.end :]
    return text


def _over_sets(station: FoldableStation, text: str, file: str) -> str:
    """A condition with what it says of all values of a set said once."""
    field = station.lexicon.field(file, ("predicates", "new"))
    for node in nodes_of(parse(text)):
        if isinstance(node, And | Or):
            for run in runs(station, node):
                for part, domain in over(station, run):
                    if len(part.values) < len(node.operands) or is_membership(part.body):
                        continue
                    for word in dict.fromkeys(words_for(station, part.body, domain)):
                        said = quantified(isinstance(node, And), part.body, domain, word)
                        new = text[: node.span.start] + said + text[node.span.end :]
                        if field is not None and not check(station.lexicon, field, new):
                            return _over_sets(station, new, file)
    return text


def _called(station: FoldableStation, tree: Expression) -> str:
    """A name that says what a condition is about."""
    if isinstance(tree, And | Or):
        for run in runs(station, tree):
            if run.last - run.first == len(tree.operands) - 1:
                return f"{'all' if isinstance(tree, And) else 'any'}_{_said(run.body)}"[:_LONGEST_NAME].strip("_")
        joined = f"_{'and' if isinstance(tree, And) else 'or'}_".join(map(_said, tree.operands))
        name = joined if len(joined) <= _LONGEST_NAME else f"{_said(tree.operands[0])}_and_more"
        return name if len(name) <= _LONGEST_NAME else "condition"
    if isinstance(tree, Quantified) and tree.number is None and tree.quantifier in ("all", "any", "none"):
        return f"{tree.quantifier}_{_said(tree.body)}"[:_LONGEST_NAME].strip("_")
    return "condition"


def _said(tree: Expression) -> str:
    match tree:
        case Not(operand):
            return f"not_{_said(operand)}"
        case Name():
            return tree.path[-1].name if NAME not in tree.path[-1].name else "so"
        case Comparison(operator, Name() as left, Name() as right):
            is_value = right.is_word and NAME not in str(right)
            value = str(right) if is_value else left.path[-1].name
            return value.lower() if operator == "==" else f"not_{value.lower()}"
        case Membership(Name() as left) | NamedMembership(Name() as left):
            return left.path[-1].name
    return "so"
