"""Builder of the station view: the live document of a running station, and detection of changes."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, Protocol, runtime_checkable

from sequence_planner.analysis.report import AnalysisDocument
from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.manager import AlarmManager
from sequence_planner.controller.commands.audit import StandingNotes
from sequence_planner.controller.features.control_lock import ControlLock
from sequence_planner.controller.features.records import Records
from sequence_planner.controller.features.tasks import TaskHandler, TaskProblem
from sequence_planner.controller.features.variables import Beliefs
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.recovery.explain import ConditionContext, waits_for
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.views.execution import (
    failing,
    last_operator_plan_view,
    operator_plan_view,
    packml,
    service_views,
    standing,
    way_back,
)
from sequence_planner.controller.views.jobs import Around, job_views
from sequence_planner.controller.views.jobs import waits_for as job_waits_for
from sequence_planner.controller.views.station import (
    AbilityView,
    AlarmView,
    DiagnosisView,
    DroppedStepView,
    OperationView,
    PackML,
    PlanStepView,
    PlanView,
    ReplacementView,
    ResourceView,
    StationIdentity,
    StationStanding,
    StationView,
    StepStatus,
    TaskProblemView,
    TaskView,
    TopicView,
    VariableKind,
    VariableView,
)
from sequence_planner.controller.views.wording import diagnosis_view
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.forecast import Expected, Forecast
from sequence_planner.execution.plan_tracker import PlannedStart, Replacement
from sequence_planner.execution.vocabulary import JobState, Production, ServiceKind
from sequence_planner.language.printer import print_expression
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import Contract, Plan
from sequence_planner.synthesis.guards import SupervisorGuard

# Whether a view tells more than the one before: a station at rest is not shown anew again and again.

LONGEST: Final = 0.9  # seconds after which it is shown all the same: how many messages have come changes all the time


class Shown:
    """The view that was shown last."""

    def __init__(self) -> None:
        self._last: StationView | None = None
        self._since = 0.0  # on the clock of `time.monotonic`

    def is_news(self, view: StationView) -> bool:
        """Return whether it is to be shown, which it then is: else only the time, and when messages came, are
        others.
        """
        last, now = self._last, time.monotonic()
        if last is not None and now - self._since < LONGEST and _lasting(view) == _lasting(last):
            return False
        self.note(view)
        return True

    def note(self, view: StationView) -> None:
        """It is shown, news or not."""
        self._last, self._since = view, time.monotonic()


def _lasting(view: StationView) -> StationView:
    topics = {name: each.model_copy(update={"last": None, "messages": 0}) for name, each in view.topics.items()}
    return view.model_copy(update={"time": 0.0, "topics": topics})


# The document a running station shows, built from all that is known of it at one moment.

# How many coming steps a task names as what moves next.
_NEXT_MOVES = 2


@runtime_checkable
class ShowsPart(Protocol):
    """A feature that has a part of the document."""

    def view_part(self, moment: Timestamp) -> Mapping[str, object]:
        """Members of `StationView` as they are now."""


class ViewBuilder:
    """Builds views; remembers since when values and operations have been what they are."""

    def __init__(
        self,
        identity: StationIdentity,
        execution: Executor,
        outside: SafeStateMonitor,
        devices: Devices,
        beliefs: Beliefs,
        tasks: TaskHandler,
        records: Records,
        alarms: AlarmManager,
        in_control: ControlLock,
    ) -> None:
        self._identity = identity
        self._execution = execution
        self._outside = outside
        self._feeds, self._network, self._commander = devices.feeds, devices.network, devices.commander
        self._beliefs = beliefs
        self._desk = tasks
        self._records = records
        self._alarms = alarms
        self._in_control = in_control
        self._standing = StandingNotes(records.add_note)
        self._feeding = self._feeds.heard_on
        self._shown: Sequence[ShowsPart] = ()
        self._since: dict[str, tuple[Value | None, float]] = {}
        self._active_since: dict[str, float] = {}
        self._timetable = Forecast(execution)
        self._consequences = Consequences(execution)
        self._replaced: tuple[Replacement | None, float] = (None, 0.0)  # and when that was seen first
        self.completed: dict[str, int] = dict.fromkeys(execution.automaton.operations, 0)
        self.analysis: AnalysisDocument | None = None
        self.around = ConditionContext(self._feeding, self.since, beliefs, lambda: self.guards)
        self.guards: Mapping[str, SupervisorGuard] = {}  # that the supervisor adds, as far as they are known

    def note(self, outcome: TickOutcome, moment: Timestamp) -> None:
        """After a tick: remember what has changed."""
        now = moment.epoch
        for operation in outcome.completed:
            self.completed[operation] += 1
        for name in self._execution.automaton.variables:
            value = self._execution.state[name]
            if name not in self._since or self._since[name][0] != value:
                self._since[name] = (value, now)
        self._active_since = {name: self._active_since.get(name, now) for name in self._execution.active}
        self._timetable.update(now)
        if self._execution.plan.replacement is not self._replaced[0]:
            self._replaced = (self._execution.plan.replacement, now)

    def show(self, features: Iterable[object]) -> None:
        """Take the parts of those that have one."""
        self._shown = [feature for feature in features if isinstance(feature, ShowsPart)]

    def know(self, analysis: AnalysisDocument, guards: Mapping[str, SupervisorGuard] | None) -> None:
        """Take note of what synthesis has found beside the supervisor, to be shown."""
        self.analysis, self.guards = analysis, guards or {}

    def since(self, name: str) -> float | None:
        """Return when a variable was first seen with the value that it has; None before the first tick."""
        seen = self._since.get(name)
        return None if seen is None else seen[1]

    def view(self, moment: Timestamp) -> StationView:
        """The whole document, with the jobs as far as they are durable."""
        alarms, jobs = self._alarms.current(moment), self._records.jobs
        parts: dict[str, Any] = {}
        for feature in self._shown:
            parts |= feature.view_part(moment)
        execution, conduct = self._execution, self._execution.conduct
        resources = self._resources(moment)
        unused = conduct.out_of(ServiceKind.RESOURCE)
        silent = [each.title for name, each in resources.items() if not each.online and name not in unused]
        stands = standing(execution, self._outside, silent) if self._network.commands else StationStanding.PREPARING
        return StationView(
            station=self._identity,
            tick=execution.ticks,
            time=moment.epoch,
            revision=execution.revision,
            mode=execution.mode,
            packml=self.packml,
            standing=stands,
            silent=silent,
            failing=[title for title in failing(execution.automaton, alarms) if title not in silent],
            stepping=conduct.stepping,
            production=execution.production if self._network.commands else Production.PREPARING,
            unconfirmed=self._beliefs.unconfirmed,
            resources=resources,
            variables=self._variables(),
            abilities=self._abilities(),
            operations=self._operations(),
            by_order=jobs.by_order,
            jobs=job_views(execution, jobs, self._around(alarms, moment)),
            plan=self._plan(),
            errand=operator_plan_view(execution),
            last_errand=last_operator_plan_view(conduct),
            out_of_service=service_views(execution.automaton, conduct),
            tasks=self._tasks(stands in (StationStanding.WORKING, StationStanding.SILENT)),
            topics=self._topics(moment),
            alarms=alarms,
            way_back=way_back(self._execution.automaton, self._outside, self._feeding),
            analysis=self.analysis,
            standby=None,
            deployment=None,
            **parts,
        )

    @property
    def packml(self) -> PackML:
        """The state that PackML has for it now."""
        return packml(self._execution) if self._network.commands else PackML.RESETTING

    def note_standing(self, moment: Timestamp) -> None:
        """Write down how the station stands, where that has changed for good."""
        if not self._network.commands or not self._standing.due(moment):
            return
        around, told = self._around(self._alarms.current(moment), moment), (JobState.WAITING, JobState.RUNNING)
        jobs = [job for job in self._execution.conduct.jobs.under_way if job.state in told]
        waits = {job.id: job_waits_for(self._execution, job, around) for job in jobs}
        self._standing.look(self.packml, waits, moment)

    def _around(self, alarms: dict[str, AlarmView], moment: Timestamp) -> Around:
        execution, ahead = self._execution, self._execution.plan.order.ahead
        name = ahead[0].ability if ahead and execution.conduct.jobs.under_way else None
        waits = [] if name is None else waits_for(execution, name, self._feeding, self.guards.get(name))
        return Around(
            moment.monotonic,
            self._consequences.held_up,
            self._desk.open,
            self._desk.problems,
            alarms,
            next_waits=tuple(waits),
            controlled=self._in_control.view() is not None,
        )

    def _resources(self, moment: Timestamp) -> dict[str, ResourceView]:
        awaited: dict[str, list[str]] = {name: [] for name in self._execution.automaton.resources}
        for topic in self._feeds.awaited(moment.monotonic):
            awaited[self._feeds.resource_of(topic)].append(topic)
        return {
            name: ResourceView(title=title, online=not awaited[name], awaited_topics=awaited[name])
            for name, title in self._execution.automaton.resources.items()
        }

    def _variables(self) -> dict[str, VariableView]:
        views = {}
        for name, variable in self._execution.automaton.variables.items():
            if variable.kind is Kind.ACTIVITY:
                continue  # operations have a part of their own
            value = self._execution.state[name]
            since = self._since.get(name)
            views[name] = VariableView(
                resource=variable.resource,
                kind=VariableKind(variable.kind),
                value=value,
                domain=list(variable.type.domain),
                dual_approval=variable.dual_approval,
                since=since[1] if since else None,
                awaits=self._feeding.get(name) if value is None else None,
                belief=self._beliefs.of(name) if variable.kind is Kind.ESTIMATED else None,
            )
        return views

    def _abilities(self) -> dict[str, AbilityView]:
        running = {step.ability: _epoch(step.started) for step in self._execution.plan.order.running}
        state = self._execution.state
        return {
            ability.name: AbilityView(
                resource=ability.resource,
                title=ability.title,
                human=ability.human is not None,
                restart=ability.restart,
                enabled=_truth(state[ability.flag("enabled")]),
                executing=_truth(state[ability.flag("executing")]),
                finished=_truth(state[ability.flag("finished")]),
                running_since=running.get(ability.name),
            )
            for ability in self._execution.automaton.abilities.values()
        }

    def _operations(self) -> dict[str, OperationView]:
        execution = self._execution
        left_out = set(execution.plan.answer.left_out) if execution.plan.answer else set()
        jobs, automaton = execution.conduct.jobs, execution.automaton
        asking = {name: job.id for job in jobs.under_way for name in automaton.work_masters[job.work_master].operations}
        return {
            operation.name: OperationView(
                title=operation.title,
                active=operation.name in execution.active,
                active_since=self._active_since.get(operation.name),
                completed=self.completed[operation.name],
                goal=print_expression(operation.goal),
                precondition=print_expression(operation.precondition),
                left_out=operation.name in left_out & execution.active,
                repeat=operation.repeat,
                for_jobs=operation.name in automaton.job_operations,
                job=asking.get(operation.name),
            )
            for operation in automaton.operations.values()
        }

    def _plan(self) -> PlanView:
        execution = self._execution
        order, plan, answer = execution.plan.order, execution.plan.order.plan, execution.plan.answer
        expected = self._timetable.expected(self.guards)
        steps = [
            self._step(step, StepStatus.DONE if step.ended else StepStatus.RUNNING, expected) for step in order.past
        ]
        for index, step in enumerate(order.ahead):
            steps.append(self._step(step, StepStatus.PLANNED if index else StepStatus.NEXT, expected))
        return PlanView(
            status=execution.plan.status,
            reason=execution.plan.reason,
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

    def _replacement(self) -> ReplacementView | None:
        replacement, at = self._replaced
        if replacement is None:
            return None
        abilities = [self._execution.automaton.abilities[name] for name in replacement.dropped]
        return ReplacementView(
            at=at,
            why=replacement.why,
            dropped=[
                DroppedStepView(ability=each.name, title=each.title, resource=each.resource) for each in abilities
            ],
        )

    def _step(self, step: PlannedStart, status: StepStatus, expected: Mapping[int, Expected]) -> PlanStepView:
        ability = self._execution.automaton.abilities[step.ability]
        due = expected.get(step.number)
        replacement = self._replaced[0]
        waiting = (
            waits_for(self._execution, step.ability, self._feeding, self.guards.get(step.ability))
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
            new=replacement is not None and step.number in replacement.new,
            waits_for=waiting,
        )

    def _tasks(self, goes_on: bool) -> dict[str, TaskView]:
        abilities = self._execution.automaton.abilities
        names = self._execution.plan.order.names if goes_on else ()
        moves = [abilities[name].title for name in names if abilities[name].human is None]
        return {
            id_: TaskView(
                revision=task.revision,
                resource=abilities[task.ability].resource,
                ability=task.ability,
                title=task.title,
                text=task.text,
                created=task.created,
                next_moves=moves[:_NEXT_MOVES],
                problem=_problem(self._desk.problems.get(id_)),
            )
            for id_, task in self._desk.open.items()
        }

    def _topics(self, moment: Timestamp) -> dict[str, TopicView]:
        views = {}
        for name, feed in self._feeds.topics.items():
            views[name] = TopicView(
                type=feed.pipeline.topic.type_name,
                direction="in",
                resource=feed.pipeline.topic.resource,
                last=moment.epoch_of(feed.last),
                messages=feed.messages,
                deadline=feed.pipeline.deadline,
                fresh=feed.fresh(moment.monotonic),
                peers=self._network.peers[name],
                trouble=self._network.troubles.get(name) or feed.trouble,
            )
        for name, command in self._commander.topics.items():
            views[name] = TopicView(
                type=command.pipeline.topic.type_name,
                direction="out",
                resource=command.pipeline.topic.resource,
                last=moment.epoch_of(command.last),
                messages=command.messages,
                deadline=None,
                fresh=command.last is not None,
                peers=self._network.peers[name],
                trouble=self._network.rivals.get(name) or self._network.troubles.get(name) or command.owed,
            )
        return views


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


def _problem(problem: TaskProblem | None) -> TaskProblemView | None:
    return None if problem is None else TaskProblemView.model_validate(problem, from_attributes=True)


def _epoch(moment: Timestamp | None) -> float | None:
    return None if moment is None else moment.epoch


def _truth(value: Value | None) -> bool | None:
    return value if isinstance(value, bool) else None
