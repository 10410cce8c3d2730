"""Folds of what is said of each value of a set: `all`, `any` and `none` in place of a line for each value."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from sequence_planner.editor.folds.proposal import NAME, FoldProposal, apart, part_of, with_replacements
from sequence_planner.editor.folds.texts import (
    FoldableStation,
    FoldableText,
    Rewriting,
    names_in,
    with_word,
    words_of,
)
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import And, Comparison, Component, Expression, Name, Not, Or
from sequence_planner.model.fields import RESERVED

_THE_VALUE = Name((Component(NAME),))
_FEWEST_IN_BRACES = 3


@dataclass(frozen=True)
class ValueRun:
    """Operands next to each other that are the same but for a value: `body` has `NAME` in the place of it."""

    first: int
    last: int
    body: Expression
    values: tuple[str, ...]


def runs(station: FoldableStation, node: And | Or) -> Iterator[ValueRun]:
    """What is said one value after the other among the operands of a junction, the longest that there is each time."""
    first = 0
    while first < len(node.operands) - 1:
        starting = sorted(words_of(node.operands[first]) & station.every_value)
        found = max((_run(station, node.operands, first, word) for word in starting), key=_length, default=None)
        if found is None or found.last == first:
            first += 1
        else:
            yield found
            first = found.last + 1


def _length(run: ValueRun) -> int:
    return run.last


def _run(station: FoldableStation, operands: Sequence[Expression], first: int, word: str) -> ValueRun:
    body, values = with_word(operands[first], word, NAME), [word]
    for operand in operands[first + 1 :]:
        fitting = (
            each for each in sorted(words_of(operand) & station.every_value) if with_word(operand, each, NAME) == body
        )
        value = next(fitting, None)
        if value is None or value in values:
            break
        values.append(value)
    return ValueRun(first, first + len(values) - 1, body, tuple(values))


def over(station: FoldableStation, run: ValueRun) -> Iterator[tuple[ValueRun, str]]:
    """The same with each set that has its values; or its beginning, where a set has only those."""
    for length in range(len(run.values), 1, -1):
        values = run.values[:length]
        if domains := station.with_values(values):
            yield from ((ValueRun(run.first, run.first + length - 1, run.body, values), each) for each in domains)
            return
    if len(run.values) >= _FEWEST_IN_BRACES:
        yield run, f"{{{', '.join(run.values)}}}"


def is_membership(body: Expression) -> bool:
    """Return whether no more is said than that something is the value, or is not."""
    match body:
        case Comparison("==" | "!=", left, right):
            return right == _THE_VALUE and left != _THE_VALUE and NAME not in words_of(left)
    return False


def quantified(is_all: bool, body: Expression, domain: str, word: str) -> str:
    """`body` for all values of a set, or for any, with a word for the value."""
    quantifier = "all" if is_all else "any"
    if is_all and isinstance(body, Not):
        quantifier, body = "none", body.operand
    return f"{quantifier} {word} in {domain}: {print_expression(with_word(body, NAME, word))}"


def words_for(station: FoldableStation, body: Expression, domain: str) -> Iterator[str]:
    """Words for the value that `body` is about, the one first that the declaration has of what is indexed by it."""
    return (word for word in _words_for(station, body, domain) if word not in RESERVED)


def _words_for(station: FoldableStation, body: Expression, domain: str) -> Iterator[str]:
    for name in names_in(body):
        for part in name.path:
            for index, argument in enumerate(part.arguments):
                for full, words in station.indices.items() if argument == NAME else ():
                    if full.rpartition(".")[2] == part.name and index < len(words):
                        yield words[index]
    if domain.isidentifier():
        if "_" in domain:
            yield domain.rpartition("_")[2]
        yield domain[0]
    yield from ("each", "one", "value")


def quantifier_proposals(station: FoldableStation) -> Iterator[FoldProposal]:
    """A proposal for each thing that is said of all values of a set, or of any, wherever that is."""
    groups: dict[tuple[bool, str, str], list[Rewriting]] = defaultdict(list)
    for text in station.texts:
        for node in text.nodes:
            if not isinstance(node, And | Or):
                continue
            for run in runs(station, node):
                for part, domain in over(station, run):
                    if is_membership(part.body):
                        continue
                    written = _written(station, text, node, part, domain)
                    if written is not None:
                        groups[isinstance(node, And), print_expression(part.body), domain].append(written)
    for parts in groups.values():
        found = apart(parts)
        yield FoldProposal(FoldKind.QUANTIFIER, f"Write `{found[0].now.strip('()')}`", found)


def _written(
    station: FoldableStation, text: FoldableText, node: And | Or, run: ValueRun, domain: str
) -> Rewriting | None:
    span = text.of_operands(node, run.first, run.last)
    for word in dict.fromkeys(words_for(station, run.body, domain)):
        found = part_of(text, span, quantified(isinstance(node, And), run.body, domain, word))
        if word not in station.every_value and station.is_right(text, with_replacements([found])):
            return found
    return None
