"""Commands for alarms, jobs, recovery, approvals and human tasks, and the base class of all commands."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, StrictBool, StrictInt, StrictStr

from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.journal.entry import LONGEST_REASON

# What all commands have in common, and how one is refused.


class CommandBase(BaseModel):
    """`actor` is who asks, `reason` why, in that person's words.

    What moves devices is for the one session in control. `harmless` is what only ever stops them: it is carried out
    even where it cannot be recorded.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    for_control: ClassVar[bool] = False
    actor: Actor
    reason: str | None = Field(default=None, max_length=LONGEST_REASON)

    @property
    def needs_control(self) -> bool:
        """True if its actor must be in control."""
        return self.for_control

    @property
    def overtaken_by_pause(self) -> bool:
        """True if it is void where somebody pauses the station while it waits for its record."""
        return self.needs_control

    @property
    def harmless(self) -> bool:
        """True if it can only bring devices to rest."""
        return False

    @property
    def subject(self) -> str:
        """On what it acts, for the record."""
        return ""


class TextPlace(BaseModel):
    """What is wrong within a text that was sent, and where: from `start` to before `end`, in Unicode characters."""

    model_config = ConfigDict(frozen=True)
    start: int
    end: int
    message: str


class CommandRefused(Exception):
    """The controller does not carry out a command.

    `slug` names the kind of problem for machines (the `type` of RFC 9457), `detail` says to a person what to do;
    `status` is the HTTP status that says the same. `place` is where a text cannot be read.
    """

    def __init__(self, slug: str, title: str, detail: str, status: int = 409, place: TextPlace | None = None) -> None:
        super().__init__(detail)
        self.slug = slug
        self.title = title
        self.detail = detail
        self.status = status
        self.place = place


# What a person may do about an alarm, after ISA-18.2. None of it changes the alarm's cause.

LONGEST_SHELVING = 8 * 3600.0  # seconds


class AlarmCommand(CommandBase):
    """`alarm` is its key in the view."""

    alarm: str = Field(min_length=1, max_length=400)

    @property
    def subject(self) -> str:
        """The alarm."""
        return f"alarm {self.alarm}"


class AcknowledgeAlarm(AlarmCommand):
    """A person has seen the alarm that has been there `since`; refused for one that came later."""

    kind: Literal["acknowledge-alarm"] = "acknowledge-alarm"
    since: float


class ShelveAlarm(AlarmCommand):
    """A person does not want to be told of it for so many seconds."""

    kind: Literal["shelve-alarm"] = "shelve-alarm"
    reason: str = Field(min_length=1, max_length=LONGEST_REASON)
    seconds: float = Field(gt=0, le=LONGEST_SHELVING)


class UnshelveAlarm(AlarmCommand):
    """It is told again."""

    kind: Literal["unshelve-alarm"] = "unshelve-alarm"


class SuppressAlarm(AlarmCommand):
    """An engineer takes the alarm out of service, until it is put back."""

    kind: Literal["suppress-alarm"] = "suppress-alarm"
    reason: str = Field(min_length=1, max_length=LONGEST_REASON)


class RestoreAlarm(AlarmCommand):
    """An alarm that is out of service is told again."""

    kind: Literal["restore-alarm"] = "restore-alarm"


# What is asked of a station that works by order: which jobs it takes, in which order, and how they go on.

JobId = Annotated[str, Field(pattern=r"^[A-Za-z0-9._-]{1,64}$")]
Operation = Annotated[str, Field(min_length=1, max_length=400)]
_NO_CONTROL = (ActorKind.KEY, ActorKind.SYSTEM)  # orders come from other systems, which never are in control


class OrderCommand(CommandBase):
    """A command about jobs. Only a person has to be in control for it."""

    @property
    def needs_control(self) -> bool:
        """A job moves devices; it goes on in the mode that a person has chosen."""
        return self.actor.kind not in _NO_CONTROL


class TakeJob(OrderCommand):
    """Work a job of a work master. Asking for it again changes nothing."""

    kind: Literal["take-job"] = "take-job"
    job: JobId
    title: str = Field(min_length=1, max_length=200)
    work_master: str = Field(min_length=1, max_length=400)

    @property
    def subject(self) -> str:
        """The job."""
        return f"job {self.job}"


class JobOperation(BaseModel):
    """An operation of a job."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    job: JobId
    operation: Operation


class JobWait(JobOperation):
    """It is not eligible before the operations it waits `for` are completed, or their jobs are over."""

    for_: Annotated[list[JobOperation], Field(alias="for", max_length=1000)]
    model_config = ConfigDict(frozen=True, extra="forbid", validate_by_name=True, serialize_by_alias=True)


class SequenceJobs(OrderCommand):
    """The order between operations of different jobs, in place of what was said before.

    What it says of jobs that are not under way, and of operations that they do not have, is ignored.
    """

    kind: Literal["sequence-jobs"] = "sequence-jobs"
    waits: list[JobWait] = Field(max_length=10_000)


class CommandJob(OrderCommand):
    """A job is paused, resumed, stopped once what is active is completed, or aborted at once."""

    kind: Literal["command-job"] = "command-job"
    job: JobId
    what: Literal["pause", "resume", "stop", "abort"]

    @property
    def needs_control(self) -> bool:
        """To go on needs it; anybody who may act may keep a job from going on."""
        return self.what == "resume" and super().needs_control

    @property
    def subject(self) -> str:
        """The job."""
        return f"job {self.job}"


class ForgetJob(OrderCommand):
    """A job that has ended is shown no longer: whoever ordered it knows how it ended."""

    kind: Literal["forget-job"] = "forget-job"
    job: JobId

    @property
    def subject(self) -> str:
        """The job."""
        return f"job {self.job}"


class SetByOrder(CommandBase):
    """With `on`, the operations of work masters are active for jobs only; else whenever their preconditions hold."""

    kind: Literal["work-by-order"] = "work-by-order"
    for_control: ClassVar[bool] = True
    reason: str = Field(min_length=1, max_length=LONGEST_REASON)
    on: bool


JobCommand = TakeJob | SequenceJobs | CommandJob | ForgetJob | SetByOrder


# What a person may ask of a station that is not as it should be: corrections, decisions, ways back, and forces.

GivenValue = StrictBool | StrictInt | StrictStr
GivenValues = Annotated[dict[str, GivenValue], Field(min_length=1, max_length=200)]
Why = Annotated[str, Field(min_length=1, max_length=LONGEST_REASON)]


class CorrectEstimates(CommandBase):
    """Estimated variables get other values, all at once; refused if the state is not at `revision` any more."""

    kind: Literal["correct-estimates"] = "correct-estimates"
    for_control: ClassVar[bool] = True
    reason: Why
    values: GivenValues
    revision: int

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(sorted(self.values))


class UndoCorrection(CommandBase):
    """The last correction, made on `revision`, is taken back, as long as its variables have the values that it gave."""

    kind: Literal["undo-correction"] = "undo-correction"
    for_control: ClassVar[bool] = True
    reason: Why
    revision: int


class ConfirmEstimates(CommandBase):
    """A person has seen that these estimated variables are as the station believes."""

    kind: Literal["confirm-estimates"] = "confirm-estimates"
    values: GivenValues  # as they were seen; refused if one is another by now
    reason: Why

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(sorted(self.values))


class DecideOutputs(CommandBase):
    """Outputs that came back from the journal, and would move devices, shall have these values."""

    kind: Literal["decide-outputs"] = "decide-outputs"
    for_control: ClassVar[bool] = True
    reason: Why
    values: GivenValues

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(sorted(self.values))


class TakeErrand(CommandBase):
    """Carry out a plan that was offered, and nothing else; refused if the state has moved since.

    `starts` and `corrections` repeat what the person was shown, as the second confirmation of it.
    """

    kind: Literal["take-errand"] = "take-errand"
    for_control: ClassVar[bool] = True
    reason: Why
    offer: str
    starts: list[str] = Field(max_length=1000)
    corrections: dict[str, GivenValue] = Field(default_factory=dict, max_length=200)

    @property
    def subject(self) -> str:
        """The offer."""
        return f"offer {self.offer}"


class TryAbility(CommandBase):
    """One run of an ability alone. `real_devices` confirms that devices may move which are not emulated ones."""

    kind: Literal["try-ability"] = "try-ability"
    for_control: ClassVar[bool] = True
    ability: str = Field(max_length=400)
    real_devices: bool = False

    @property
    def subject(self) -> str:
        """The ability."""
        return self.ability


class StopErrand(CommandBase):
    """A command to start no more of what is carried out, and to call off what is only tried."""

    kind: Literal["stop-errand"] = "stop-errand"

    @property
    def harmless(self) -> bool:
        """It only ends starts."""
        return True


class ForceVariable(CommandBase):
    """A measured variable or an output has this value, whatever its device or an ability says, for so many seconds."""

    kind: Literal["force-variable"] = "force-variable"
    for_control: ClassVar[bool] = True
    reason: Why
    name: str
    value: GivenValue
    seconds: float = Field(gt=0, le=3600)

    @property
    def subject(self) -> str:
        """The variable."""
        return self.name


class ReleaseForce(CommandBase):
    """A forced variable is as it comes again."""

    kind: Literal["release-force"] = "release-force"
    for_control: ClassVar[bool] = True
    name: str

    @property
    def subject(self) -> str:
        """The variable."""
        return self.name


# What needs two people: one asks for it, another approves or declines it. Nothing happens before.

ApprovedCommand = CorrectEstimates | DecideOutputs | ForceVariable
RequestId = Annotated[str, Field(min_length=1, max_length=40)]


class ActPart(BaseModel):
    """Base of what can be asked for."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class CorrectionAct(ActPart):
    """Estimates get other values."""

    kind: Literal["correction"] = "correction"
    values: GivenValues

    @property
    def names(self) -> list[str]:
        """The variables."""
        return sorted(self.values)

    def command(self, actor: Actor, reason: str, revision: int) -> ApprovedCommand:
        """The command that does it."""
        return CorrectEstimates(actor=actor, reason=reason, values=self.values, revision=revision)


class OutputsAct(ActPart):
    """Outputs that came back from the journal get these values."""

    kind: Literal["outputs"] = "outputs"
    values: GivenValues

    @property
    def names(self) -> list[str]:
        """The variables."""
        return sorted(self.values)

    def command(self, actor: Actor, reason: str, revision: int) -> ApprovedCommand:
        """The command that does it."""
        return DecideOutputs(actor=actor, reason=reason, values=self.values)


class ForceAct(ActPart):
    """A measured variable or an output has a value for so many seconds."""

    kind: Literal["force"] = "force"
    name: str = Field(max_length=400)
    value: GivenValue
    seconds: float = Field(gt=0, le=3600)

    @property
    def names(self) -> list[str]:
        """The variable."""
        return [self.name]

    def command(self, actor: Actor, reason: str, revision: int) -> ApprovedCommand:
        """The command that does it."""
        return ForceVariable(actor=actor, reason=reason, name=self.name, value=self.value, seconds=self.seconds)


Act = Annotated[CorrectionAct | OutputsAct | ForceAct, Field(discriminator="kind")]


class RequestApproval(CommandBase):
    """A person wants this to be done in the state of `revision`, and asks for somebody who approves it."""

    kind: Literal["request-approval"] = "request-approval"
    for_control: ClassVar[bool] = True
    reason: Why
    act: Act
    revision: int

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(self.act.names)


class AnswerRequest(CommandBase):
    """Somebody answers a request, and repeats what it asks for, as the second confirmation of it."""

    request: RequestId
    act: Act

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(self.act.names)


class ApproveRequest(AnswerRequest):
    """A second person has seen what would follow in the state of `revision`, and wants it too: it is done."""

    kind: Literal["approve-request"] = "approve-request"
    revision: int

    @property
    def overtaken_by_pause(self) -> bool:
        """A force may move a device."""
        return True


class DeclineRequest(AnswerRequest):
    """It is not done: a second person does not want it, or whoever has asked for it wants it no more."""

    kind: Literal["decline-request"] = "decline-request"


# What a person may say about a task that waits. A command names the task and the revision that was seen.


class TaskCommand(CommandBase):
    """Refused when the task or its revision is gone, so that a late or repeated one is never about another task."""

    task: str
    revision: int

    @property
    def subject(self) -> str:
        """The task."""
        return f"task {self.task}"


class AcknowledgeTask(TaskCommand):
    """A person says that the task is done."""

    kind: Literal["acknowledge-task"] = "acknowledge-task"


class ProblemKind(StrEnum):
    """What is in the way, as far as one touch can say it."""

    MISSING = "missing"  # a part
    DAMAGED = "damaged"
    TOOL = "tool"
    OTHER = "other"


class ReportProblem(TaskCommand):
    """A person says that the task cannot be done as things are; `what` and the reason may say what is in the way."""

    kind: Literal["report-problem"] = "report-problem"
    what: ProblemKind | None = None


class SolveProblem(TaskCommand):
    """A person says that the task can be done after all."""

    kind: Literal["solve-problem"] = "solve-problem"
