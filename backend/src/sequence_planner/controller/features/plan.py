"""Operations and the live plan: what is done, runs and comes next, and the alarms of what is not planned."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping

from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.kinds import LEFT_OUT, LOCAL, NO_PLAN, PLANNER, UNDECIDED, Cause, silences
from sequence_planner.controller.recovery.explain import ConditionContext, waits_for
from sequence_planner.controller.views.station import (
    DiagnosisView,
    DroppedStepView,
    OperationView,
    PlanStepView,
    PlanView,
    ReplacementView,
    StepStatus,
)
from sequence_planner.controller.views.wording import diagnosis_view, reason_text
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.forecast import Expected, Forecast
from sequence_planner.execution.plan_tracker import PlannedStart, Replacement, formula_of, why_none
from sequence_planner.execution.vocabulary import PlanStatus, Production, ServiceKind
from sequence_planner.language.printer import print_expression
from sequence_planner.planning.problem import Contract, Plan, PlanAnswer, Verdict
from sequence_planner.texts.message import Message, all_titles, message, waits_in_one


class LivePlan:
    """Looks at the plan of `execution`. `trouble` says what is wrong with the planner, and `around` what is beside it.

    What comes of it that the `untold` are silent is told no sooner than that.
    """

    def __init__(
        self,
        execution: Executor,
        consequences: Consequences,
        around: ConditionContext,
        trouble: Callable[[], str | None],
        untold: Callable[[], Collection[str]],
    ) -> None:
        self._execution = execution
        self._consequences = consequences
        self._trouble = trouble
        self._untold = untold
        self._around = around
        self._timetable = Forecast(execution)
        self._status = (execution.plan.status, 0.0)  # and since when it is so
        self._replaced: tuple[Replacement | None, float] = (None, 0.0)  # and when that was seen first

    @property
    def timetable(self) -> Forecast:
        """When its steps are expected, and what they lead to."""
        return self._timetable

    def after_tick(self, outcome: TickOutcome, moment: Timestamp) -> None:
        """After a tick: remember what has changed."""
        self._timetable.update(moment.epoch)
        if self._execution.plan.status is not self._status[0] or not self._status[1]:
            self._status = (self._execution.plan.status, moment.epoch)
        if self._execution.plan.replacement is not self._replaced[0]:
            self._replaced = (self._execution.plan.replacement, moment.epoch)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        execution = self._execution
        order, plan, answer = execution.plan.order, execution.plan.order.plan, execution.plan.answer
        expected = self._timetable.expected(self._around.guards())
        steps = [
            self._step(step, StepStatus.DONE if step.ended else StepStatus.RUNNING, expected) for step in order.past
        ]
        for index, step in enumerate(order.ahead):
            steps.append(self._step(step, StepStatus.PLANNED if index else StepStatus.NEXT, expected))
        view = PlanView(
            status=execution.plan.status,
            since=self._status[1] or moment.epoch,
            reason=execution.plan.reason,
            reason_message=reason_text(execution.plan.reason),
            steps=steps,
            ticks=len(plan.ticks) if plan else 0,
            minimal_ticks=plan is not None and plan.minimal_ticks,
            minimal_starts=plan is not None and plan.minimal_starts,
            replanned=execution.plan.replanned,
            replacement=self._replacement(),
            contract=_contract(plan),
            engine=answer.engine if answer else "",
            milliseconds=answer.seconds * 1000 if answer else None,
            why=_why(execution),
        )
        return {"plan": view}

    def _replacement(self) -> ReplacementView | None:
        replacement, at = self._replaced
        if replacement is None:
            return None
        abilities = [self._execution.automaton.abilities[name] for name in replacement.dropped]
        return ReplacementView(
            at=at,
            why=replacement.why,
            why_message=reason_text(replacement.why),
            dropped=[
                DroppedStepView(ability=each.name, title=each.title, resource=each.resource) for each in abilities
            ],
        )

    def _step(self, step: PlannedStart, status: StepStatus, expected: Mapping[int, Expected]) -> PlanStepView:
        ability = self._execution.automaton.abilities[step.ability]
        due = expected.get(step.number)
        replacement = self._replaced[0]
        waits = (
            waits_for(self._execution, step.ability, self._around.feeds, self._around.guards().get(step.ability))
            if status is StepStatus.NEXT
            else []
        )
        return PlanStepView(
            id=str(step.number),
            ability=step.ability,
            title=ability.title,
            resource=ability.resource,
            status=status,
            tick=step.tick,
            started=_epoch(step.started),
            ended=_epoch(step.ended),
            expected_start=due.start if due and step.started is None else None,
            expected_end=due.end if due else None,
            after=_id(self._timetable.outlook.after.get(step.number)),
            new=replacement is not None and step.number in replacement.new,
            waits_for=[*waits],
            waits_for_messages=waits,
            sentence=waits_in_one(waits),
        )

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
            return message("no-plan.other", reason=reason_text(plan.reason))
        if plan.reason == why_none(plan.answer, blind=True):
            return message("no-plan.unknown")
        if plan.answer.verdict is Verdict.NONE_AT_ALL:
            return message("no-plan.none")
        return message("no-plan.found")

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
                titles = all_titles(operations[name].title for name in names)
                waiting = self._consequences.waiting(names)
                yield kind.cause("", {"operations": titles, "waiting": waiting}, follows=follows)


def _why(execution: Executor) -> DiagnosisView | None:
    diagnosis = execution.plan.diagnosis
    if diagnosis is None or diagnosis.reason is None:
        return None
    conduct = execution.conduct
    return diagnosis_view(diagnosis, conduct.out_of(ServiceKind.RESOURCE), conduct.answers)


def _contract(plan: Plan | None) -> Contract | None:
    """Return what the plan is: one that is proven to be the shortest, or one that was found soon."""
    if plan is None:
        return None
    return Contract.MINIMAL if plan.minimal_ticks and plan.minimal_starts else Contract.FAST


def _id(number: int | None) -> str | None:
    return None if number is None else str(number)


def _epoch(moment: Timestamp | None) -> float | None:
    return None if moment is None else moment.epoch


class Operations:
    """The operations of `execution`: which are active, since when, and how often each was completed."""

    def __init__(self, execution: Executor, timetable: Forecast) -> None:
        self._execution = execution
        self._timetable = timetable
        self._active_since: dict[str, float] = {}
        self._last: dict[str, tuple[float, float]] = {}  # when each began and ended the last time
        operations = execution.automaton.operations
        self._completed: dict[str, int] = dict.fromkeys(operations, 0)
        self._conditions = {
            name: (print_expression(each.goal), print_expression(each.precondition))
            for name, each in operations.items()
        }

    def after_tick(self, outcome: TickOutcome, moment: Timestamp) -> None:
        """After a tick: remember what has changed."""
        now = moment.epoch
        for operation in outcome.completed:
            self._completed[operation] += 1
            self._last[operation] = self._active_since.get(operation, now), now
        self._active_since = {name: self._active_since.get(name, now) for name in self._execution.active}

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        execution = self._execution
        answer, active = execution.plan.answer, execution.active
        left_out = frozenset[str]() if answer is None else active.intersection(answer.left_out)
        jobs, automaton = execution.conduct.jobs, execution.automaton
        sentences = sentences_of(automaton)
        asking = {name: job.id for job in jobs.under_way for name in automaton.work_masters[job.work_master].operations}
        outlook, never = self._timetable.outlook, (None, None)
        views = {
            operation.name: OperationView(
                title=operation.title,
                active=operation.name in active,
                active_since=self._active_since.get(operation.name),
                completed=self._completed[operation.name],
                began=self._last.get(operation.name, never)[0],
                ended=self._last.get(operation.name, never)[1],
                first_step=_id(outlook.serves.get(operation.name, never)[0]),
                last_step=_id(outlook.serves.get(operation.name, never)[1]),
                goal=self._conditions[operation.name][0],
                precondition=self._conditions[operation.name][1],
                sentence=sentences.tell_operation(
                    operation, execution.state, *self._conditions[operation.name], active=operation.name in active
                ),
                left_out=operation.name in left_out,
                repeat=operation.repeat,
                for_jobs=operation.name in automaton.job_operations,
                job=asking.get(operation.name),
            )
            for operation in automaton.operations.values()
        }
        return {"operations": views}
