"""The live plan: what is done, what runs, what comes next, and the alarms of what is not planned."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator

from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.kinds import (
    LEFT_OUT,
    LOCAL,
    NO_PLAN,
    PLANNER,
    UNDECIDED,
    Cause,
    silences,
)
from sequence_planner.controller.alarms.message import Message, message
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.plan_tracker import formula_of, why_none
from sequence_planner.execution.vocabulary import PlanStatus, Production, ServiceKind
from sequence_planner.planning.problem import PlanAnswer, Verdict


class LivePlan:
    """Looks at the plan of `execution`. `trouble` says what is wrong with the planner.

    What comes of it that the `untold` are silent is told no sooner than that.
    """

    def __init__(
        self,
        execution: Executor,
        consequences: Consequences,
        trouble: Callable[[], str | None],
        untold: Callable[[], Collection[str]],
    ) -> None:
        self._execution = execution
        self._consequences = consequences
        self._trouble = trouble
        self._untold = untold

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        if (trouble := self._trouble()) is not None:
            waiting = self._consequences.waiting(self._execution.active)
            yield PLANNER.cause("", {"trouble": trouble, "waiting": waiting})
        elif self._execution.production is Production.STARTED:  # that there is no plan has no other cause
            yield from self._violated()
            if self._execution.conduct.silent.isdisjoint(self._untold()):
                yield from self._missing()

    def _violated(self) -> Iterator[Cause]:
        for name, since in self._execution.pursued.violated.items():
            active, operation = name in self._execution.active, self._execution.automaton.operations[name]
            yield LOCAL.cause(
                f"{name}:{since.epoch}",
                {
                    "formula": formula_of(self._execution.automaton, name),
                    "operation": operation.title,
                    "consequence": message("local.not-planned") if active else message("local.reached"),
                    "action": message("local.by-hand") if active else message("local.check"),
                },
            )

    def _missing(self) -> Iterator[Cause]:
        execution = self._execution
        plan, follows = execution.plan, silences(self._execution.conduct.silent)
        if not execution.conduct.executes_operations:
            return
        if plan.status is PlanStatus.NONE and (follows or not execution.blind):
            waiting = self._consequences.waiting(execution.active)
            yield NO_PLAN.cause(
                "", {"why": self._why_none(), "waiting": waiting, "action": self._needed()}, follows=follows
            )
        elif plan.status is not PlanStatus.NONE and plan.answer is not None:
            yield from self._left_out(plan.answer, follows)

    def _why_none(self) -> Message:
        plan = self._execution.plan
        if plan.answer is None or plan.reason not in (why_none(plan.answer, blind) for blind in (False, True)):
            return message("no-plan.other", reason=plan.reason)
        if plan.reason == why_none(plan.answer, blind=True):
            return message("no-plan.unknown", reason=plan.reason)
        if plan.answer.verdict is Verdict.NONE_AT_ALL:
            return message("no-plan.none", reason=plan.reason)
        return message("no-plan.found", reason=plan.reason)

    def _needed(self) -> Message:
        """Say what to do where there is no plan: what is out of service may be all that is missing."""
        automaton, service = self._execution.automaton, self._execution.conduct.service
        resources = [automaton.resources[name] for of, name in service if of is ServiceKind.RESOURCE]
        abilities = [automaton.abilities[name].title for of, name in service if of is ServiceKind.ABILITY]
        out = [*sorted(resources), *sorted(abilities)]
        return message("no-plan.put-back", titles=out) if out else message("no-plan.look")

    def _left_out(self, answer: PlanAnswer, follows: tuple[str, ...]) -> Iterator[Cause]:
        """The active operations that the plan does not reach: because it cannot, and because nobody knows."""
        operations, active = self._execution.automaton.operations, self._execution.active
        undecided = [name for name in answer.undecided if name in active]
        excluded = [name for name in answer.left_out if name in active and name not in answer.undecided]
        for kind, names in ((LEFT_OUT, excluded), (UNDECIDED, undecided)):
            if names:
                titles = ", ".join(operations[name].title for name in names)
                waiting = self._consequences.waiting(names)
                yield kind.cause("", {"operations": titles, "waiting": waiting}, follows=follows)
