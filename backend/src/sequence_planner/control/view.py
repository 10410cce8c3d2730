"""What a running station shows: one document, written by the controller and read by everybody else.

The controller knows its clients only through this document. The server cuts it into numbered deltas
(`sequence_planner.web.stream`), REST serves parts of it, and the page's TypeScript types are generated from it.
Times are seconds since the epoch on the controller's clock; ages are left to the reader.
"""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.analysis.document import AnalysisDocument
from sequence_planner.control.alarm_view import AlarmView
from sequence_planner.control.approval_view import ApprovalView
from sequence_planner.control.control_view import ControlView
from sequence_planner.control.job_view import JobView
from sequence_planner.control.override_view import OverrideView
from sequence_planner.control.restart_view import (
    ErrandView,
    ForceView,
    LastCorrectionView,
    LastErrandView,
    QuestionView,
    ServiceView,
    UndecidedOutputView,
)
from sequence_planner.control.task_commands import ProblemKind
from sequence_planner.control.view_part import Value, View
from sequence_planner.control.vocabulary import Mode, PlanStatus, Production
from sequence_planner.control.way_back_view import WayBackView
from sequence_planner.control.who_can_view import WhoCanView
from sequence_planner.planning.plan import Contract


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
    """Who writes a variable."""

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
    """What is running."""

    name: str
    title: str
    description: str
    transport: str
    emulated: bool


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
    belief: BeliefView | None  # of an estimated one


class AbilityView(View):
    """The flags of a ground ability; null is undetermined."""

    resource: str
    title: str
    human: bool
    restart: bool
    enabled: bool | None
    executing: bool | None
    finished: bool | None
    running_since: float | None


class OperationView(View):
    """An operation: active until its goal holds.

    With `for_jobs` a work master has it: while the station works by order it is active only for a job under way. `job`
    is the one that has it, whether it is its turn or not.
    """

    title: str
    active: bool
    active_since: float | None
    completed: int
    goal: str
    precondition: str
    left_out: bool  # active, but not part of the plan, because not all goals can be planned together
    repeat: bool  # it becomes active again after it was completed, whenever its precondition holds
    for_jobs: bool
    job: str | None


class PlanStepView(View):
    """One start of the plan. `tick` counts from the tick in which the plan was made.

    As long as it is not over it is expected to start and to end at these times, which are told from what happened last
    and do not move on by themselves: what is late by now is expected at once, and what follows as much later.
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
    new: bool  # the plan that was replaced last did not have it
    waits_for: list[str]  # for the next step: what keeps it from starting, in the model's language


class DiagnosisView(View):
    """Why there is no plan at all: nothing is possible as long as all `members` stay as they are.

    `minimal` says that none of them could be spared. Each of `corrections` would bring a plan back; no fewer changes
    would.
    """

    members: list[str]
    minimal: bool
    corrections: list[str]


class DroppedStepView(View):
    """A start that the plan before had, and this one has not."""

    ability: str
    title: str
    resource: str


class ReplacementView(View):
    """A plan took the place of another: when, why, and what went with it. The steps say if they are new."""

    at: float
    why: str
    dropped: list[DroppedStepView]


class PlanView(View):
    """The live plan: what is done, what runs, what comes next and what that waits for."""

    status: PlanStatus
    reason: str  # why it was made, or why there is none
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


class TaskView(View):
    """A task that waits for a person. An acknowledgement must carry its id and revision."""

    revision: int
    resource: str
    ability: str
    title: str
    text: str
    created: float
    next_moves: list[str]  # titles of what moves once it is acknowledged; nothing while production stands
    problem: TaskProblemView | None


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
    production: Production
    unconfirmed: bool  # whether estimates came back from the journal that nobody has confirmed
    undecided: dict[str, UndecidedOutputView]  # outputs on which a person must decide before production is started
    control: ControlView | None  # null while nobody is in control
    resources: dict[str, ResourceView]
    variables: dict[str, VariableView]
    abilities: dict[str, AbilityView]
    operations: dict[str, OperationView]
    by_order: bool  # operations of work masters are active for jobs only
    jobs: dict[str, JobView]  # that are under way, or have ended and are not forgotten yet, in the order taken
    plan: PlanView
    errand: ErrandView | None
    last_errand: LastErrandView | None
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
    way_back: WayBackView | None  # null while the state is safe
    analysis: AnalysisDocument | None  # what synthesis has found of the station, as far as it has got
    standby: StandbyView | None  # null where the station is alone
    deployment: DeploymentView | None  # null where the controller has not begun with one
