"""Search for the fewest operator acts that let production, or an operation of an idle station, proceed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator
from itertools import islice

from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import Plan
from sequence_planner.planning.recovery.consultation import RecoverySearch
from sequence_planner.planning.recovery.proposals import (
    LIKELY,
    MOST_ACTS,
    PASSING,
    Act,
    ActKind,
    Acts,
    Changes,
    OfferKind,
    RecoveryProposal,
    is_possible,
    kind_of,
    returns,
    sets,
)
from sequence_planner.planning.recovery.request import Pairing, RecoverySituation

# Where nothing is asked of a station: what has to come back so that an operation can begin.


def beginnings(
    consultation: RecoverySearch,
    changes: Changes,
    acts: Collection[Act],
    waiting: Goals,
    impossible: frozenset[Pairing],
) -> Iterator[RecoveryProposal]:
    """The returns among `acts` after which some of the operations with the goals `waiting` become active and can be
    completed: of each set of resources the most plausible one, and of those that need another no larger one.
    """
    back = [act for act in acts if act.kind is ActKind.RETURN]
    found: list[frozenset[str]] = []
    for size in range(1, MOST_ACTS + 1):
        for each in sets(back, size):
            resources = frozenset(act.name for act in each)
            if not any(fewer <= resources for fewer in found):
                offer = _offer(consultation, changes, each, waiting, impossible)
                if offer is not None:
                    found.append(resources)
                    yield offer


def _offer(
    consultation: RecoverySearch, changes: Changes, acts: Acts, waiting: Goals, impossible: frozenset[Pairing]
) -> RecoveryProposal | None:
    after = changes.applied(consultation.here, acts)
    after = replace(after, goals=_begun(consultation, after, waiting))
    prover = consultation.prover
    if not after.goals or not is_possible(consultation.here, after, impossible) or not prover.is_safe(after.state):
        return None
    plan = consultation.find(after.production()).plan
    if plan is not None:
        return consultation.making.offer(OfferKind.PHYSICAL, after, plan, acts, begun=after.goals)
    if (some := consultation.some(after)) is None or not some[2].goals:
        return None
    plan, left_out, _ = some
    return consultation.making.offer(OfferKind.PHYSICAL, after, plan, acts, left_out=left_out, begun=after.goals)


def _begun(consultation: RecoverySearch, after: RecoverySituation, waiting: Goals) -> Goals:
    """The goals of the operations that are active then."""
    operations, state = consultation.prover.automaton.operations, after.state
    return tuple(
        goal
        for goal in waiting
        if holds(operations[goal.name].precondition, state) and evaluate(goal.predicate, state) is False
    )


# The search for the fewest acts of a person after which production goes on towards all goals.

MOST_OFFERS = 5  # of one kind

_AT_A_TIME = 100  # sets of acts that are looked at before plans are looked for
_FIRST, _SECOND = 0.2, 0.5  # of the time that is left, for one plan
_MOST_COMBINED = 2


class _Changed(Immutable):
    acts: Acts
    kind: OfferKind
    after: RecoverySituation

    @property
    def way(self) -> _Way:
        return _way(self.acts)


# What is looked for until some of it is found. That a resource comes back is a way of its own: it repairs what is
# wrong, where an act elsewhere may only help over the next step.
_Way = tuple[OfferKind, bool]


def _way(acts: Acts) -> _Way:
    return kind_of(acts), returns(acts)


def _passes(acts: Acts) -> bool:
    return any(act.rank == PASSING for act in acts)


def _is_told(acts: Acts) -> bool:
    """Return whether devices tell all of it themselves."""
    return all(act.kind is ActKind.DEVICE for act in acts)


class FewestActs:
    """Looks for offers by acts, in the order of their number. Corrections alone, acts at devices alone and both
    together, each with and without a resource that comes back, are looked for until some are found; those that only
    say that work is done do not count. Where it is enough to help a device that does nothing, or to bring a resource
    back, only what is plausible is looked for at other devices; and what would not stay where nothing else helps.
    """

    def __init__(
        self,
        consultation: RecoverySearch,
        changes: Changes,
        impossible: frozenset[Pairing],
        most: int = MOST_OFFERS,
    ) -> None:
        self._consultation = consultation
        self._changes = changes
        self._impossible = impossible
        self._most = most
        self._repaired = False  # what is known to be wrong, by one of the acts that were offered
        self._enough: set[_Way] = set()
        self._found: list[frozenset[Act]] = []
        self._number: Counter[_Way] = Counter()

    def likely(self, acts: list[Act]) -> Iterator[RecoveryProposal]:
        """Offers by the most plausible acts, one at a time; what a person does in place of the station also where the
        devices have to be brought back besides.
        """
        changed = list(self._changed([act for act in acts if act.rank <= LIKELY], 1))
        dead: list[_Changed] = []
        yield from self._tried(changed, dead, [])
        yield from self._combined([each for each in dead if each.acts[0].kind is ActKind.TASK])

    def offers(self, acts: list[Act]) -> Iterator[RecoveryProposal]:
        """Offers by the acts; those of one thing less come first."""
        for size in range(1, MOST_ACTS + 1):
            dead: list[_Changed] = []
            late: list[_Changed] = []
            changed = self._changed(acts, size)
            while some := list(islice(changed, _AT_A_TIME)):
                yield from self._tried(some, dead, late)
            yield from self._tried(late, dead, None)
            self._enough.update(way for way, number in self._number.items() if number)
            yield from self._combined(dead)

    def _changed(self, acts: list[Act], size: int) -> Iterator[_Changed]:
        """All sets of so many acts that may be worth while, each with where it leads."""
        consultation = self._consultation
        for each in sets(acts, size):
            kind = kind_of(each)
            needless = _way(each) in self._enough or (kind is OfferKind.COMBINED and consultation.helped)
            needless = needless or (self._repaired and self._is_elsewhere(each)) or self._is_passing(each)
            if needless or any(found.issubset(each) for found in self._found):
                continue
            consultation.budget.require()
            after = self._changes.applied(consultation.here, each)
            if is_possible(consultation.here, after, self._impossible):
                yield _Changed(each, kind, after)

    def _tried(
        self, some: list[_Changed], dead: list[_Changed], late: list[_Changed] | None
    ) -> Iterator[RecoveryProposal]:
        """Offers of those that have a plan; what costs no time goes first. Some are `dead`, some have to be tried once
        more, `late`; without a list for these it is the last time.
        """
        consultation, prover = self._consultation, self._consultation.prover
        planned: list[_Changed] = []
        for each in some:
            task = each.after.production()
            knowing = prover.counting if self._helps(each) else prover
            is_safe = prover.is_safe_when_seen if _is_told(each.acts) else prover.is_safe
            if not is_safe(each.after.state) or knowing.is_refuted(task):
                dead.append(each)
            elif consultation.here.goals and not task.goals and not _passes(each.acts):
                yield self._offer(each, consultation.find(task).plan)
            else:
                planned.append(each)
        for each in planned:
            if each.way in self._enough or self._is_given(each) or self._is_passing(each.acts):
                continue
            share, last, helped = (_SECOND if late is None else _FIRST), late is None, self._helps(each)
            finding = consultation.find(each.after.production(), share, last=last, helped=helped)
            if finding.plan is not None:
                yield self._offer(each, finding.plan)
            elif finding.refuted:
                dead.append(each)
            elif late is not None:
                late.append(each)

    def _helps(self, each: _Changed) -> bool:
        """Return whether a person has done what a device should have done by itself."""
        acts = (act for act in each.acts if act.kind is ActKind.DEVICE)
        return any(name in self._consultation.awaited for act in acts for name, _ in act.values)

    def _is_elsewhere(self, acts: Acts) -> bool:
        """Return whether it is done at devices of which nothing is known to be wrong, nor about to happen."""
        return any(act.kind is ActKind.DEVICE and (act.rank > LIKELY or len(acts) > 1) for act in acts)

    def _is_passing(self, acts: Acts) -> bool:
        """Return whether it would not stay, and there is something that does."""
        return _passes(acts) and self._number[_way(acts)] > 0

    def _offer(self, each: _Changed, plan: Plan | None) -> RecoveryProposal:
        self._found.append(frozenset(each.acts))
        offer = self._consultation.making.offer(each.kind, each.after, plan, each.acts)
        if not offer.only_if_checked:
            self._consultation.has_helped(elsewhere=offer.effort.elsewhere > 0)
            self._repaired = self._repaired or self._helps(each) or returns(each.acts)
            self._number[each.way] += 1
            if self._number[each.way] >= self._most:
                self._enough.add(each.way)
        return offer

    def _is_given(self, each: _Changed) -> bool:
        """Return whether an offer found meanwhile asks for less, or for the same in other words."""
        about = {(act.kind, act.name, dict(act.values).get(act.name)) for act in each.acts}
        return any({(act.kind, act.name, dict(act.values).get(act.name)) for act in f} <= about for f in self._found)

    def _combined(self, dead: list[_Changed]) -> Iterator[RecoveryProposal]:
        """Yield, where nothing has helped so far, a manual plan after the acts."""
        number = 0
        for each in dead:
            if self._consultation.helped and number in (0, _MOST_COMBINED):
                return
            for offer in self._consultation.by_manual_plans_after(each.acts, each.after):
                number += 1
                yield offer
                break
