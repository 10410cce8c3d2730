"""The session in control: one at a time, and none after a start of the controller that is no deployment's.

Whoever acts on what moves devices must be it. Taking it over from somebody else is meant to be seen: the view tells who
has it, since when, and from whom it was taken.
"""

from __future__ import annotations

from sequence_planner.controller.commands.command import CommandRefused, handles
from sequence_planner.controller.commands.execution import ReleaseControl, TakeControl, WithdrawControl
from sequence_planner.controller.views.part import ControlView
from sequence_planner.core.actor import Actor
from sequence_planner.core.clock import Timestamp
from sequence_planner.texts.message import message


class ControlLock:
    """The session in control, if any."""

    def __init__(self, holder: ControlView | None = None) -> None:
        self.holder = holder

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"control": self.holder}

    @handles(TakeControl)
    def take(self, command: TakeControl, moment: Timestamp) -> None:
        """Let the session of the actor be in control, unless another is by now than the one from which it is taken."""
        actor = command.actor
        if actor.session is None:
            raise CommandRefused("no-session", message("refused.no-session.person"), 403)
        holder = self.holder
        if holder is not None and holder.session == actor.session:
            return
        if holder is not None and holder.session != command.over:
            raise CommandRefused("control-changed", message("refused.control-changed.holder", holder=holder.name))
        self.holder = ControlView(
            session=actor.session,
            person=actor.id,
            name=actor.name,
            since=moment.epoch,
            taken_from=None if holder is None else holder.name,
        )

    @handles(ReleaseControl)
    def release(self, command: ReleaseControl, moment: Timestamp) -> None:
        """Let nobody be in control."""
        self.require(command.actor)
        self.holder = None

    @handles(WithdrawControl)
    def withdraw(self, command: WithdrawControl, moment: Timestamp) -> None:
        """A session has ended, and is not in control any more."""
        if self.holder is not None and self.holder.session == command.session:
            self.holder = None

    def require(self, actor: Actor) -> None:
        """Raises `CommandRefused` unless the session of `actor` is in control."""
        holder = self.holder
        if holder is None:
            raise CommandRefused("control-needed", message("refused.control-needed.nobody"))
        if holder.session != actor.session:
            raise CommandRefused("control-needed", message("refused.control-needed.holder", holder=holder.name))
