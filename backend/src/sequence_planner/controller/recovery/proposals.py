"""Plans that people may take: asked of the advisor, shown with all that they contain, and kept until the state moves.

An offer belongs to the state it was made for. Whoever takes it repeats what it contains, as a second confirmation; as
soon as anything has changed at the station it is refused, and has to be asked for again.
"""

from __future__ import annotations

import asyncio
import itertools
import secrets
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

from sequence_planner.controller.commands.command import CommandRefused, answers, handles
from sequence_planner.controller.commands.queries import AskAdvice, AskGoal, AskReset
from sequence_planner.controller.commands.recovery import CorrectEstimates, ExecuteOperatorPlan
from sequence_planner.controller.io.inputs import LastKnown
from sequence_planner.controller.planner_client import AIMED_WITHIN, GOAL, WAITING, AdvisorClient, GoalPlan, aim
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.controller.views.proposals import AdviceView, OfferView
from sequence_planner.controller.views.wording import (
    diagnosis_view,
    offer_title,
    offer_view,
    plan_running,
    read_predicate,
    refusal_of,
)
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import OperatorPlan, OperatorPlanKind
from sequence_planner.execution.timeouts import overdue
from sequence_planner.execution.vocabulary import Mode, Production, ServiceKind
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import Expression
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import goals_of
from sequence_planner.planning.recovery.manual_plans import stalled_effects
from sequence_planner.planning.recovery.proposals import Advice, OfferKind, RecoveryProposal
from sequence_planner.planning.recovery.request import AdviceRequest, GoalPlanRequest, Pairing
from sequence_planner.texts.message import joined, message

LONGER = 5.0  # seconds for advice where less was too little
MOST_KEPT = 64  # offers; older ones are gone


@dataclass(frozen=True)
class _Kept:
    offer: RecoveryProposal
    revision: int


@dataclass(frozen=True)
class _Asked:
    of: tuple[int, AdviceRequest]
    answer: asyncio.Future[AdviceView]


@dataclass(frozen=True)
class _Advised:
    """All that has been found for a request so far, and how it was shown last."""

    request: AdviceRequest
    advice: Advice
    view: AdviceView


class Offers:
    """Asks for offers about `execution`, and carries out those that are taken; `correct` makes their corrections.

    `impossible` says which values of estimates cannot go together with which of other variables, and `still` which
    devices do nothing: what alarms tell, nobody counts on.
    """

    def __init__(
        self,
        execution: Executor,
        advisor: AdvisorClient,
        correct: Callable[[CorrectEstimates, Timestamp], None],
        impossible: Callable[[], frozenset[Pairing]],
        still: StallDetector,
    ) -> None:
        self._execution = execution
        self._advisor = advisor
        self._correct = correct
        self._impossible = impossible
        self._last_known = LastKnown(execution)
        self._still = still
        self._kept: dict[str, _Kept] = {}
        self._life = secrets.token_hex(3)  # no offer is taken for one of an earlier life of the controller
        self._numbers = itertools.count(1)
        self._asked: _Asked | None = None
        self._advised: _Advised | None = None

    @answers(AskAdvice)
    async def advice(self, query: AskAdvice) -> AdviceView:
        """Ways on from the present state. Raises `CommandRefused`."""
        self._require_no_operator_plan()
        execution, revision = self._execution, self._execution.revision
        request = AdviceRequest(
            state=execution.state,
            goals=hopeful_goals(execution),
            violated=violated_goals(execution),
            circumstances=execution.circumstances,
            stalled=self._stalled(),
            explained=self._still.explained_effects(Timestamp.now().monotonic),
            last=self._last_known.values,
            impossible=self._impossible(),
            fixed=frozenset(execution.conduct.forces) | execution.conduct.answers.keys(),
            waiting=_waiting_goals(execution),
            answered=frozenset(execution.conduct.answers.keys() - execution.conduct.forces),
        )
        if self._asked is None or self._asked.of != (revision, request) or self._asked.answer.done():
            of = revision, request
            self._asked = _Asked(of, asyncio.ensure_future(self._found(revision, request)))
        # Whoever asks the same meanwhile waits for the same answer; one who leaves takes it from nobody.
        return await asyncio.shield(self._asked.answer)

    async def _found(self, revision: int, request: AdviceRequest) -> AdviceView:
        before = self._advised if self._advised is not None and self._advised.request == request else None
        if before is None:
            advice = await self._searched(request, request.deadline)
        elif before.advice.complete:
            if before.view.revision == revision and self._are_kept(before.view):
                return before.view
            advice = before.advice  # only the mode is another: what leads on from here is the same
        else:
            advice = await self._searched_on(request, before.advice)
        self._advised = _Advised(request, advice, self._shown(advice, revision, request))
        return self._advised.view

    async def _searched(self, request: AdviceRequest, deadline: float) -> Advice:
        until = Timestamp.now().monotonic + deadline
        asked = replace(request, deadline=deadline, until=until, patient=deadline > request.deadline)
        return await self._advisor.answer(asked, deadline + WAITING)

    async def _searched_on(self, request: AdviceRequest, before: Advice) -> Advice:
        """Search again with more time. What was found `before` still leads on, also where less is found now."""
        try:
            advice = await self._searched(request, LONGER)
        except CommandRefused:
            if before.offers:
                return before
            raise
        if advice.complete:
            return advice
        again = {_meaning(offer) for offer in advice.offers}
        offers = (*advice.offers, *(offer for offer in before.offers if _meaning(offer) not in again))
        reasons = advice.reasons if all(offer.only_if_checked for offer in offers) else None
        return replace(advice, offers=tuple(sorted(offers, key=lambda offer: offer.rank)), reasons=reasons)

    def _shown(self, advice: Advice, revision: int, request: AdviceRequest) -> AdviceView:
        kept = self._keep(advice.offers, revision)
        reasons = advice.reasons
        return AdviceView(
            revision=revision,
            offers=[offer for offer in kept if not offer.only_if_checked],
            if_checked=[offer for offer in kept if offer.only_if_checked],
            reasons=None
            if reasons is None
            else diagnosis_view(self._execution.automaton, reasons, self._unused, request.fixed),
            complete=advice.complete,
            seconds=advice.seconds,
        )

    def _are_kept(self, view: AdviceView) -> bool:
        return all(offer.id in self._kept for offer in (*view.offers, *view.if_checked))

    @answers(AskGoal)
    async def goal(self, query: AskGoal) -> OfferView:
        """A plan to whatever an engineer wants to hold. Raises `CommandRefused`."""
        target = read_predicate(self._execution.automaton, query.predicate)
        if holds(target, self._execution.state):
            raise CommandRefused("goal-holds", message("refused.goal-holds.nothing"))
        return await self._offered(target, None)

    @answers(AskReset)
    async def reset(self, query: AskReset) -> OfferView:
        """A plan to the precondition of an operation. Raises `CommandRefused`."""
        found = self._execution.automaton.operations.get(query.operation)
        if found is None:
            raise CommandRefused(
                "unknown-operation", message("refused.unknown-operation.those", name=query.operation), 404
            )
        return await self._offered(found.precondition, query.operation)

    async def _offered(self, target: Expression, operation: str | None) -> OfferView:
        self._require_no_operator_plan()
        execution, revision = self._execution, self._execution.revision
        request = GoalPlanRequest(
            state=execution.state,
            goals=hopeful_goals(execution),
            violated=violated_goals(execution),
            target=target,
            operation=operation,
            circumstances=replace(execution.circumstances, restart=execution.mode is Mode.RESTART),
            stalled=self._stalled(),
            deadline=AIMED_WITHIN,
        )
        aimed = await aim(self._advisor, request)
        if aimed.offer is None:
            raise _no_plan(self._execution, aimed, self._unused)
        (view,) = self._keep((aimed.offer,), revision)
        return view

    @handles(ExecuteOperatorPlan)
    def take(self, command: ExecuteOperatorPlan, moment: Timestamp) -> None:
        """Make the corrections of an offer and have its plan carried out."""
        kept = self._kept.get(command.offer)
        if kept is None:
            raise CommandRefused("proposal-gone", message("refused.proposal-gone.ask"))
        offer, execution = kept.offer, self._execution
        if execution.revision != kept.revision:
            raise CommandRefused("stale-revision", message("refused.stale-revision.offered"))
        if (refusal := refusal_of(offer, execution)) is not None:
            raise refusal
        _require_confirmation(offer, command)
        if offer.corrections:
            values = {change.name: change.new for change in offer.corrections}
            correcting = CorrectEstimates(
                actor=command.actor, reason=command.reason, values=values, revision=kept.revision
            )
            self._correct(correcting, moment)
        if offer.operator_plan is not None:
            execution.start_operator_plan(self._operator_plan(offer, command, moment), moment)

    def _operator_plan(self, offer: RecoveryProposal, command: ExecuteOperatorPlan, moment: Timestamp) -> OperatorPlan:
        assert offer.operator_plan is not None
        kind = {OfferKind.RESET: OperatorPlanKind.RESET, OfferKind.GOAL: OperatorPlanKind.GOAL}
        return OperatorPlan(
            kind=kind.get(offer.kind, OperatorPlanKind.WAY_BACK),
            title=offer_title(self._execution.automaton, offer),
            plan=offer.operator_plan,
            goal=offer.goal,
            restart=offer.restart or offer.unsupervised,
            unsupervised=offer.unsupervised,
            into_safe=offer.into_safe,
            operation=offer.operation,
            by=command.actor.name,
            why=command.reason,
            taken=moment,
        )

    def _keep(self, offers: Iterable[RecoveryProposal], revision: int) -> list[OfferView]:
        views: list[OfferView] = []
        for offer in offers:
            id_ = f"{self._life}-{next(self._numbers)}"
            self._kept[id_] = _Kept(offer, revision)
            refusal = refusal_of(offer, self._execution)
            obstacle = None if refusal is None else refusal.detail
            views.append(offer_view(self._execution.automaton, offer, id_, revision, obstacle))
        for id_ in list(self._kept)[:-MOST_KEPT]:
            del self._kept[id_]
        return views

    def _require_no_operator_plan(self) -> None:
        if self._execution.operator_plan is not None:
            raise plan_running(self._execution.operator_plan.title)

    @property
    def _unused(self) -> frozenset[str]:
        """The resources that are out of service."""
        return self._execution.conduct.out_of(ServiceKind.RESOURCE)

    def _stalled(self) -> frozenset[str]:
        """The effects that are not counted on: the devices that they belong to do not react."""
        execution, now = self._execution, Timestamp.now().monotonic
        abilities = execution.automaton.abilities
        late = {step.ability for step in execution.plan.order.running if overdue(step, abilities[step.ability], now)}
        given_up = {
            each.name for each in execution.conduct.service.values() if each.of is ServiceKind.ABILITY and not each.by
        }
        resources = frozenset(abilities[name].resource for name in late | given_up)
        return stalled_effects(execution.automaton, execution.state, resources) | self._still.stalled(now)


def hopeful_goals(execution: Executor) -> Goals:
    """The goals of active operations that can be planned for; before production is started none has begun."""
    if execution.production is not Production.STARTED:
        return goals_of(execution.automaton, sorted(execution.active))
    return execution.pursued.select(execution.active & execution.pursued.hopeful)


def _waiting_goals(execution: Executor) -> Goals:
    """The goals of operations that are not active, and will be once their preconditions hold."""
    if execution.production is not Production.STARTED:
        return ()
    idle = execution.active | execution.conduct.idle_operations(execution.automaton)
    return goals_of(execution.automaton, sorted(execution.automaton.operations.keys() - idle))


def violated_goals(execution: Executor) -> Goals:
    """The goals of active operations whose formulas were violated."""
    return execution.pursued.select(execution.active & execution.pursued.goals.keys() - execution.pursued.hopeful)


def _meaning(offer: RecoveryProposal) -> object:
    """Return what an offer asks for; after acts of people it is one, whatever plan it was found with."""
    acts = offer.corrections, offer.physical, offer.online, offer.in_service
    return offer.kind, offer.operation, acts, None if any(acts) else offer.goal


def _no_plan(execution: Executor, aimed: GoalPlan, out_of_service: Collection[str]) -> CommandRefused:
    """Nothing can be offered; the reasons as far as they are known. Resources can be `out_of_service`."""
    members = (
        ()
        if aimed.why_not is None
        else diagnosis_view(execution.automaton, aimed.why_not, out_of_service).member_messages
    )
    if because := [member for member in members if member != message("member.goal", name=GOAL)]:
        return CommandRefused("no-plan", message("refused.no-plan.because", because=joined(because)))
    return CommandRefused("no-plan", message("refused.no-plan.proven" if aimed.proven else "refused.no-plan.not-found"))


def _require_confirmation(offer: RecoveryProposal, command: ExecuteOperatorPlan) -> None:
    """Raises `CommandRefused` unless the command repeats what the offer contains."""
    starts = [] if offer.operator_plan is None else [name for _, name in offer.operator_plan.starts]
    corrections = {change.name: change.new for change in offer.corrections}
    if command.starts != starts or not _same(command.corrections, corrections):
        raise CommandRefused("not-confirmed", message("refused.not-confirmed.offer"))


def _same(one: Mapping[str, object], other: Mapping[str, object]) -> bool:
    """Return whether they are equal, where true is not 1."""
    return one == other and all(type(one[name]) is type(other[name]) for name in one)
