"""Another model in the place of the one that runs: its files are put into the folder of the model, and the controller
begins anew.

It begins as after any other end: estimates and outputs come back from the journal as far as they fit, nothing is
published, and a person starts production. Only who was in control still is. Until all of it runs nothing is written
into the journal, so that the model before can take over again where the start fails.
"""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path

from sequence_planner.actor import SYSTEM
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.control_view import ControlView
from sequence_planner.control.known import Known
from sequence_planner.control.production_commands import Deploy
from sequence_planner.control.view import DeploymentState, DeploymentView
from sequence_planner.deployment_folder import DeploymentFolder, DeploymentNote
from sequence_planner.emulation.standing import standing_file
from sequence_planner.exchange import exchanging
from sequence_planner.journal.entry import LONGEST_REASON, Entry, Outcome
from sequence_planner.workshop.files import Contents, Files, put_in_place, read_contents, read_files

ANSWERED = 0.3  # seconds in which who has asked for it gets the answer
LOOK_EVERY = 0.1  # seconds


class DeployedError(Exception):
    """The files of another model are in place, and this controller makes room for one that runs it."""


class Deploying:
    """Puts what is staged beside the `socket` into the folder `model`."""

    def __init__(self, model: Path, socket: Path, emulated: bool) -> None:
        self._model = model
        self._beside = socket.parent
        self._emulated = emulated
        self._in_place = asyncio.Event()
        self._accepted: Deploy | None = None

    def check(self, command: Deploy) -> None:
        """Raises `CommandRefused` for what can never be done here."""
        if command.reset and not self._emulated:
            detail = "Only emulated devices can begin anew as the model says. Deploy without resetting the simulation."
            raise CommandRefused("not-emulated", "There are real devices", detail)

    def refusal(self) -> CommandRefused | None:
        """Why nothing but a stop is carried out any more, once a deployment was accepted; None else.

        What was done now would be of the model before, and whoever asks for it means one or the other.
        """
        accepted = self._accepted
        return None if accepted is None else under_way(accepted.name, accepted.actor.name)

    async def carry_out(self, command: Deploy, control: ControlView | None, now: float) -> None:
        """Put the files in place; `control` is who is in control. Raises `CommandRefused`; all is as it was then."""
        self._accepted = command
        try:
            await self._put(command, control, now)
        except BaseException:
            self._accepted = None
            raise
        self._in_place.set()

    async def _put(self, command: Deploy, control: ControlView | None, now: float) -> None:
        folder = DeploymentFolder(self._beside)
        note = DeploymentNote(
            revision=command.revision,
            name=command.name,
            by=command.actor.name,
            time=now,
            reset=command.reset,
            control=control,
        )
        try:
            files = await asyncio.to_thread(read_files, self._beside / command.staged)
            if "station.yaml" not in files:
                raise CommandRefused("not-staged", "The files are not there", "Try once more to deploy the revision.")
            before = await asyncio.to_thread(read_contents, self._model)
            await asyncio.to_thread(folder.begin, note, before)
            await asyncio.to_thread(_put_in_place, files, self._model, before, note)
        except OSError as error:
            folder.remove()
            detail = f"The files of the model cannot be written: {error.strerror}. Look at who may write to its folder."
            raise CommandRefused("model-not-written", "The model cannot be written", detail) from error

    async def end(self) -> None:
        """Wait until files are in place. Raises `DeployedError` then."""
        await self._in_place.wait()
        await asyncio.sleep(ANSWERED)
        raise DeployedError


def under_way(name: str, by: str) -> CommandRefused:
    """Why nothing is commanded while a deployment is under way."""
    detail = (
        f"{by} has deployed {name}, and the station begins anew with it. Nothing is published until it runs and "
        "somebody starts production. Try again then."
    )
    return CommandRefused("deployment-under-way", "Another model is being started", detail, 503)


def _put_in_place(files: Files, model: Path, before: Contents, note: DeploymentNote) -> None:
    with exchanging(model, before, note.model_dump_json()):
        put_in_place(files, model)


class LastDeployment:
    """The deployment with which this controller begins, or for the failure of which it does; or none."""

    def __init__(self, socket: Path) -> None:
        self._beside = socket.parent
        self._folder = DeploymentFolder(self._beside)
        self._note = self._folder.note()
        self._starting = self._note is not None and self._note.undone is None
        self._stood_by = False

    @property
    def starting(self) -> bool:
        """Whether it is still to be seen that the station runs the new model."""
        self._starting = self._starting and self._folder.exists
        return self._starting

    def view(self) -> DeploymentView | None:
        """What is shown of it."""
        if (note := self._note) is None:
            return None
        state = DeploymentState.STARTING if self.starting else DeploymentState.RUNS
        state = state if note.undone is None else DeploymentState.UNDONE
        return DeploymentView(
            revision=note.revision, name=note.name, by=note.by, at=note.time, state=state, why=note.undone
        )

    @property
    def control(self) -> ControlView | None:
        """Who is in control as this controller begins."""
        return None if self._note is None or self._stood_by else self._note.control

    def known(self, known: Known) -> Known:
        """What is known as a controller begins after it."""
        if (note := self._note) is None:
            return known
        known = replace(known, deployment=self.view())
        if self._stood_by:  # another station has commanded since, and the journal tells what that has done
            return known
        known = replace(known, control=self.control)
        if not note.reset or note.undone is not None or known.beginning is None:
            return known
        values = known.beginning.as_the_model_says()
        return replace(known, beginning=values, beliefs={}, left_out=())

    async def wait_for_devices(self, emulated: bool) -> None:
        """Wait until the emulated devices are up, where a new model begins with such."""
        up = standing_file(self._beside)
        while True:
            if not emulated or not self.starting or up.exists():
                return
            await asyncio.sleep(LOOK_EVERY)

    def refusal(self) -> CommandRefused | None:
        """Why nothing can be commanded yet; None where that is not because of a deployment."""
        note = self._note
        return under_way(note.name, note.by) if note is not None and self.starting else None

    def tell_that_it_waits(self, *, waits: bool) -> None:
        """Whether somebody else commands the devices, so that the start takes as long as that. Raises `OSError`."""
        if self.starting:
            self._folder.tell_that_it_waits(waits=waits)

    def tell_that_it_runs(self) -> None:
        """The station runs the new model. Raises `OSError`."""
        if self.starting:
            self._folder.tell_that_it_runs()

    def tell_that_it_stands_by(self) -> None:
        """The model is prepared, and another station commands: the start has succeeded. Raises `OSError`."""
        self._stood_by = True
        self.tell_that_it_runs()

    def entry(self) -> Entry | None:
        """For the record, where the files were brought back; None else."""
        note = self._note
        if note is None or note.undone is None:
            return None
        return Entry(
            actor=SYSTEM,
            action="undo-deployment",
            subject=f"revision {note.name}",
            details={"revision": note.revision, "because": note.undone},
            reason=f"it could not be started: {note.undone}"[:LONGEST_REASON],
            outcome=Outcome.DONE,
        )

    def forget(self) -> None:
        """What became of it is recorded. A later deployment, which may have begun meanwhile, is not forgotten."""
        if self._note is not None and self._note.undone is not None and self._folder.note() == self._note:
            self._folder.remove()
