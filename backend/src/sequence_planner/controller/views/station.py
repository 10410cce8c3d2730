"""View schema of a running station: alarms, approvals, jobs, forces, recovery and absent resources."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Literal

from pydantic import Field

from sequence_planner.analysis.report import AnalysisDocument
from sequence_planner.controller.commands.approvals import Act
from sequence_planner.controller.commands.tasks import ProblemKind
from sequence_planner.controller.views.part import ControlView, Value, View
from sequence_planner.execution.vocabulary import JobState, Mode, PlanStatus, Production
from sequence_planner.planning.problem import Contract
from sequence_planner.texts.message import Message

# Alarms, as they are shown.


class Priority(StrEnum):
    """Urgency of an alarm, after ISA-18.2."""

    HIGH = "high"
    MEDIUM = "medium"
    LOW = "low"


class AlarmGroup(StrEnum):
    """What a kind of alarm is about."""

    DEVICE = "device"  # a device fails; an unsafe state can follow from it
    COMMUNICATION = "communication"
    PLAN = "plan"
    RECOVERY = "recovery"  # the remedy is a plan, a correction or a decision of a person
    PEOPLE = "people"
    SYSTEM = "system"
    MODEL = "model"  # a condition that the model does not allow
    PROCESS = "process"  # what an engineer declared in the model


class AlarmState(StrEnum):
    """Where an alarm stands in its life (ISA-18.2, figure 4.2)."""

    UNACKNOWLEDGED = "unacknowledged"
    ACKNOWLEDGED = "acknowledged"
    RETURNED = "returned"  # its cause has gone, and nobody has acknowledged it yet
    SHELVED = "shelved"
    OUT_OF_SERVICE = "out-of-service"


@dataclass(frozen=True)
class AlarmMessages:
    """The texts of an alarm as messages of the catalogue, for a page in another language."""

    text: Message
    consequence: Message | None
    action: Message | None
    parts: tuple[Message, ...]


class AlarmView(View):
    """Something that wants a person's attention. `ended` is when its cause has gone, null while it lasts.

    It is of a `kind` and about its `subject`; `resources` and `topics` are where to look. One that was acknowledged
    goes with its cause. `by` is who acknowledged or shelved it or took it out of service, `until` when it is shelved no
    more, `why` the reason that was given. `count` is how often it came since it was last acknowledged; `parts` lists
    what else the same cause has brought about. The texts are in English, `messages` are the same for other languages.
    """

    kind: str
    subject: str
    group: AlarmGroup
    priority: Priority
    state: AlarmState
    text: str  # what is wrong
    consequence: str  # what comes of it
    action: str  # what to do
    messages: AlarmMessages
    resources: list[str]
    topics: list[str]
    since: float
    ended: float | None
    by: str | None
    until: float | None
    why: str | None
    count: int
    parts: list[str]


# What waits for a second person, as it is shown.


class ApprovalState(StrEnum):
    """How far a request has come."""

    WAITING = "waiting"
    APPROVED = "approved"  # and done
    DECLINED = "declined"
    WITHDRAWN = "withdrawn"  # by who has asked for it
    EXPIRED = "expired"  # nobody has answered in time
    OVERTAKEN = "overtaken"  # the state has moved, or control has


class ApprovalView(View):
    """A request of `person`, called `by`, for an act that needs a second person; it waits `until` then at most.

    It was looked at in the state of `revision`, and can be approved in no other. `answered_by` has approved or declined
    it. One that is over is shown for a minute more.
    """

    act: Act
    revision: int
    person: str
    by: str
    why: str
    since: float
    until: float
    state: ApprovalState
    answered_by: str | None
    answer: str | None  # why, in the words of who has answered


# What is shown of the jobs that a station works, and of those that have ended and are not forgotten yet.


class JobStepState(StrEnum):
    """Where an operation of a job stands."""

    WAITING = "waiting"  # others come first, or its job lets none begin
    ELIGIBLE = "eligible"  # active as soon as its precondition holds
    ACTIVE = "active"
    COMPLETED = "completed"
    SKIPPED = "skipped"  # another branch of its alternative was taken


class JobStepView(View):
    """An operation of a job: when it was active first, and when it was completed.

    One whose goal held already is completed without having been active. It `waits_for` operations of its job, or of
    another, written `job/operation`.
    """

    state: JobStepState
    waits_for: list[str]
    started: float | None
    ended: float | None


class JobView(View):
    """A job, with its operations in the order of its work master.

    `begun` is when what its product brings was there. With `stopping` no further operation begins, and it is `stopped`
    as soon as those that were active then are completed. `waits_for` says in words what keeps it from going on.
    """

    title: str
    work_master: str
    state: JobState
    stopping: bool
    taken: float
    begun: float | None
    ended: float | None
    waits_for: list[str]
    waits_for_messages: list[Message]
    sentence: Message | None  # the same as one sentence
    steps: dict[str, JobStepView]


# What a person may set while a station runs, and what is set.

FieldValue = bool | int | Annotated[float, Field(allow_inf_nan=False)] | str


class OverrideFieldView(View):
    """A field that may be set to a number `between` two, or to one of `among`; the other of the two is null.

    `value` is what is set now, null when nothing is.
    """

    type: str
    between: tuple[float, float] | None
    among: list[FieldValue] | None
    value: FieldValue | None


class OverrideView(View):
    """An override of the model, in the pipeline of a topic or flow. What is set is gone after `expires` seconds.

    `actor` has set what is set, until `until` (seconds since the epoch); both are null when nothing is.
    """

    pipeline: str
    resource: str
    expires: float
    fields: dict[str, OverrideFieldView]
    actor: str | None
    until: float | None


# What people have asked of a station beside its work, and what it asks of them, as it is shown.


class ForceView(View):
    """A forced variable: what it is taken to be, what it would be, until when, by whom and why."""

    value: Value
    real: Value | None
    until: float
    by: str
    why: str


class ServiceView(View):
    """What is out of service since when, by whom and why; `by` is null where the station gave an ability up itself."""

    of: str  # resource, ability or operation
    name: str
    title: str
    since: float
    by: str | None
    why: str
    why_message: Message | None  # of what the station says itself


class CycleStopView(View):
    """A wish that the station pauses when the product that is in work is done: whose, since when, and why.

    Once it is `reached` the station is paused because of it, until the mode changes.
    """

    by: str
    since: float
    why: str
    reached: bool


class BreakpointView(View):
    """A condition for which the station pauses as soon as it becomes true, whose it is and since when.

    `hits` counts how often it did, `last` is when; the station is `stopped` there.
    """

    condition: str
    sentence: Message
    by: str
    since: float
    hits: int
    last: float | None
    stopped: bool


class MadeBreakpointView(BreakpointView):
    """One that was set just now, with its `id`: its name in `breakpoints`."""

    id: str


class OperatorPlanView(View):
    """What a person has taken, and is being carried out: nothing but this plan is. `kind` is what it is for.

    It is done when it `ends`, and one `into_safe` when the station is inside its safe states besides. `ability` is the
    one that is tried.
    """

    kind: str  # way-back, reset, goal, trial
    title: str
    title_message: Message
    by: str
    why: str
    since: float
    ends: str | None  # in the model's language; null where it is a way into the safe states and nothing else
    ends_message: Message | None
    into_safe: bool
    ability: str | None


class LastOperatorPlanView(View):
    """How the last operator plan has ended: `done`, or why not. `ability` is the one that was tried."""

    title: str
    title_message: Message
    done: bool
    why: str
    why_message: Message
    ended: float
    ability: str | None


class UndecidedOutputView(View):
    """An output that came back from the journal, and would make its device react as soon as it is published.

    `reacts` says how; with each of `quiet` its device would stay as it is. With each of `unsafe` the station would
    leave its safe states, unless other outputs change as well.
    """

    value: Value
    reacts: list[str]
    reacts_messages: list[Message]
    quiet: list[Value]
    unsafe: list[Value]


class QuestionView(View):
    """What to look at: the station's belief does not fit what is measured. The first question separates most.

    `variable` is what is asked about, `believed` its value, `so` that it has it, in words, `possible` those that would
    fit; `because` says which belief does not go together with which measurement.
    """

    variable: str
    believed: Value
    so: Message
    possible: list[Value]
    because: list[str]
    because_messages: list[Message]


class LastCorrectionView(View):
    """The last correction, made on `revision`; it can be undone in one step while `undoable`."""

    revision: int
    values: dict[str, Value]
    before: dict[str, Value]
    by: str
    why: str
    at: float
    undoable: bool


# Where a station that is outside its safe states is, and how it comes back, as it is shown.


class SpecificationView(View):
    """A ground specification; several can have one title."""

    name: str
    title: str


class DifferenceView(View):
    """A variable that has another value in the nearest safe state."""

    name: str
    now: Value
    safe: Value


class WayBackStepView(View):
    """One start on the way back. `tick` counts from the tick in which the way begins."""

    tick: int
    ability: str
    title: str
    resource: str


class WayBackView(View):
    """The state does not count as safe: why, how the nearest safe state differs, and the shortest way back.

    Without differences and with nothing violated the state may be safe, and what `awaits` names decides. `ticks` is
    null while no way is known; a way without steps needs no start.
    """

    violated: list[SpecificationView]
    threatened: list[SpecificationView]  # what the devices could violate without any start
    differences: list[DifferenceView]
    awaits: list[str]  # topics whose values decide whether the state is safe
    ticks: int | None
    steps: list[WayBackStepView]
    breaks: list[SpecificationView]  # what is violated on the way, and is not now
    reason: str  # which way leads back, or why none is known
    reason_message: Message


# What is shown of who can do what while something does not take part.


class AbsenceReason(StrEnum):
    """Why nothing is started with it."""

    SILENT = "silent"
    OUT_OF_SERVICE = "out of service"


class AbsenceView(View):
    """A resource or an ability with which nothing is started."""

    of: str  # resource or ability
    name: str
    title: str
    why: AbsenceReason


class NobodyView(View):
    """An operation that nobody can complete now; `lacks` are the titles of what has to be there again for it."""

    operation: str
    title: str
    active: bool
    lacks: list[str]


class DoableView(View):
    """An operation that may still be completed, as far as is known without a search.

    `by` are the titles of the resources that would start something for it. `once` is what somebody has to see to
    first, by the names of variables; `once_message` says that it is so, in words.
    """

    operation: str
    title: str
    active: bool
    by: list[str]
    once: dict[str, Value]
    once_message: Message | None


class WhoCanView(View):
    """What nobody can do for the want of what is `absent`, and what others may still do."""

    absent: list[AbsenceView]
    nobody: list[NobodyView]
    others: list[DoableView]


# What a running station shows: one document, written by the controller and read by everybody else.
#
# The controller knows its clients only through this document. The server cuts it into numbered deltas
# (`sequence_planner.server.stream`), REST serves parts of it, and the page's TypeScript types are generated from it.
# Times are seconds since the epoch on the controller's clock; ages are left to the reader.


class PackML(StrEnum):
    """The state that PackML (ISA-TR88.00.02) has for it; see `docs/control.md` for what it is made of."""

    RESETTING = "resetting"
    IDLE = "idle"
    EXECUTE = "execute"
    SUSPENDED = "suspended"
    HOLDING = "holding"
    HELD = "held"
    STOPPING = "stopping"
    STOPPED = "stopped"
    ABORTED = "aborted"
    CLEARING = "clearing"


class StationStanding(StrEnum):
    """Whether anything starts by itself, and why not: what somebody at the station has to know first."""

    PREPARING = "preparing"
    WAITING = "waiting"  # production is not started
    HELD = "held"
    RESTART = "restart"
    PAUSED = "paused"
    STOPPED = "stopped"  # certainly outside the safe states, or something keeps everything from starting
    SILENT = "silent"  # it goes on as far as it can, but devices are not heard
    WORKING = "working"


class VariableKind(StrEnum):
    """Writer of a variable."""

    MEASURED = "measured"
    OUTPUT = "output"
    ESTIMATED = "estimated"


class StepStatus(StrEnum):
    """Where a start of the plan stands."""

    DONE = "done"
    RUNNING = "running"
    NEXT = "next"
    PLANNED = "planned"


class StationIdentity(View):
    """What is running; `titles` has the title by language, `""` where the model has one for all."""

    name: str
    title: str
    titles: dict[str, str]
    description: str
    transport: str
    emulated: bool
    deployment_approval: Literal["single", "dual"] = "single"  # `dual`: a second person approves what is deployed


class DeploymentState(StrEnum):
    """What has become of a deployment."""

    STARTING = "starting"  # it is to be seen whether the station runs the new model
    RUNS = "runs"
    UNDONE = "undone"  # the station could not be started with it, and the model before is back


class DeploymentView(View):
    """The deployment with which the controller began; `why` it was undone is null where it was not."""

    revision: str
    name: str
    by: str
    at: float
    state: DeploymentState
    why: str | None


class ResourceView(View):
    """A resource and whether all its topics speak."""

    title: str
    online: bool
    awaited_topics: list[str]


class BeliefView(View):
    """Why an estimated variable is believed to have its value.

    `writer` is an ability, a person, or what it was at the beginning; `evidence` is what was measured as it wrote. As
    long as `unconfirmed_since` is set, nobody has seen whether the value is still true.
    """

    writer: str
    at: float
    evidence: list[str]
    unconfirmed_since: float | None


class VariableView(View):
    """A variable and its value; `value` is null when it is unknown, and `awaits` then names the topic."""

    resource: str | None
    kind: VariableKind
    value: Value | None
    domain: list[Value]
    dual_approval: bool  # a second person has to approve each correction and force of it
    since: float | None
    awaits: str | None
    last_known: Value | None  # what it was before it became unknown; null where it is known, or never was
    belief: BeliefView | None  # of an estimated one
    commanded_by: str | None  # of an output: the ability that has written its value


class AbilityView(View):
    """The flags of a ground ability; null is undetermined."""

    resource: str
    title: str
    human: bool
    restart: bool
    moves: bool  # something moves by it, as the model says
    enabled: bool | None
    executing: bool | None
    finished: bool | None
    running_since: float | None


class WorkSpan(View):
    """A time in which a step that serves an operation ran; it has not `ended` while one does."""

    began: float
    ended: float | None


class OperationProgress(View):
    """How far an operation is: active since then, how often it was completed, and when it began and ended last.

    The times of `work` lie in what it is active since, or in what it was active for last.
    """

    active_since: float | None = None
    completed: int = 0
    began: float | None = None
    ended: float | None = None
    work: tuple[WorkSpan, ...] = ()


class OperationView(View):
    """An operation: active until its goal holds.

    With `for_jobs` a work master has it: while the station works by order it is active only for a job under way. `job`
    is the one that has it, whether it is its turn or not. It `began` and `ended` the last time it was completed, null
    where that was never. What the plan does for it goes from the step `first_step` to `last_step`, which reaches its
    goal; of those between them `steps` serve it. The times of `work` are when these ran since it is active, or while it
    was for the last time; between them it waits.
    """

    title: str
    active: bool
    active_since: float | None
    completed: int
    began: float | None
    ended: float | None
    first_step: str | None
    last_step: str | None
    steps: list[str]
    work: list[WorkSpan]
    goal: str
    precondition: str
    sentence: Message | None  # what it waits for, or until when it is active: what of that is still missing
    left_out: bool  # active, but not part of the plan, because not all goals can be planned together
    repeat: bool  # it becomes active again after it was completed, whenever its precondition holds
    for_jobs: bool
    job: str | None


class PlanStepView(View):
    """One start of the plan. `tick` counts from the tick in which the plan was made.

    As long as it is not over it is expected to start and to end at these times, which are told from what happened last
    and do not move on by themselves: what is late by now is expected at once, and what follows as much later. It is
    possible `after` another step, whose start, end or effect is the last that it misses; null where it misses nothing,
    or what it misses comes by itself.
    """

    id: str
    ability: str
    title: str
    resource: str
    status: StepStatus
    tick: int
    started: float | None
    ended: float | None
    expected_start: float | None
    expected_end: float | None
    after: str | None
    new: bool  # the plan that was replaced last did not have it
    waits_for: list[str]  # for the next step: what keeps it from starting, in the model's language
    waits_for_messages: list[Message]
    sentence: Message | None  # the same as one sentence


class DiagnosisView(View):
    """Why there is no plan at all: nothing is possible as long as all `members` stay as they are.

    `minimal` says that none of them could be spared. Each of `corrections` would bring a plan back; no fewer changes
    would.
    """

    members: list[str]
    minimal: bool
    corrections: list[str]
    member_messages: list[Message]
    correction_messages: list[Message]


class DroppedStepView(View):
    """A start that the plan before had, and this one has not."""

    ability: str
    title: str
    resource: str


class ReplacementView(View):
    """A plan took the place of another: when, why, and what went with it. The steps say if they are new."""

    at: float
    why: str
    why_message: Message
    dropped: list[DroppedStepView]


class PlanView(View):
    """The live plan: what is done, what runs, what comes next and what that waits for."""

    status: PlanStatus
    since: float  # when the status came to be this
    reason: str  # why it was made, or why there is none
    reason_message: Message
    steps: list[PlanStepView]
    ticks: int
    minimal_ticks: bool
    minimal_starts: bool
    replanned: int
    replacement: ReplacementView | None  # how it took the place of another, if it did
    contract: Contract | None  # what it is: the shortest, proven, or one found soon
    engine: str  # of the planner, which gave the answer
    milliseconds: float | None  # how long the planner took
    why: DiagnosisView | None  # as soon as it is known why there is no plan at all


class TaskProblemView(View):
    """What keeps somebody from doing a task; `what` may be null and `why` empty."""

    by: str
    since: float
    what: ProblemKind | None
    why: str


class InstructionView(View):
    """How a person does something: a sentence by language, a picture and a video by their paths below `/api/v1/`."""

    text: dict[str, str]
    image: str | None
    video: str | None


class NextMovesView(View):
    """What moves once a task is acknowledged: a resource by name and title, and the titles of what it does first; none
    where it may move and there is no plan for it yet.
    """

    name: str
    title: str
    moves: list[str]


class TaskView(View):
    """A task that waits for a person. An acknowledgement must carry its id and revision."""

    revision: int
    resource: str
    ability: str
    title: str
    text: str
    created: float
    next_moves: list[str]  # titles of what moves once it is acknowledged; nothing while production stands
    movers: list[NextMovesView]  # the same by resource, each of them once, and who may move
    begins: list[str]  # titles of the operations that become active once it is acknowledged
    problem: TaskProblemView | None
    instruction: InstructionView | None  # as the model has it, where it has one


class TopicView(View):
    """A ROS 2 topic of the station. Without a message for `deadline` seconds it is fresh no longer; null: never."""

    type: str
    direction: str  # "in" or "out"
    resource: str
    last: float | None
    messages: int
    deadline: float | None
    fresh: bool
    peers: int  # matched publishers or subscribers
    trouble: str | None
    trouble_message: Message | None


class StandbyView(View):
    """Several stations share a database, and one of them commands the devices: this one if it is `active`.

    `holder` commands, or did last; null if nobody ever did. `standing_by` are others that would take the command over.
    `trouble` says why nobody knows how things are, or why this station would not.
    """

    name: str
    active: bool
    holder: str | None
    standing_by: list[str]
    trouble: str | None


class StationView(View):
    """The whole document."""

    station: StationIdentity
    tick: int
    time: float
    revision: int  # of the state: counts up with every change of a value or an activity
    mode: Mode
    packml: PackML
    standing: StationStanding
    silent: list[str]  # titles of the resources in service that are not heard
    failing: list[str]  # titles of those that are, and do not do what they should
    stepping: bool  # every start waits for a person's step
    breakpoints: dict[str, BreakpointView]  # by their numbers, in the order in which they were set
    cycle_stop: CycleStopView | None  # null where nobody wishes a pause when the product is done
    production: Production
    unconfirmed: bool  # whether there are estimates of which nobody has seen whether they are still true
    undecided: dict[str, UndecidedOutputView]  # outputs on which a person must decide before production is started
    control: ControlView | None  # null while nobody is in control
    resources: dict[str, ResourceView]
    variables: dict[str, VariableView]
    abilities: dict[str, AbilityView]
    operations: dict[str, OperationView]
    by_order: bool  # operations of work masters are active for jobs only
    jobs: dict[str, JobView]  # that are under way, or have ended and are not forgotten yet, in the order taken
    plan: PlanView
    errand: OperatorPlanView | None
    last_errand: LastOperatorPlanView | None
    forces: dict[str, ForceView]
    out_of_service: list[ServiceView]
    questions: list[QuestionView]
    last_correction: LastCorrectionView | None
    approvals: dict[str, ApprovalView]  # what waits for a second person
    who_can: WhoCanView | None  # null while all that there is takes part
    tasks: dict[str, TaskView]
    topics: dict[str, TopicView]
    overrides: dict[str, OverrideView]  # by resource and name, as in `ur10.speed`
    alarms: dict[str, AlarmView]
    named_alarm: str | None  # key of the one to name where help is needed and one alone has room, as on a watch
    way_back: WayBackView | None  # null while the state is safe
    analysis: AnalysisDocument | None  # what synthesis has found of the station, as far as it has got
    standby: StandbyView | None  # null where the station is alone
    deployment: DeploymentView | None  # null where the controller has not begun with one
