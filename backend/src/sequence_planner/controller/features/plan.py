"""Operations and the live plan: what is done, runs and comes next, and the alarms of what is not planned."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping

from pydantic import JsonValue, ValidationError

from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.kinds import LEFT_OUT, LOCAL, NO_PLAN, PLANNER, UNDECIDED, Cause, silences
from sequence_planner.controller.recovery.explain import ConditionContext, waits_for
from sequence_planner.controller.views.station import (
    DiagnosisView,
    DroppedStepView,
    OperationProgress,
    OperationView,
    PlanStepView,
    PlanView,
    ReplacementView,
    StepStatus,
    WorkSpan,
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
        self._timetable.look_through(moment.epoch)
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
        if self._overtaken():
            return
        if plan.status is PlanStatus.NONE and (follows or not execution.blind):
            waiting = self._consequences.waiting(execution.active)
            yield NO_PLAN.cause(
                "", {"why": self._why_none(), "waiting": waiting, "action": self._needed()}, follows=follows
            )
        elif plan.status is not PlanStatus.NONE and plan.answer is not None:
            yield from self._left_out(plan.answer, follows)

    def _overtaken(self) -> bool:
        """Return whether the last answer is of a moment in which nobody knew what is known by now.

        At a start it comes often just after the first messages, and says nothing of what they tell: it is asked anew.
        """
        plan = self._execution.plan
        if plan.status is PlanStatus.PLANNING:
            return True
        answer, none = plan.answer, plan.status is PlanStatus.NONE
        return none and answer is not None and not self._execution.blind and plan.reason == why_none(answer, blind=True)

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
    return diagnosis_view(execution.automaton, diagnosis, conduct.out_of(ServiceKind.RESOURCE), conduct.answers)


def _contract(plan: Plan | None) -> Contract | None:
    """Return what the plan is: one that is proven to be the shortest, or one that was found soon."""
    if plan is None:
        return None
    return Contract.MINIMAL if plan.minimal_ticks and plan.minimal_starts else Contract.FAST


def _id(number: int | None) -> str | None:
    return None if number is None else str(number)


def _epoch(moment: Timestamp | None) -> float | None:
    return None if moment is None else moment.epoch


MOST_SPANS = 40
"""Of an operation no more times of work than this are kept: the last ones."""

KIND = "operations"  # of the records of how far operations are: the first of a life has all, others what has changed


def progress_from(content: Mapping[str, JsonValue]) -> dict[str, OperationProgress]:
    """Return what such a record says; nothing where it is of a program that wrote it differently."""
    try:
        return {name: OperationProgress.model_validate(written) for name, written in content.items()}
    except ValidationError:
        return {}


class Operations:
    """The operations of `execution`: which are active, since when, and how often each was completed.

    `tell` hears of all when the first has changed, and then of each that has; `before` came back. What was active as
    the last life ended has been so since then when it is the same again.
    """

    def __init__(
        self,
        execution: Executor,
        timetable: Forecast,
        before: Mapping[str, OperationProgress] | None = None,
        tell: Callable[[Mapping[str, JsonValue]], None] = lambda progress: None,
    ) -> None:
        self._execution = execution
        self._timetable = timetable
        self._tell = tell
        self._has_told = False
        operations = execution.automaton.operations
        known = before or {}
        self._progress = {name: _come_back(known.get(name, OperationProgress())) for name in operations}
        self._active = frozenset[str]()
        self._early = set[str]()  # active before production was started, which is when their time begins
        self._conditions = {
            name: (print_expression(each.goal), print_expression(each.precondition))
            for name, each in operations.items()
        }

    def after_tick(self, outcome: TickOutcome, moment: Timestamp) -> None:
        """After a tick: remember what has changed."""
        now, changed = moment.epoch, set[str]()
        for name in outcome.completed:
            known = self._progress[name]
            began = now if known.active_since is None else known.active_since
            work = _rested(known.work, now)
            self._progress[name] = OperationProgress(completed=known.completed + 1, began=began, ended=now, work=work)
            changed.add(name)
        active = self._execution.active
        for name in self._active - active:
            known = self._progress[name]
            rested = {"active_since": None, "work": _rested(known.work, now)}
            self._progress[name] = known.model_copy(update=rested)
        started = self._execution.production is Production.STARTED
        for name in active:
            if self._progress[name].active_since is None or (started and name in self._early):
                self._progress[name] = self._progress[name].model_copy(update={"active_since": now, "work": ()})
                changed.add(name)
                if not started:
                    self._early.add(name)
        if started:
            self._early.clear()
        changed |= self._active ^ active
        changed |= self._worked(active, now)
        self._active = active
        if changed:
            all_, self._has_told = not self._has_told, True
            self._tell(self.journalled() if all_ else _document({name: self._progress[name] for name in changed}))

    def _worked(self, active: Collection[str], now: float) -> set[str]:
        """Take note of where work began or ended, and return the operations of which it did."""
        running = {step.number for step in self._execution.plan.order.running}
        changed = set[str]()
        for name in active:
            known = self._progress[name]
            was = bool(known.work) and known.work[-1].ended is None
            if was == (not running.isdisjoint(self._timetable.outlook.steps_for(name))):
                continue
            work = _rested(known.work, now) if was else (*known.work, WorkSpan(began=now, ended=None))[-MOST_SPANS:]
            self._progress[name] = known.model_copy(update={"work": work})
            changed.add(name)
        return changed

    def journalled(self) -> dict[str, JsonValue]:
        """How far all are, as a record has it."""
        return _document(self._progress)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        execution = self._execution
        answer, active = execution.plan.answer, execution.active
        left_out = frozenset[str]() if answer is None else active.intersection(answer.left_out)
        jobs, automaton = execution.conduct.jobs, execution.automaton
        sentences = sentences_of(automaton)
        asking = {name: job.id for job in jobs.under_way for name in automaton.work_masters[job.work_master].operations}
        self._timetable.look_through(moment.epoch)
        outlook, never, progress = self._timetable.outlook, (None, None), self._progress
        views = {
            operation.name: OperationView(
                title=operation.title,
                active=operation.name in active,
                active_since=progress[operation.name].active_since if operation.name in active else None,
                completed=progress[operation.name].completed,
                began=progress[operation.name].began,
                ended=progress[operation.name].ended,
                first_step=_id(outlook.serves.get(operation.name, never)[0]),
                last_step=_id(outlook.serves.get(operation.name, never)[1]),
                steps=[str(number) for number in sorted(outlook.steps_for(operation.name))],
                work=list(progress[operation.name].work),
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


def _rested(work: tuple[WorkSpan, ...], now: float) -> tuple[WorkSpan, ...]:
    """The times of work, none of which goes on after `now`."""
    if not work or work[-1].ended is not None:
        return work
    return (*work[:-1], work[-1].model_copy(update={"ended": now}))


def _come_back(progress: OperationProgress) -> OperationProgress:
    """The progress of an earlier life: when that ended nobody knows, and so neither how long was worked at last."""
    known = tuple(span for span in progress.work if span.ended is not None)
    return progress.model_copy(update={"work": known})


def _document(progress: Mapping[str, OperationProgress]) -> dict[str, JsonValue]:
    return {name: each.model_dump(mode="json") for name, each in progress.items()}
