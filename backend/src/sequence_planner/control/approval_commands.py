"""What needs two people: one asks for it, another approves or declines it. Nothing happens before."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field

from sequence_planner.actor import Actor
from sequence_planner.control.command_base import CommandBase
from sequence_planner.control.restart_commands import (
    CorrectEstimates,
    DecideOutputs,
    ForceVariable,
    GivenValue,
    GivenValues,
    Why,
)

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
