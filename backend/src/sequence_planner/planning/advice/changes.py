"""The fewest acts of a person after which production goes on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import combinations

from sequence_planner.automaton.structure import Automaton, Flag
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import replace
from sequence_planner.planning.advice.offer import OfferKind
from sequence_planner.planning.advice.options import Act, ActKind
from sequence_planner.planning.advice.request import Pairing
from sequence_planner.planning.advice.situation import Situation
from sequence_planner.planning.replaying.replay import missing
from sequence_planner.planning.sat.following import Following

MOST_ACTS = 2

Acts = tuple[Act, ...]


class Changes:
    """What situations acts lead to at one station."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._flags = Following(automaton)
        self._following = lru_cache(1000)(self._flags_of)

    def applied(self, here: Situation, acts: Iterable[Act]) -> Situation:
        """The situation after the acts; that before was synchronised."""
        values: dict[str, Value] = {}
        circumstances = here.circumstances
        for act in acts:
            values |= dict(act.values)
            if act.kind is ActKind.RETURN:
                circumstances = replace(circumstances, offline=circumstances.offline - {act.name})
            elif act.kind is ActKind.SERVICE:
                circumstances = replace(circumstances, barred=circumstances.barred - {act.name})
        state = {**here.state, **values}
        for flag in self._following(frozenset(values)):
            truth = evaluate(flag.predicate, state)
            if truth is not None:
                state[flag.name] = truth
        return replace(here, state=state, goals=missing(here.goals, state), circumstances=circumstances)

    def _flags_of(self, names: frozenset[str]) -> tuple[Flag, ...]:
        return tuple(self._flags.flags(names))


def kind_of(acts: Iterable[Act]) -> OfferKind:
    """What an offer of nothing but these acts is."""
    estimates = {act.kind is ActKind.ESTIMATE for act in acts}
    if len(estimates) == 2:
        return OfferKind.COMBINED
    return OfferKind.CORRECTION if True in estimates else OfferKind.PHYSICAL


def returns(acts: Iterable[Act]) -> bool:
    """Whether a resource comes back."""
    return any(act.kind is ActKind.RETURN for act in acts)


def sets(acts: Sequence[Act], size: int) -> Iterator[Acts]:
    """All sets of so many acts that do not get in each other's way, the most plausible first: those by which a resource
    comes back, since that one is known to be away.
    """

    def plausible(each: Acts) -> tuple[bool, int]:
        return not returns(each), sum(act.rank for act in each)

    chosen = combinations(acts, size)
    for each in sorted(chosen, key=plausible) if size > 1 else chosen:
        names = [name for act in each for name, _ in act.values]
        if len(set(names)) == len(names) and len({(act.kind, act.name) for act in each}) == size:
            yield each


def is_possible(here: Situation, after: Situation, impossible: frozenset[Pairing]) -> bool:
    """Whether no pair of values comes together that never does, unless it is so already."""

    def together(situation: Situation) -> frozenset[Pairing]:
        state = situation.state
        return frozenset(p for p in impossible if state[p[0]] == p[1] and state[p[2]] == p[3])

    return not impossible or together(after) <= together(here)
