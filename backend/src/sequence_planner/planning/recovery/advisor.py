"""Restart advisor: proven recovery proposals, as the main loop of a killable process."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable, Iterator
from functools import partial

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.core.immutable import replace
from sequence_planner.planning.diagnosis import Diagnosis
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import ORDINARY
from sequence_planner.planning.recovery.consultation import RecoverySearch, WarmStation
from sequence_planner.planning.recovery.manual_plans import Stall, only_written, stalling, stalls, written_by
from sequence_planner.planning.recovery.proposals import Advice, Changes, OfferKind, Options, RecoveryProposal
from sequence_planner.planning.recovery.prover import Prover
from sequence_planner.planning.recovery.request import AdviceRequest, GoalPlanRequest, RecoverySituation
from sequence_planner.planning.recovery.search import MOST_OFFERS, FewestActs, beginnings
from sequence_planner.planning.recovery_path import WaysBack
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget, SpentError

# The restart advisor: proven ways back to work, what is done before what is only said.

Explain = Callable[[PlanningTask, Budget], Diagnosis]

_SHARE = 0.85  # of the time, for offers; if there is none, reasons have the rest
_LEAST = 0.4  # of it, however late work on a question begins
_PREPARING = 10.0  # seconds
_MOST_KEPT = 3  # stations with and without stalled effects


class Advisor:
    """Advises one station under one supervisor, warm from question to question.

    `explain` says why there is no plan, when nothing can be offered; `most` is how many offers of one kind there are.
    """

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        explain: Explain | None = None,
        most: int = MOST_OFFERS,
    ) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._explain = explain
        self._most = most
        self._changes = Changes(automaton)
        self._kept: OrderedDict[frozenset[Stall], WarmStation] = OrderedDict()

    def prepare(self) -> None:
        """Make what the first question needs."""
        station = self._station()
        station.prover.prepare()
        station.ways.way(initial_state(self._automaton), ORDINARY, 1, Budget.seconds(_PREPARING))

    def advise(self, request: AdviceRequest, budget: Budget | None = None) -> Advice:
        """Offers until the deadline. `budget` can be called off from another thread."""
        began = time.monotonic()
        budget = (budget or Budget.seconds(request.deadline)).part(_share_left(request, began))
        here = self._situation(request)
        station = self._station(stalls(self._automaton, here.state, request.stalled))
        awaited = written_by(self._automaton, request.stalled - request.explained)
        consultation = RecoverySearch(
            station, here, budget.part(_SHARE), request.violated, awaited, patient=request.patient
        )

        def search() -> Iterator[RecoveryProposal]:
            right = written_by(self._automaton, request.explained) - awaited
            aside = only_written(self._automaton, request.stalled) | right
            options = partial(station.options.acts, here, request.last, request.fixed, aside, request.answered)
            if not here.goals and request.waiting:
                begins = [*beginnings(consultation, self._changes, options(), request.waiting, request.impossible)]
                if begins:  # else nothing would be wrong with waiting for good
                    yield from begins
                    return
            yield from consultation.as_it_is()
            acts = [] if consultation.goes_on else options()
            fewest = FewestActs(consultation, self._changes, request.impossible, self._most)
            yield from fewest.likely(acts)
            yield from consultation.without_some()
            yield from consultation.by_manual_plans()
            yield from consultation.by_resets()
            yield from fewest.offers(acts)
            if not consultation.helped:
                yield from consultation.without_goals()

        offers = self._gathered(consultation, search())
        return self._advice(consultation, offers, here, budget, began)

    def goal_plan(self, request: GoalPlanRequest, budget: Budget | None = None) -> Advice:
        """The manual plan that is asked for, if there is one, with a plan from its end where that was found."""
        began = time.monotonic()
        budget = budget or Budget.seconds(request.deadline)
        here = self._situation(request)
        station = self._station(stalls(self._automaton, here.state, request.stalled))
        consultation = RecoverySearch(station, here, budget.part(_SHARE), request.violated)
        kind = OfferKind.GOAL if request.operation is None else OfferKind.RESET

        def search() -> Iterator[RecoveryProposal]:
            for manual in consultation.asked(request.target, request.operation, request.circumstances.restart):
                then = None
                try:
                    then = consultation.find(manual.end.production()).plan
                except SpentError:
                    consultation.undecided = True
                left_out = manual.end.goals if then is None else ()
                yield consultation.making.offer(
                    kind, manual.end, then, manual=manual, operation=request.operation, left_out=left_out
                )

        offers = self._gathered(consultation, search())
        return self._advice(consultation, offers, here, budget, began)

    def _gathered(self, consultation: RecoverySearch, search: Iterator[RecoveryProposal]) -> list[RecoveryProposal]:
        offers: list[RecoveryProposal] = []
        try:
            for offer in search:
                offers.append(offer)
        except SpentError:
            consultation.undecided = True
        return offers

    def _advice(
        self,
        consultation: RecoverySearch,
        offers: list[RecoveryProposal],
        here: RecoverySituation,
        budget: Budget,
        began: float,
    ) -> Advice:
        reasons = None
        if all(offer.only_if_checked for offer in offers) and self._explain is not None and not budget.spent:
            reasons = self._explain(here.production(), budget)
        ranked = tuple(sorted(offers, key=lambda offer: offer.rank))
        return Advice(ranked, reasons, not consultation.undecided, time.monotonic() - began)

    def _situation(self, request: AdviceRequest | GoalPlanRequest) -> RecoverySituation:
        state = synchronise(self._automaton, request.state)
        circumstances = replace(request.circumstances, restart=False)
        return RecoverySituation(state, missing(request.goals, state), circumstances, request.longest)

    def _station(self, stalled: frozenset[Stall] = frozenset()) -> WarmStation:
        """One that does not count on what is stalled."""
        if stalled not in self._kept:
            automaton = stalling(self._automaton, stalled) if stalled else self._automaton
            prover = Prover(automaton, self._supervisor, self._station().prover if stalled else None)
            ways = WaysBack(automaton, self._supervisor.safe)
            options = Options(automaton, self._automaton.effects)
            self._kept[stalled] = WarmStation(prover, ways, options, self._changes)
            if len(self._kept) > _MOST_KEPT:
                self._kept.pop(next(each for each in self._kept if each))
        self._kept.move_to_end(stalled)
        return self._kept[stalled]


def _share_left(request: AdviceRequest, now: float) -> float:
    """The share of the time that is left for a question on which work begins late."""
    late = now + request.deadline - request.until
    if late <= 0.0:
        return 1.0
    return max(1.0 - late / request.deadline, _LEAST) if request.deadline else _LEAST
