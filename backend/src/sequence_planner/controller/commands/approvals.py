"""Commands for forces, and for what needs two people: one asks for it, another approves or declines it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Annotated, Literal

from pydantic import Field

from sequence_planner.controller.commands.command import Command, GivenValue, GivenValues, Revision, Route, Why
from sequence_planner.controller.commands.recovery import CorrectEstimates, DecideOutputs
from sequence_planner.core.actor import Actor
from sequence_planner.core.data_models import DataModel

LONGEST_FORCE = 3600.0  # seconds
_REFUSALS = (404, 409, 422, 504)

VariableName = Annotated[str, Field(max_length=400)]


class ForceVariable(Command):
    """Let a measured variable or an output have a value for a time, whatever its device or an ability says.

    It takes control. 422 `not-in-domain` says which values there are, and 409 `force-unsafe` that the value would lead
    out of the safe states; nothing has changed then.
    """

    routes = (
        Route(
            "PUT",
            "/forces/{name}",
            "force",
            tag="modes",
            body="ForceBody",
            body_text="The value that the variable is to have, for how many seconds, and why.",
            role="engineer",
            refusals=(404, 409, 504),
        ),
    )
    kind: Literal["force-variable"] = "force-variable"
    for_control = True
    about = "{name}"
    reason: Why
    name: VariableName
    value: GivenValue
    seconds: Annotated[float, Field(gt=0, le=LONGEST_FORCE, strict=True)]

    @property
    def for_two(self) -> Collection[str]:
        """The variable."""
        return (self.name,)


class ReleaseForce(Command):
    """Let a variable be as it comes again, if it is forced. It takes control."""

    routes = (
        Route("DELETE", "/forces/{name}", "release_force", tag="modes", role="engineer", refusals=(404, 409, 504)),
    )
    kind: Literal["release-force"] = "release-force"
    for_control = True
    about = "{name}"
    name: VariableName


# What can be asked for. Nothing happens before it is approved.

ApprovedCommand = CorrectEstimates | DecideOutputs | ForceVariable


class ActPart(DataModel):
    """Base of what can be asked for."""


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


class ActCommand(Command):
    """Base of what is said about an act: asking for it, approving it, declining it."""

    act: Act

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(self.act.names)


class RequestApproval(ActCommand):
    """Ask a second person to approve something, within two minutes and in the state of `revision`."""

    routes = (
        Route(
            "POST",
            "/approvals/corrections",
            "request_correction_approval",
            tag="approvals",
            body="CorrectionRequestBody",
            body_text="A correction, the revision of the state in which its preview was looked at, and why.",
            text="Ask a second person to approve a correction, within two minutes and in this state. It takes control."
            "\n\n409 `no-approval-needed` where none of its variables asks for that.",
            refusals=_REFUSALS,
            types={"act": CorrectionAct},
        ),
        Route(
            "POST",
            "/approvals/restored-outputs",
            "request_outputs_approval",
            tag="approvals",
            body="OutputsRequestBody",
            body_text="A decision on outputs that came back, the revision of the state that was seen, and why.",
            text="Ask a second person to approve a decision on outputs, as a correction.",
            refusals=_REFUSALS,
            types={"act": OutputsAct},
        ),
        Route(
            "POST",
            "/approvals/forces",
            "request_force_approval",
            tag="approvals",
            body="ForceRequestBody",
            body_text="A force, the revision of the state that was seen, and why.",
            text="Ask a second person to approve a force, as a correction.",
            role="engineer",
            refusals=_REFUSALS,
            types={"act": ForceAct},
        ),
    )
    kind: Literal["request-approval"] = "request-approval"
    for_control = True
    reason: Why
    revision: Revision


class AnswerRequest(ActCommand):
    """Somebody answers a request, and repeats what it asks for, as the second confirmation of it."""

    request: Annotated[str, Field(min_length=1, max_length=40)]


class ApproveRequest(AnswerRequest):
    """Approve what another person has asked for: it is done at once, in the names of both.

    403 `same-person` for who has asked, 409 `request-gone` when it was answered, overtaken or took too long.
    """

    routes = (
        Route(
            "POST",
            "/approvals/{request}/approve",
            "approve_request",
            tag="approvals",
            body="ApprovalBody",
            body_text="What the second person has looked at and wants too, and the revision of the state in which that "
            "was.",
            refusals=_REFUSALS,
        ),
    )
    kind: Literal["approve-request"] = "approve-request"
    revision: Revision

    @property
    def overtaken_by_pause(self) -> bool:
        """A force may move a device."""
        return True


class DeclineRequest(AnswerRequest):
    """Decline what another person has asked for, or withdraw what one has asked for oneself."""

    routes = (
        Route(
            "POST",
            "/approvals/{request}/decline",
            "decline_request",
            tag="approvals",
            body="RefusalBody",
            body_text="What is declined or withdrawn.",
            refusals=_REFUSALS,
        ),
    )
    kind: Literal["decline-request"] = "decline-request"
