"""The order of operations: what is done before what, what says so, and who does it.

Three things put operations into an order: sequences, the steps of work masters, and preconditions that the goals of
others make true. It is for people to look at: what may really be active is decided by preconditions alone.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from enum import StrEnum
from itertools import product
from math import prod
from typing import NamedTuple

from sequence_planner.automaton.automaton import Ability, Automaton, Operation, target
from sequence_planner.automaton.dependencies import reactions
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import Assignment, Expression, conjuncts, occurrences
from sequence_planner.language.types import Value

MOST_ENDS = 4096
"""Of a goal that more valuations fulfil it is not said what it makes true."""


class LinkKind(StrEnum):
    """What puts two operations into an order."""

    SEQUENCE = "sequence"
    WORK_MASTER = "work_master"
    CONDITION = "condition"
    """The goal of the one makes true what the other begins with."""
    CHANCE = "chance"
    """The goal of the one can make it true, and that of no other is sure to."""


class OperationReason(Immutable):
    """What says that an operation comes after another: the name of a sequence or work master, or a condition."""

    kind: LinkKind
    name: str = ""
    condition: Expression | None = None


class OperationLink(Immutable):
    """That `after` waits for `before`. With `again` it does for what was done in the round before this one: all links
    that are not so make no circle.
    """

    before: str
    after: str
    reasons: tuple[OperationReason, ...]
    again: bool = False


def links_of(automaton: Automaton) -> tuple[OperationLink, ...]:
    """The order of all operations. What follows from other links by way of a third operation is left out, unless a
    sequence says it.
    """
    needs = [*_needs(automaton)]
    sure = _Order()
    for before, after, reason in _written(automaton):
        sure.link(before, after, reason)
    for need in needs:
        if need.reason.kind is LinkKind.CONDITION:
            for before in need.makers:
                sure.link(before, need.operation, need.reason)
    order = _Order()
    for before, after, reason in _written(automaton):
        order.link(before, after, reason)
    for need in needs:
        # What has been made true by an operation before is not made true by this one.
        for before in need.makers:
            if not any(sure.reaches(other, before) for other in need.makers if other != before):
                order.link(before, need.operation, need.reason)
    return tuple(order.links())


class _Order:
    """Links by what they link; those that are not `again` make no circle."""

    def __init__(self) -> None:
        self._reasons: dict[tuple[str, str], list[OperationReason]] = {}
        self._again: set[tuple[str, str]] = set()
        self._ahead: dict[str, dict[str, None]] = {}
        self._surely: dict[str, dict[str, None]] = {}

    def link(self, before: str, after: str, reason: OperationReason) -> None:
        """Add a reason. What is written comes first, and what is sure next: of a circle the weakest goes back."""
        link = before, after
        if link not in self._reasons and _reaches(self._ahead, after, before):
            self._again.add(link)
        self._reasons.setdefault(link, []).append(reason)
        if link not in self._again:
            self._ahead.setdefault(before, {})[after] = None
            if reason.kind is not LinkKind.CHANCE:
                self._surely.setdefault(before, {})[after] = None

    def reaches(self, before: str, after: str) -> bool:
        """Whether the one surely comes after the other."""
        return _reaches(self._surely, before, after)

    def links(self) -> Iterator[OperationLink]:
        """The links that say something."""
        for (before, after), reasons in self._reasons.items():
            is_again = (before, after) in self._again
            kinds = {each.kind for each in reasons}
            steps = (each for each in self._surely.get(before, ()) if each != after)
            if LinkKind.SEQUENCE in kinds or (is_again and kinds != {LinkKind.CHANCE}):
                yield OperationLink(before, after, tuple(reasons), is_again)
            elif not is_again and not any(self.reaches(step, after) for step in steps):
                yield OperationLink(before, after, tuple(reasons))


def _reaches(ahead: Mapping[str, Iterable[str]], start: str, end: str) -> bool:
    pending, seen = [start], {start}
    while pending:
        if (each := pending.pop()) == end:
            return True
        new = set(ahead.get(each, ())) - seen
        seen |= new
        pending += new
    return False


def _written(automaton: Automaton) -> Iterator[tuple[str, str, OperationReason]]:
    for name, operation in automaton.operations.items():
        for sequence, turn in operation.turns.items():
            for before in turn.after:
                yield before, name, OperationReason(LinkKind.SEQUENCE, sequence)
    for master in automaton.work_masters.values():
        for name, befores in master.operations.items():
            for before in sorted(befores):
                yield before, name, OperationReason(LinkKind.WORK_MASTER, master.name)


class _Need(NamedTuple):
    """A part of an operation's precondition, and the operations whose goals make it true, or can."""

    operation: str
    reason: OperationReason
    makers: tuple[str, ...]


class _End(NamedTuple):
    """A goal: the variables that it reads, and how it can be fulfilled."""

    reads: tuple[str, ...]
    valuations: tuple[Mapping[str, Value], ...]


def _needs(automaton: Automaton) -> list[_Need]:
    """What conditions say, what is sure first. What holds at first needs nobody who makes it true."""
    ends = {name: _end(operation.goal) for name, operation in automaton.operations.items()}
    bearing: dict[str, dict[str, None]] = {}
    for name, end in ends.items():
        for read in end.reads:
            bearing.setdefault(read, {})[name] = None
    initial = automaton.initial_valuation
    found = []
    for name, operation in automaton.operations.items():
        for part in conjuncts(operation.written or operation.precondition):
            reads = dict.fromkeys(each.name for each in occurrences(part))
            if not reads.keys() <= initial.keys() or evaluate(part, initial) is True:
                continue
            others = dict.fromkeys(other for read in reads for other in bearing.get(read, ()) if other != name)
            made = {other: [*_truths(part, reads, ends[other])] for other in others}
            sure = [other for other, truths in made.items() if truths and all(each is True for each in truths)]
            makers = sure or [other for other, truths in made.items() if True in truths]
            kind = LinkKind.CONDITION if sure else LinkKind.CHANCE
            found.append(_Need(name, OperationReason(kind, condition=part), tuple(makers)))
    return sorted(found, key=lambda need: need.reason.kind is LinkKind.CHANCE)


def _end(goal: Expression) -> _End:
    types = {each.name: each.type for each in occurrences(goal)}
    if prod(len(type_.domain) for type_ in types.values()) > MOST_ENDS:
        return _End((), ())
    domains = product(*(each.domain for each in types.values()))
    valuations = (dict(zip(types, values, strict=True)) for values in domains)
    return _End(tuple(types), tuple(each for each in valuations if evaluate(goal, each) is True))


def _truths(part: Expression, reads: Iterable[str], end: _End) -> Iterator[Value | None]:
    """Whether the part holds, by how the goal is fulfilled; None where that is not all that it depends on."""
    unknown: dict[str, Value | None] = dict.fromkeys(reads)
    return (evaluate(part, {**unknown, **valuation}) for valuation in end.valuations)


# Who does what.


def lanes_of(automaton: Automaton) -> dict[str, str | None]:
    """By operation, the resource whose abilities bring about its goal; None is the station. Of several it is the first
    that needs nothing to have gone wrong.
    """
    writers: dict[str, list[tuple[Ability, Assignment]]] = {}
    usually = {target(action) for effect in automaton.effects if not effect.fault for action in effect.actions}
    for ability in automaton.abilities.values():
        actions = [*ability.start_actions, *ability.finish_actions]
        usually.update(map(target, actions))
        for effect in reactions(automaton, ability.name):
            actions += effect.actions
        for action in actions:
            writers.setdefault(target(action), []).append((ability, action))
    found = {}
    for name, operation in automaton.operations.items():
        read = dict.fromkeys(each.name for each in occurrences(operation.goal) if each.name in automaton.variables)
        serving = [
            ability
            for each in read
            for ability, action in writers.get(each, ())
            if _may_serve(automaton, operation, ability, action)
        ]
        serving.sort(key=lambda ability: not _is_usual(automaton, ability, usually))
        owners = (automaton.variables[each].resource for each in read)
        found[name] = serving[0].resource if serving else next((owner for owner in owners if owner is not None), None)
    return found


def _is_usual(automaton: Automaton, ability: Ability, written: Collection[str]) -> bool:
    """Whether what it needs is so at first, or is made so by what is `written`."""
    return all(
        evaluate(part, automaton.initial_valuation) is True or any(each.name in written for each in occurrences(part))
        for part in conjuncts(ability.enabled)
        if all(each.name in automaton.variables for each in occurrences(part))
    )


def _may_serve(automaton: Automaton, operation: Operation, ability: Ability, action: Assignment) -> bool:
    """Whether a run that begins as the operation does can end as the operation is to end, by this variable alone."""
    name = target(action)
    begins = (operation.precondition, ability.enabled, *([] if action.condition is None else [action.condition]))
    after = evaluate(action.value, dict.fromkeys(each.name for each in occurrences(action.value)))
    is_possible = any(
        all(_possible(condition, name, value) for condition in begins)
        for value in automaton.variables[name].type.domain
    )
    return is_possible and (after is None or _possible(operation.goal, name, after))


def _possible(condition: Expression, name: str, value: Value) -> bool:
    unknown: dict[str, Value | None] = dict.fromkeys(each.name for each in occurrences(condition))
    return evaluate(condition, {**unknown, name: value}) is not False
