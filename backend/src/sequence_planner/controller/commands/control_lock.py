"""The session in control: one at a time, and none after a start of the controller that is no deployment's.

Whoever acts on what moves devices must be it. Taking it over from somebody else is meant to be seen: the view tells who
has it, since when, and from whom it was taken.
"""

from __future__ import annotations

from sequence_planner.controller.commands.commands import CommandRefused
from sequence_planner.controller.views.control_lock import ControlView
from sequence_planner.core.actor import Actor


class ControlLock:
    """The session in control, if any."""

    def __init__(self, holder: ControlView | None = None) -> None:
        self._holder = holder

    def view(self) -> ControlView | None:
        """Return who is in control; None for nobody."""
        return self._holder

    def take(self, actor: Actor, over: str | None, now: float) -> None:
        """Let the session of `actor` be in control, `now` in seconds since the epoch.

        `over` is the session from which it is meant to be taken. Raises `CommandRefused` when another is in control by
        now, or `actor` is in no session.
        """
        if actor.session is None:
            detail = "Only a person who is signed in can take control; a key or a watch cannot."
            raise CommandRefused("no-session", "Control is for people", detail, 403)
        holder = self._holder
        if holder is not None and holder.session == actor.session:
            return
        if holder is not None and holder.session != over:
            detail = f"{holder.name} has control by now. Speak to them, then take it over from them."
            raise CommandRefused("control-changed", "Somebody else is in control", detail)
        self._holder = ControlView(
            session=actor.session,
            person=actor.id,
            name=actor.name,
            since=now,
            taken_from=None if holder is None else holder.name,
        )

    def release(self, actor: Actor) -> None:
        """Let nobody be in control. Raises `CommandRefused` when `actor` is not."""
        self.require(actor)
        self._holder = None

    def withdraw(self, session: str) -> None:
        """That session has ended, and is not in control any more."""
        if self._holder is not None and self._holder.session == session:
            self._holder = None

    def require(self, actor: Actor) -> None:
        """Raises `CommandRefused` unless the session of `actor` is in control."""
        holder = self._holder
        if holder is None:
            detail = "Nobody is in control. Take control, then try again."
            raise CommandRefused("control-needed", "Control is needed", detail)
        if holder.session != actor.session:
            detail = f"{holder.name} is in control. Only who is in control can do this; take it over if you must."
            raise CommandRefused("control-needed", "Control is needed", detail)
