"""Preparation of a station at start, and deployment of another model with fallback to the previous one."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import structlog

from sequence_planner.analysis.analysis import FINDINGS, Analysis
from sequence_planner.analysis.report import AnalysisDocument, document_of, error_document
from sequence_planner.analysis.store import key, known_supervisor, read, write
from sequence_planner.analysis.worker import analysing
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import Deploy
from sequence_planner.controller.controller import Controller
from sequence_planner.controller.deployment_folder import DeploymentFolder, DeploymentNote
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.part import ControlView
from sequence_planner.controller.views.preparing import preparing_view
from sequence_planner.controller.views.station import (
    DeploymentState,
    DeploymentView,
    StandbyView,
    StationIdentity,
    StationView,
    TaskView,
)
from sequence_planner.core.actor import SYSTEM
from sequence_planner.journal.entry import LONGEST_REASON, Entry, Outcome
from sequence_planner.model.exchange import exchanging
from sequence_planner.model.files import Contents, Files, put_in_place, read_contents, read_files
from sequence_planner.model.source import Finding
from sequence_planner.process.task import TooLargeError, WorkerError
from sequence_planner.simulation.device_state import standing_file
from sequence_planner.synthesis.guards import SupervisorGuard
from sequence_planner.texts.message import as_it_was, joined, message

# Another model in the place of the one that runs: its files are put into the folder of the model, and the controller
# begins anew.
#
# It begins as after any other end: estimates and outputs come back from the journal as far as they fit, nothing is
# published, and a person starts production. Only who was in control still is. Until all of it runs nothing is written
# into the journal, so that the model before can take over again where the start fails.

ANSWERED = 0.3  # seconds in which who has asked for it gets the answer
LOOK_EVERY = 0.1  # seconds


class DeployedError(Exception):
    """The files of another model are in place, and this controller makes room for one that runs it."""


class Deploying:
    """Puts what is staged beside the `socket` into the folder `model`. With `dual` approval, only what a second person
    has approved.
    """

    def __init__(self, model: Path, socket: Path, *, emulated: bool, dual: bool) -> None:
        self._model = model
        self._beside = socket.parent
        self._emulated = emulated
        self._dual = dual
        self._in_place = asyncio.Event()
        self._accepted: Deploy | None = None

    def check(self, command: Deploy) -> None:
        """Raises `CommandRefused` for what can never be done here."""
        if command.reset and not self._emulated:
            raise CommandRefused("not-emulated", message("refused.not-emulated.reset"))
        if self._dual and not command.approved_by:
            raise CommandRefused("not-approved", message("refused.not-approved.nobody", name=command.name))

    def refusal(self) -> CommandRefused | None:
        """Return why nothing but a stop is carried out any more, once a deployment was accepted; None else.

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
                raise CommandRefused("not-staged", message("refused.not-staged.again"))
            before = await asyncio.to_thread(read_contents, self._model)
            await asyncio.to_thread(folder.begin, note, before)
            await asyncio.to_thread(_put_in_place, files, self._model, before, note)
        except OSError as error:
            folder.remove()
            raise CommandRefused(
                "model-not-written", message("refused.model-not-written.why", why=str(error.strerror))
            ) from error

    async def end(self) -> None:
        """Wait until files are in place. Raises `DeployedError` then."""
        await self._in_place.wait()
        await asyncio.sleep(ANSWERED)
        raise DeployedError


def under_way(name: str, by: str) -> CommandRefused:
    """Return why nothing is commanded while a deployment is under way."""
    return CommandRefused("deployment-under-way", message("refused.deployment-under-way.by", by=by, name=name), 503)


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
        """True if it is still to be seen that the station runs the new model."""
        self._starting = self._starting and self._folder.exists
        return self._starting

    def view(self) -> DeploymentView | None:
        """Return what is shown of it."""
        if (note := self._note) is None:
            return None
        state = DeploymentState.STARTING if self.starting else DeploymentState.RUNS
        state = state if note.undone is None else DeploymentState.UNDONE
        return DeploymentView(
            revision=note.revision, name=note.name, by=note.by, at=note.time, state=state, why=note.undone
        )

    @property
    def control(self) -> ControlView | None:
        """The one who is in control as this controller begins."""
        return None if self._note is None or self._stood_by else self._note.control

    def known(self, known: RestoredState) -> RestoredState:
        """Return what is known as a controller begins after it."""
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
        """Return why nothing can be commanded yet; None where that is not because of a deployment."""
        note = self._note
        return under_way(note.name, note.by) if note is not None and self.starting else None

    def tell_that_it_waits(self, *, waits: bool) -> None:
        """Tell whether somebody else commands the devices, so that the start takes as long as that. Raises
        `OSError`.
        """
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
        """Forget it, since what became of it is recorded. A later deployment, which may have begun meanwhile, is not
        forgotten.
        """
        if self._note is not None and self._note.undone is not None and self._folder.note() == self._note:
            self._folder.remove()


# What is found of a station while it is prepared, and after that while it runs.

LOG = structlog.get_logger(__name__)

ANALYSIS_DEADLINE = 120.0  # seconds for all that synthesis finds
PREPARING = "preparing"  # why a command is refused that only comes too early
PUT_OFF = 10.0  # seconds until what is not known from before is looked for: the station begins again first


@dataclass(frozen=True)
class UnusableModel:
    """A model that means nothing: why, and the folder's name, by which it is called."""

    name: str
    findings: tuple[Finding, ...]


_UNSUPERVISED = AnalysisDocument(
    pending=None,
    pending_message=None,
    supervised=False,
    reachable_states=None,
    supervised_states=None,
    supervised_at_most=None,
    guarded=None,
    guards=None,
    lifted=None,
    findings=[],
)


class Preparation:
    """Findings on the station so far; `trouble` if it cannot be run, in particular since its model is `unusable`, or
    `too_large` to find out what is safe.
    """

    def __init__(self, unusable: UnusableModel | None = None) -> None:
        self.supervisor: asyncio.Future[Supervisor | None] = asyncio.get_running_loop().create_future()
        self.analysis: AnalysisDocument | None = None
        self.trouble: str | None = None
        self.unusable = unusable is not None
        self.too_large = False
        if unusable is not None:
            self.supervisor.set_result(None)
            self.trouble = joined(
                message("obstacle.at", place=str(each.place), what=each.message) for each in unusable.findings
            )
            findings = [error_document(finding) for finding in unusable.findings]
            self.analysis = _UNSUPERVISED.model_copy(update={"findings": findings})
        self.controller: Controller | None = None
        self._others: str | None = None  # who else commands the devices, while that is waited for
        self._guards: Mapping[str, SupervisorGuard] = {}

    def take(self, analysis: AnalysisDocument, found: Analysis) -> None:
        """Take note of what has been found by now."""
        self.analysis, self._guards = analysis, found.guards or {}
        if found.supervisor is not None and not self.supervisor.done():
            self.supervisor.set_result(found.supervisor)
        elif found.supervisor is None and found.warnings is not None and not self.supervisor.done():
            self.trouble = joined(warning.message for warning in found.warnings)
            self.supervisor.set_result(None)
        if self.controller is not None:
            self.controller.viewing.know(analysis, self._guards)

    def give(self, controller: Controller) -> None:
        """From now on the controller is told what else is found."""
        self.controller = controller
        if self._others is not None:
            controller.devices.wait_to_command()
        if self.analysis is not None:
            controller.viewing.know(self.analysis, self._guards)

    def note_others(self, why: str) -> None:
        """Somebody else commands the devices, and is waited for."""
        if self._others != why:
            LOG.warning("the controller waits to command the devices", because=why)
        self._others = why
        if self.controller is not None:
            self.controller.devices.wait_to_command()

    def tasks(self) -> dict[str, TaskView]:
        """The open tasks by now."""
        return {} if self.controller is None else self.controller.view().tasks

    def note_unrecorded(self, why: str | None) -> None:
        """Commands cannot be recorded, for this reason; None when they can again."""
        if self.controller is not None:
            self.controller.records.unrecorded = why

    def end(self, why: WorkerError) -> None:
        """No more will be found."""
        if not self.supervisor.done():
            if isinstance(why, TooLargeError):  # a controller that begins anew would come no further
                self.too_large, self.trouble = True, why.why
                self.analysis = _UNSUPERVISED
                self.supervisor.set_result(None)
            else:
                self.supervisor.set_exception(why)
        if self.analysis is not None:
            self.analysis = self.analysis.model_copy(update={"pending": None, "pending_message": None})
            if self.controller is not None:
                self.controller.viewing.know(self.analysis, self._guards)

    def view(
        self,
        identity: StationIdentity,
        began: float,
        standby: StandbyView | None,
        deployment: DeploymentView | None,
        control: ControlView | None,
    ) -> StationView:
        """The station as it is shown meanwhile; `control` is that with which it begins."""
        return preparing_view(
            identity,
            time.time(),
            began,
            self.analysis,
            self.trouble,
            standby,
            deployment,
            control=control,
            unusable=self.unusable,
            too_large=self.too_large,
        )

    def refusal(self) -> CommandRefused:
        """Return why nothing can be commanded yet."""
        if self.trouble is not None:
            why = as_it_was(self.trouble)
            if self.unusable:
                return CommandRefused("model-unusable", message("refused.model-unusable.why", why=why))
            title = message("refused.safety-unknown") if self.too_large else None
            return CommandRefused("no-supervisor", message("refused.no-supervisor.why", why=why), title=title)
        if self._others is not None:
            return CommandRefused(
                "other-controller", message("refused.other-controller.waits", who=as_it_was(self._others))
            )
        return CommandRefused(PREPARING, message("refused.preparing.again"), 503)


async def analyse(automaton: Automaton, preparation: Preparation, folder: Path) -> None:
    """Have all found that synthesis can find, as long as that takes no unreasonable time.

    What an earlier life of the controller has left of it in `folder`, or a command, is there at once.
    """
    try:
        known = await asyncio.to_thread(_known, automaton, folder)
        if known is not None:
            preparation.take(await asyncio.to_thread(document_of, automaton, known), known)
            if known.pending is None:
                return
            await asyncio.sleep(PUT_OFF)
        of = await asyncio.to_thread(key, automaton)
        async with asyncio.timeout(ANALYSIS_DEADLINE), analysing(automaton) as finding:
            async for found in finding:
                preparation.take(await asyncio.to_thread(document_of, automaton, found), found)
                if found.supervisor is not None:
                    await asyncio.to_thread(write, of, found, folder)
    except WorkerError as ended:
        LOG.error("synthesis ended early", because=str(ended))
        preparation.end(ended)
    except TimeoutError:
        LOG.warning("not all was found of the station", within=ANALYSIS_DEADLINE)
        preparation.end(TooLargeError(message("work.unsafe", seconds=f"{ANALYSIS_DEADLINE:g}")))
    except Exception as error:
        LOG.exception("synthesis failed")
        preparation.end(WorkerError(f"the safe states could not be computed ({type(error).__name__}: {error})"))


def _known(automaton: Automaton, folder: Path) -> Analysis | None:
    """All that an earlier life of the controller has left, or else the supervisor that a command has."""
    known = read(key(automaton), Analysis, folder)
    if known is not None and known.supervisor is not None:
        return known
    supervisor = known_supervisor(automaton)
    return None if supervisor is None else Analysis(FINDINGS, supervisor)
