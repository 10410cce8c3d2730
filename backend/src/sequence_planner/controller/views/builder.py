"""Builder of the station view: the live document of a running station, and detection of changes."""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Final

from sequence_planner.analysis.report import AnalysisDocument
from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.controller.alarms.alarm import Consequences
from sequence_planner.controller.features.tasks import TaskHandler, TaskProblem
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.io.network import NetworkWatch
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.recovery.consistency import Beliefs
from sequence_planner.controller.recovery.explain import waits_for
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.views.control_lock import ControlView
from sequence_planner.controller.views.jobs import Around, job_views
from sequence_planner.controller.views.jobs import waits_for as job_waits_for
from sequence_planner.controller.views.station import (
    AbilityView,
    AlarmView,
    ApprovalView,
    DiagnosisView,
    DifferenceView,
    DroppedStepView,
    ForceView,
    LastCorrectionView,
    LastOperatorPlanView,
    OperationView,
    OperatorPlanView,
    OverrideView,
    PackML,
    PlanStepView,
    PlanView,
    QuestionView,
    ReplacementView,
    ResourceView,
    ServiceView,
    SpecificationView,
    StationIdentity,
    StationStanding,
    StationView,
    StepStatus,
    TaskProblemView,
    TaskView,
    TopicView,
    UndecidedOutputView,
    VariableKind,
    VariableView,
    WayBackStepView,
    WayBackView,
    WhoCanView,
)
from sequence_planner.controller.views.wording import diagnosis_view, end_text
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.forecast import Expected, Forecast
from sequence_planner.execution.jobs import Jobs
from sequence_planner.execution.plan_tracker import PlannedStart, Replacement
from sequence_planner.execution.state import ExecutionState
from sequence_planner.execution.vocabulary import JobState, Mode, PlanStatus, Production, ServiceKind
from sequence_planner.language.printer import print_expression
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import Contract, Plan, RecoveryPath, WayBackAnswer
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


# What is shown of how a station executes: its PackML state, what is carried out, forced, and out of service.

_ENDING = {Mode.PAUSED: (PackML.HOLDING, PackML.HELD), Mode.HOLD: (PackML.STOPPING, PackML.STOPPED)}


def packml(execution: Executor) -> PackML:
    """The state of PackML that fits; `docs/control.md` says what it is made of."""
    if execution.production is not Production.STARTED:
        return PackML.IDLE
    moves = bool(execution.running())
    if execution.mode is Mode.AUTOMATIC:
        followed = execution.plan.status is PlanStatus.FOLLOWED and bool(execution.plan.order.goals)
        return PackML.EXECUTE if moves or followed else PackML.SUSPENDED
    moves = moves or execution.operator_plan is not None
    if execution.mode is Mode.RESTART:
        return PackML.CLEARING if moves else PackML.ABORTED
    during, after = _ENDING[execution.mode]
    return during if moves else after


_STANDING = {
    Mode.HOLD: StationStanding.HELD,
    Mode.RESTART: StationStanding.RESTART,
    Mode.PAUSED: StationStanding.PAUSED,
}


# What alarms are called that say of a device, or of what it does, that it fails; see `docs/alarms.md`.
_FAILURES = frozenset({"overdue", "still", "given-up"})


def failing(automaton: Automaton, alarms: Mapping[str, AlarmView]) -> list[str]:
    """Return what the resources are called that do not do what they should, as `alarms` say; people are none of
    them.
    """
    found: set[str] = set()
    for key, alarm in alarms.items():
        kind, _, name = key.partition(":")
        ability = automaton.abilities.get(name)
        if alarm.ended is not None or kind not in _FAILURES:
            continue
        if ability is None:
            found.add(name)
        elif ability.human is None:
            found.add(ability.resource)
    return [title for name, title in automaton.resources.items() if name in found]


def standing(execution: Executor, outside: SafeStateMonitor, silent: Collection[str]) -> StationStanding:
    """Return whether anything starts by itself, while these resources are `silent`."""
    situation = outside.situation
    if execution.production is not Production.STARTED:
        return StationStanding.WAITING
    if execution.mode is not Mode.AUTOMATIC:
        return _STANDING[execution.mode]
    if execution.obstacles or (situation is not None and situation.certain):
        return StationStanding.STOPPED
    return StationStanding.SILENT if silent else StationStanding.WORKING


def operator_plan_view(execution: Executor) -> OperatorPlanView | None:
    """Return what is carried out now."""
    operator_plan = execution.operator_plan
    if operator_plan is None:
        return None
    return OperatorPlanView(
        kind=operator_plan.kind,
        title=operator_plan.title,
        by=operator_plan.by,
        why=operator_plan.why,
        since=operator_plan.taken.epoch,
        ends=end_text(operator_plan.goal, operator_plan.into_safe),
        into_safe=operator_plan.into_safe,
        ability=operator_plan.ability,
    )


def last_operator_plan_view(conduct: ExecutionState) -> LastOperatorPlanView | None:
    """Return how the last one has ended."""
    last = conduct.last_operator_plan
    if last is None:
        return None
    return LastOperatorPlanView(
        title=last.title, done=last.done, why=last.why, ended=last.ended.epoch, ability=last.ability
    )


def force_views(conduct: ExecutionState) -> dict[str, ForceView]:
    """Return what is forced."""
    return {
        name: ForceView(value=force.value, real=force.real, until=force.until.epoch, by=force.by, why=force.why)
        for name, force in conduct.forces.items()
    }


def service_views(automaton: Automaton, conduct: ExecutionState) -> list[ServiceView]:
    """Return what is out of service, since when."""
    return [
        ServiceView(
            of=each.of,
            name=each.name,
            title=_title(automaton, each.of, each.name),
            since=each.since.epoch,
            by=each.by,
            why=each.why,
        )
        for each in sorted(conduct.service.values(), key=lambda each: (each.since.epoch, each.of, each.name))
    ]


def _title(automaton: Automaton, of: ServiceKind, name: str) -> str:
    if of is ServiceKind.RESOURCE:
        return automaton.resources[name]
    return (automaton.abilities if of is ServiceKind.ABILITY else automaton.operations)[name].title


# What is shown of a station outside its safe states.


def way_back(automaton: Automaton, outside: SafeStateMonitor, feeds: Mapping[str, str]) -> WayBackView | None:
    """None while the state is safe. `feeds` names the topic behind each measured variable."""
    situation = outside.situation
    if situation is None:
        return None

    def named(specifications: tuple[str, ...]) -> list[SpecificationView]:
        return [SpecificationView(name=name, title=automaton.specifications[name].title) for name in specifications]

    awaits = sorted({feeds.get(name, name) for name in situation.awaited})
    answer = outside.answer if situation.certain else None
    found = answer if isinstance(answer, WayBackAnswer) else None
    way = found.way if found is not None else None
    return WayBackView(
        violated=named(situation.violated),
        threatened=named(found.threatened) if found is not None else [],
        differences=[DifferenceView(name=d.name, now=d.now, safe=d.safe) for d in situation.differences],
        awaits=awaits,
        ticks=len(way.ticks) if way is not None else None,
        steps=_steps(automaton, way) if way is not None else [],
        breaks=named(way.breaks) if way is not None else [],
        reason=str(outside.way())
        if situation.certain
        else f"Whether the state is safe depends on {', '.join(awaits)}.",
    )


def _steps(automaton: Automaton, way: RecoveryPath) -> list[WayBackStepView]:
    abilities = [(tick, automaton.abilities[name]) for tick, name in way.starts]
    return [WayBackStepView(tick=tick, ability=a.name, title=a.title, resource=a.resource) for tick, a in abilities]


# The document a running station shows, built from all that is known of it at one moment.

# How many coming steps a task names as what moves next.
_NEXT_MOVES = 2


@dataclass(frozen=True)
class Doubts:
    """The things that a person has to decide or to look at, the last correction, and what waits for a second person."""

    undecided: dict[str, UndecidedOutputView]
    questions: list[QuestionView]
    last_correction: LastCorrectionView | None
    approvals: dict[str, ApprovalView]


class ViewBuilder:
    """Builds views; remembers since when values and operations have been what they are."""

    def __init__(
        self,
        identity: StationIdentity,
        execution: Executor,
        outside: SafeStateMonitor,
        feeds: Inputs,
        network: NetworkWatch,
        beliefs: Beliefs,
    ) -> None:
        self._identity = identity
        self._execution = execution
        self._outside = outside
        self._feeds = feeds
        self._network = network
        self._beliefs = beliefs
        self._feeding = feeds.heard_on
        self._since: dict[str, tuple[Value | None, float]] = {}
        self._active_since: dict[str, float] = {}
        self._timetable = Forecast(execution)
        self._consequences = Consequences(execution)
        self._replaced: tuple[Replacement | None, float] = (None, 0.0)  # and when that was seen first
        self.completed: dict[str, int] = dict.fromkeys(execution.automaton.operations, 0)
        self.analysis: AnalysisDocument | None = None
        self.who_can: WhoCanView | None = None
        self.guards: Mapping[str, SupervisorGuard] = {}  # that the supervisor adds, as far as they are known

    def note(self, outcome: TickOutcome, now: float) -> None:
        """After a tick: remember what has changed."""
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

    def since(self, name: str) -> float | None:
        """Return when a variable was first seen with the value that it has; None before the first tick."""
        seen = self._since.get(name)
        return None if seen is None else seen[1]

    def view(
        self,
        desk: TaskHandler,
        commander: Outputs,
        overrides: dict[str, OverrideView],
        alarms: dict[str, AlarmView],
        control: ControlView | None,
        doubts: Doubts,
        jobs: Jobs,
        moment: Timestamp,
    ) -> StationView:
        """The whole document, with the `jobs` as far as they are durable."""
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
            undecided=doubts.undecided,
            control=control,
            resources=resources,
            variables=self._variables(),
            abilities=self._abilities(),
            operations=self._operations(),
            by_order=jobs.by_order,
            jobs=job_views(execution, jobs, self._around(desk, alarms, control is not None, moment)),
            plan=self._plan(),
            errand=operator_plan_view(execution),
            last_errand=last_operator_plan_view(conduct),
            forces=force_views(conduct),
            out_of_service=service_views(execution.automaton, conduct),
            questions=doubts.questions,
            last_correction=doubts.last_correction,
            approvals=doubts.approvals,
            who_can=self.who_can,
            tasks=self._tasks(desk, stands in (StationStanding.WORKING, StationStanding.SILENT)),
            topics=self._topics(commander, moment),
            overrides=overrides,
            alarms=alarms,
            way_back=way_back(self._execution.automaton, self._outside, self._feeding),
            analysis=self.analysis,
            standby=None,
            deployment=None,
        )

    @property
    def packml(self) -> PackML:
        """The state that PackML has for it now."""
        return packml(self._execution) if self._network.commands else PackML.RESETTING

    def job_waits(
        self, desk: TaskHandler, alarms: dict[str, AlarmView], controlled: bool, moment: Timestamp
    ) -> dict[str, list[str]]:
        """Return what each job waits for that was taken and is neither paused nor over."""
        around, told = self._around(desk, alarms, controlled, moment), (JobState.WAITING, JobState.RUNNING)
        jobs = self._execution.conduct.jobs.under_way
        return {job.id: job_waits_for(self._execution, job, around) for job in jobs if job.state in told}

    def _around(self, desk: TaskHandler, alarms: dict[str, AlarmView], controlled: bool, moment: Timestamp) -> Around:
        execution, ahead = self._execution, self._execution.plan.order.ahead
        name = ahead[0].ability if ahead and execution.conduct.jobs.under_way else None
        waits = [] if name is None else waits_for(execution, name, self._feeding, self.guards.get(name))
        return Around(
            moment.monotonic,
            self._consequences.held_up,
            desk.open,
            desk.problems,
            alarms,
            next_waits=tuple(waits),
            controlled=controlled,
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

    def _tasks(self, desk: TaskHandler, goes_on: bool) -> dict[str, TaskView]:
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
                problem=_problem(desk.problems.get(id_)),
            )
            for id_, task in desk.open.items()
        }

    def _topics(self, commander: Outputs, moment: Timestamp) -> dict[str, TopicView]:
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
        for name, command in commander.topics.items():
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
