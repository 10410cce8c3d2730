"""What the server does about sessions by itself: one that has ended loses control, and it notes who has been seen.

Rows that are over need no sweeping: they go whenever another of their kind comes.
"""

from __future__ import annotations

import asyncio

import structlog
from sqlalchemy import Connection

from sequence_planner.actor import SYSTEM
from sequence_planner.control.commands import CommandRefused, WithdrawControl
from sequence_planner.identity.sessions import find_live
from sequence_planner.storage.error import StorageError
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.identity import IdentityOffice

LOG = structlog.get_logger(__name__)
LOOK_EVERY = 0.5  # seconds


class Sweeper:
    """Looks twice a second whether the session in control still lives."""

    def __init__(self, office: IdentityOffice, controller: ControllerClient) -> None:
        self._office = office
        self._controller = controller
        self._in_trouble = False

    async def run(self) -> None:
        """Sweep until cancelled. What fails is tried again and again."""
        while True:
            try:
                await self._sweep()
                self._in_trouble = False
            except (StorageError, CommandRefused) as error:
                self._note(str(error))
            except Exception as error:  # whatever it is, who has lost a session must not keep control
                self._note(repr(error))
            await asyncio.sleep(LOOK_EVERY)

    def _note(self, reason: str) -> None:
        if not self._in_trouble:
            LOG.warning("sessions cannot be looked after now", reason=reason)
        self._in_trouble = True

    async def _sweep(self) -> None:
        await self._withdraw()
        await self._office.write_seen()

    async def _withdraw(self) -> None:
        view = self._controller.view
        if view is None or view.control is None or not self._controller.heard:
            return
        session, now = view.control.session, self._office.now()

        def lives(connection: Connection) -> bool:
            return find_live(connection, session, now) is not None

        if not await self._office.read(lives):
            await withdraw_control(self._controller, session)


async def withdraw_control(controller: ControllerClient, session: str) -> None:
    """Have the controller take control from a session that has ended, if it has it. Raises `CommandRefused`."""
    view = controller.view
    if view is not None and view.control is not None and view.control.session == session:
        await controller.send(WithdrawControl(actor=SYSTEM, session=session))
