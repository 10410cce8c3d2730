"""Commands for how the station executes: mode, production, steps, service, overrides, deployment, who is in control."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictBool

from sequence_planner.controller.commands.command import Command, Predicate, Route, Why
from sequence_planner.controller.views.station import FieldValue, MadeBreakpointView
from sequence_planner.execution.vocabulary import Mode, ServiceKind

_REASON_TEXT = "To ask for it is all that there is to say, but perhaps why."


class SetMode(Command):
    """Change the mode of execution. To go on takes control; to pause and to hold is for anybody, and never refused.

    200 says that the station is stopped and the journal does not have it yet; 503 `stop-not-recorded` that it is
    stopped and nowhere written down.
    """

    routes = (
        Route(
            "PUT",
            "/mode",
            "set_mode",
            tag="modes",
            body="ModeBody",
            body_text="The mode that is wanted. Restart mode has ways of its own, in and out.",
            # By their words: of members of an enumeration a wrong request would be shown Python's way to write them.
            types={"mode": Literal["automatic", "paused", "hold"]},
        ),
    )
    kind: Literal["set-mode"] = "set-mode"
    mode: Literal[Mode.AUTOMATIC, Mode.PAUSED, Mode.HOLD]

    @property
    def needs_control(self) -> bool:
        """To go on needs it; anybody who may act may pause and hold."""
        return not self.harmless

    @property
    def harmless(self) -> bool:
        """Pausing and holding are."""
        return self.mode is not Mode.AUTOMATIC


class EnterRestart(Command):
    """Enter restart mode: operations wait, what runs may finish, and nothing is started by it. It takes control."""

    routes = (Route("POST", "/restart/enter", "enter_restart", tag="modes", body="ReasonBody", body_text=_REASON_TEXT),)
    kind: Literal["enter-restart"] = "enter-restart"
    for_control = True


class LeaveRestart(Command):
    """Leave restart mode for the paused one; to go on is another request. It takes control."""

    routes = (Route("POST", "/restart/leave", "leave_restart", tag="modes", body="ReasonBody", body_text=_REASON_TEXT),)
    kind: Literal["leave-restart"] = "leave-restart"
    for_control = True


class StartProduction(Command):
    """Allow outputs to be published; nothing else implies it. It takes control."""

    routes = (
        Route("POST", "/production/start", "start_production", tag="modes", body="ReasonBody", body_text=_REASON_TEXT),
    )
    kind: Literal["start-production"] = "start-production"
    for_control = True


class SetCycleStop(Command):
    """Have the station pause when the product that is in work is done, or not. Anybody may ask for it, as for a pause;
    to take that back takes control.

    Of a station that works by order, no job begins meanwhile, and it pauses once those that have begun are over; else
    it pauses when the operation that comes after all others of a work master is completed. Each change of the mode ends
    it. 409 `no-product-end` where the model does not tell when a product is done.
    """

    routes = (
        Route(
            "PUT",
            "/mode/cycle-stop",
            "set_cycle_stop",
            tag="modes",
            body="CycleStopBody",
            body_text="Whether the station is to pause when the product is done.",
        ),
    )
    kind: Literal["set-cycle-stop"] = "set-cycle-stop"
    on: StrictBool

    @property
    def needs_control(self) -> bool:
        """To go on needs it."""
        return not self.on


class SetStepping(Command):
    """For commissioning: have every single start wait for a person's step, or none. It takes control."""

    routes = (
        Route(
            "PUT",
            "/stepping",
            "set_stepping",
            tag="modes",
            body="SteppingBody",
            body_text="Whether every start is to wait for a step.",
            role="engineer",
        ),
    )
    kind: Literal["set-stepping"] = "set-stepping"
    for_control = True
    on: StrictBool


class TakeStep(Command):
    """Allow one start, as soon as there is one. It takes control."""

    routes = (
        Route(
            "POST",
            "/stepping/step",
            "take_step",
            tag="modes",
            body="ReasonBody",
            body_text=_REASON_TEXT,
            role="engineer",
        ),
    )
    kind: Literal["take-step"] = "take-step"
    for_control = True


class SetService(Command):
    """Take a resource, an ability or an operation out of service, or put it back. It takes control."""

    routes = (
        Route(
            "PUT",
            "/availability/{kind}/{name}",
            "set_availability",
            tag="modes",
            body="ServiceBody",
            body_text="Whether it is to be in service, and why.",
            refusals=(404, 409, 504),
            names={"of": "kind"},
        ),
    )
    kind: Literal["set-service"] = "set-service"
    for_control = True
    about = "{of} {name}"
    reason: Why
    of: ServiceKind
    name: Annotated[str, Field(max_length=400)]
    in_service: StrictBool


class SetBreakpoint(Command):
    """For commissioning: have the station pause as soon as a condition becomes true, after the tick in which it does.

    It takes no control, as pausing does not. It is forgotten when the controller begins anew. 422 `bad-predicate` names
    the place; 409 `too-many-breakpoints`.
    """

    routes = (
        Route(
            "POST",
            "/breakpoints",
            "set_breakpoint",
            tag="modes",
            body="BreakpointBody",
            body_text="The condition, in the model's language.",
            role="engineer",
            refusals=(409, 422, 504),
        ),
    )
    kind: Literal["set-breakpoint"] = "set-breakpoint"
    about = "{condition}"
    makes = MadeBreakpointView
    condition: Predicate


class RemoveBreakpoint(Command):
    """Have the station pause for a condition no more. A pause that has come of it stays."""

    routes = (
        Route(
            "DELETE",
            "/breakpoints/{id}",
            "remove_breakpoint",
            tag="modes",
            role="engineer",
            refusals=(404, 409, 504),
        ),
    )
    kind: Literal["remove-breakpoint"] = "remove-breakpoint"
    about = "{id}"
    id: Annotated[str, Field(pattern=r"^[0-9]{1,9}$")]


class Deploy(Command):
    """Let another model take the place of the one that runs, and begin anew with it. Its files lie in the folder
    `staged` beside the controller's socket; `revision` and `name` are those it was saved under. With `reset` emulated
    devices and the station begin as the new model says, else they go on as they are. `approved_by` are the names of
    those who have approved the revision; the model that runs may ask for one at least.
    """

    kind: Literal["deploy"] = "deploy"
    for_control = True
    about = "revision {name}"
    reason: Why
    revision: str = Field(pattern=r"^[0-9a-f]{40}$")
    name: str = Field(max_length=200)
    staged: str = Field(pattern=r"^deploy-[0-9a-f]{16}$")
    reset: bool = False
    approved_by: tuple[Annotated[str, Field(max_length=200)], ...] = ()


class SetOverride(Command):
    """Set fields of an override, such as `ur10.speed`, within the bounds of the model; they expire as it says.

    It takes control. 422 `out-of-bounds` names the field and what is allowed; nothing has changed then.
    """

    routes = (
        Route(
            "PUT",
            "/overrides/{name}",
            "set_override",
            tag="actions",
            body="OverrideBody",
            body_text="The values of the fields that are to be set; others are as they come.",
            refusals=(404, 409, 504),
        ),
    )
    kind: Literal["set-override"] = "set-override"
    for_control = True
    about = "override {name}"
    name: Annotated[str, Field(max_length=200)]
    fields: Annotated[dict[str, FieldValue], Field(min_length=1, max_length=100)]


class ClearOverride(Command):
    """Take back what is set, if anything is. It takes control."""

    routes = (Route("DELETE", "/overrides/{name}", "clear_override", tag="actions", refusals=(404, 409, 504)),)
    kind: Literal["clear-override"] = "clear-override"
    for_control = True
    about = "override {name}"
    name: Annotated[str, Field(max_length=200)]


class TakeControl(Command):
    """Put this session in control; 409 `control-changed` when by now another is than the one that was seen."""

    routes = (
        Route(
            "PUT",
            "/control-lock",
            "take_control",
            tag="control",
            body="ControlBody",
            body_text="The session from which control is taken over, null where nobody is in control as far as the "
            "person sees.",
            types={"over": Annotated[str, Field(min_length=1, max_length=200)] | None},
        ),
    )
    kind: Literal["take-control"] = "take-control"
    over: str | None = None


class ReleaseControl(Command):
    """Give control up."""

    routes = (Route("DELETE", "/control-lock", "release_control", tag="control"),)
    kind: Literal["release-control"] = "release-control"


class WithdrawControl(Command):
    """A session has ended; if it was in control, nobody is now."""

    kind: Literal["withdraw-control"] = "withdraw-control"
    session: str
