"""What the server knows of how orders stand at the station, beside what is in the database."""

from __future__ import annotations

import asyncio
import contextlib
import time

from sequence_planner.actor import Actor
from sequence_planner.control.asks import AboutWorkMasters
from sequence_planner.control.commands import CommandRefused
from sequence_planner.control.work_master_view import WorkMastersView
from sequence_planner.mes.order import JobOrder
from sequence_planner.mes.refusal import OrderRefused
from sequence_planner.web.controller_client import ControllerClient

ASK_EVERY = 5.0  # seconds after which it is asked again what jobs consist of


class OrderDesk:
    """Looks after orders at the station of `controller`."""

    def __init__(self, controller: ControllerClient) -> None:
        self._controller = controller
        self._poked = asyncio.Event()
        self._masters: WorkMastersView | None = None
        self._asked = float("-inf")  # on the clock of `time.monotonic`

    def poke(self) -> None:
        """Somebody has changed an order."""
        self._poked.set()

    async def work_masters(self) -> WorkMastersView | None:
        """What jobs of the station consist of, as far as that was heard."""
        now = time.monotonic()
        if self._controller.heard and now - self._asked > ASK_EVERY:
            with contextlib.suppress(CommandRefused):
                self._masters = await self._controller.ask(AboutWorkMasters())
                self._asked = now
        return self._masters

    async def unknown_work_master(self, name: str) -> OrderRefused | None:
        """Why nothing of this work master can be ordered; None where it can, or nobody knows now."""
        masters = await self.work_masters()
        if masters is None or name in masters.work_masters:
            return None
        known = ", ".join(sorted(masters.work_masters)) or "none"
        detail = f"The station has no work master `{name}`. It has: {known}."[:1000]
        return OrderRefused("unknown-work-master", "There is no such work master", detail, 422)

    def waits_for(self, order: JobOrder) -> list[str]:
        """In words why nothing is done for an order now; empty where something is, or nothing is to be."""
        return []

    def require_control(self, actor: Actor) -> None:
        """Raises `CommandRefused` where a person lets something go on without being in control; a key never is."""
        view = self._controller.view if self._controller.heard else None
        control = None if view is None else view.control
        if actor.session is not None and (control is None or control.session != actor.session):
            detail = "Only who is in control lets devices go on. Take control, then try again."
            raise CommandRefused("control-needed", "Control is needed", detail)
