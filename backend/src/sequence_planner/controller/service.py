"""The controller process: start, lease, main loop, durable commands and automatic production start."""

from __future__ import annotations

import asyncio
import contextlib
import math
import time
from collections.abc import AsyncIterator, Callable, Coroutine, Generator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import structlog

from sequence_planner.analysis.store import user_cache
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.audit import CommandAudit
from sequence_planner.controller.commands.command import Command, CommandRefused, Query
from sequence_planner.controller.commands.execution import Deploy
from sequence_planner.controller.controller import Controller
from sequence_planner.controller.durability import Lasting
from sequence_planner.controller.features.automatic_start import go_on, start_when_alone
from sequence_planner.controller.io.network import NetworkWatch, network_steps
from sequence_planner.controller.ipc import CarriedOut, ControllerLink
from sequence_planner.controller.lease import held_lease, standby_view, stands_by
from sequence_planner.controller.preparation import (
    PREPARING,
    Deploying,
    LastDeployment,
    Preparation,
    UnusableModel,
    analyse,
)
from sequence_planner.controller.previous_run import as_it_ended, how_it_ended, last_known_mode, what_is_known
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.builder import Shown
from sequence_planner.controller.views.details import NetworkView
from sequence_planner.controller.views.station import StationIdentity, StationView
from sequence_planner.core.data_models import DataModel
from sequence_planner.db.database import Database
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.journal.last_accepted import LastEnding, LastWord, last_word_file
from sequence_planner.process.gc_tuning import keep_everything
from sequence_planner.ros.exclusivity import NotAloneError, require_sole_publisher
from sequence_planner.ros.transport import Transport
from sequence_planner.ros.transports.routing import gated
from sequence_planner.simulation.supported import emulation_findings
from sequence_planner.standby.lease import LeaseKeeper
from sequence_planner.station import ReadyStation
from sequence_planner.texts.message import Title, message

LOG = structlog.get_logger(__name__)

# The controller's process: the station is prepared, the network joined, then it runs and shows itself on the link.

SETTLED_WITHIN = 10.0  # seconds in which a process beside one that has died says that all of its is recorded
SHOW_EVERY = 0.1  # seconds between two views, at least
SHOW_AT_REST = 0.5  # while nothing happens: only times and numbers change
WISH_LASTS = 60.0  # seconds for which a station that stands by minds that somebody wanted to stop it
RECORD_AGAIN = 5.0  # seconds
NODE = "sequence_planner"


@dataclass(frozen=True)
class Running:
    """The station that shall run, and how.

    `start` starts production without a person, for demonstrations: as soon as emulated devices and nothing else are
    there to be commanded. These have just begun, so nothing is believed of them from before. `database` is the URL of
    where commands are recorded, `model` the folder that the station was read from. `standby` is the name of this
    station where several share the database and one commands; else it is None. A controller that is started `again`
    waits as long as somebody else commands the devices, where another one would end with an error. One whose model is
    unusable says so, and waits for another model.
    """

    station: ReadyStation | UnusableModel
    model: Path
    socket: Path
    connect: Callable[[str], Transport]
    emulated: bool
    start: bool
    database: str
    standby: str | None = None
    again: bool = False


async def control(running: Running) -> None:
    """Run the controller until cancelled. Without a supervisor it only shows why there is none.

    Raises `WorkerError` when that could not be computed, `TransportError` when the network cannot be joined or
    somebody else commands the devices, `StorageError` when the database cannot be used, `DeployedError` once another
    model is in place, `NotStartedError` when what was deployed just now has no supervisor, and `LeaseLostError` when
    another station has taken the command.
    """
    station = running.station
    preparation = Preparation(station if isinstance(station, UnusableModel) else None)
    database = Database.open(running.database)
    async with contextlib.AsyncExitStack() as kept:
        kept.callback(database.close)
        database.upgrade()
        last_word = LastWord.open(last_word_file(database.place, running.standby))
        kept.callback(last_word.close)
        ended = await asyncio.to_thread(how_it_ended, database, last_word)
        command = None
        if running.standby is not None and not isinstance(
            running.station, UnusableModel
        ):  # another station may command then
            lease = held_lease(running.database, running.standby, running.model, ended, preparation)
            command = await kept.enter_async_context(lease)
        recording = CommandAudit(database, preparation.note_unrecorded)
        kept.push_async_callback(recording.close)
        lasting = Lasting(last_word)
        kept.callback(lasting.close)
        mode = Mode.AUTOMATIC if running.start else await asyncio.to_thread(last_known_mode, database, ended)
        await _live(_Life(running, preparation, recording, database, command, last_word, lasting, mode))


async def _live(life: _Life) -> None:
    """Prepare the station and run it, while the network is asked whether somebody else commands its devices."""
    try:
        async with asyncio.TaskGroup() as living:
            living.create_task(life.run(living))
            if life.keeper is not None:
                living.create_task(life.keeper.lost())
    except ExceptionGroup as failed:
        raise failed.exceptions[0] from None


class NotStartedError(Exception):
    """The error that what was deployed just now cannot be run."""


class _Life:
    """Prepares the station, then runs it; it only listens until it is known to be alone.

    What fails at finding that out, or at taking command then, ends all that is living. Where stations share a lease
    who holds it is the one: of the others nobody says anything, and who else does keeps production from being started.
    """

    def __init__(
        self,
        running: Running,
        preparation: Preparation,
        recording: CommandAudit,
        database: Database,
        keeper: LeaseKeeper | None,
        last_word: LastWord,
        lasting: Lasting,
        begins_in: Mode,
    ) -> None:
        self.keeper = keeper
        self._running = running
        self._preparation = preparation
        self._recording = recording
        self._database = database
        self._last_word, self._lasting = last_word, lasting
        self._deploying = Deploying(running.model, running.socket, emulated=running.emulated, dual=_is_dual(running))
        self._deployment = LastDeployment(running.socket)
        self._begins_in = begins_in
        self._at_rest_until = 0.0  # on the clock of `time.monotonic`: somebody wanted it before it could be done
        self._shown = Shown()
        self._link = ControllerLink(running.socket, self._handle, self._answer)

    async def run(self, living: asyncio.TaskGroup) -> None:
        """All of it."""
        self._living, station = living, self._running.station
        self._living.create_task(self._deploying.end())
        self._living.create_task(self._record_undone())
        if isinstance(station, UnusableModel):
            async with self._link:
                await self._wait_for_another()
            return
        keeper = self.keeper
        alone = self._living.create_task(self._alone(station) if keeper is None else keeper.taken())
        analysing = analyse(station.automaton, self._preparation, user_cache() or self._running.socket.parent)
        async with self._link, _beside(analysing):
            async with _beside(self._show_preparing()):
                supervisor = await _prepared(self._preparation)
                if supervisor is not None and keeper is not None:
                    async with _beside(self._tell_that_it_stands_by(keeper)):
                        await keeper.taken()
            if supervisor is None:
                await self._wait_for_another()
                return
            transport = self._running.connect(NODE)
            try:
                await self._run_with(station, supervisor, transport, alone)
            finally:
                transport.close()

    async def _tell_that_it_stands_by(self, keeper: LeaseKeeper) -> None:
        """Tell whoever waits for what was deployed that it could be started, though another station commands."""
        await keeper.stands_by()
        await self._deployment.wait_for_devices(self._running.emulated)
        self._deployment.tell_that_it_stands_by()

    async def _wait_for_another(self) -> None:
        """Say why this model cannot be run. Raises `NotStartedError` where it has just been deployed."""
        trouble = self._preparation.trouble or ""
        LOG.error("the model cannot be run", because=trouble)
        if self._deployment.starting:
            raise NotStartedError(trouble)
        await self._show_preparing()

    async def _record_undone(self) -> None:
        """Record that the deployment before this start was undone."""
        if (entry := self._deployment.entry()) is None:
            return None
        while True:
            if await self._recording.note(entry):
                return self._deployment.forget()
            await asyncio.sleep(RECORD_AGAIN)

    async def _alone(self, station: ReadyStation) -> None:
        """Wait until nobody else commands the devices. Raises `TransportError`."""
        while True:
            try:
                await _require_sole_command(self._running, station)
            except NotAloneError as error:
                if not self._running.again:
                    raise
                self._preparation.note_others(str(error))
                self._deployment.tell_that_it_waits(waits=True)
            else:
                return self._deployment.tell_that_it_waits(waits=False)

    async def _run_with(
        self, station: ReadyStation, supervisor: Supervisor, transport: Transport, alone: asyncio.Task[None]
    ) -> None:
        """Run the controller on the network."""
        running, keeper = self._running, self.keeper
        known = self._deployment.known(RestoredState() if running.start else await self._known(station))
        identity, database = _identity(running, transport.name), self._database
        if keeper is None:
            controller = build_controller(identity, station, supervisor, transport, database, known)
        else:
            speaking = gated(transport, lambda: keeper.held)
            controller = build_controller(identity, station, supervisor, speaking, database, known, keeper.fence)
        keep_everything()  # a running station must not be held up
        self._preparation.give(controller)
        await self._lasting.begin(controller, None if keeper is None else keeper.epoch)
        if running.emulated:
            unemulated = await asyncio.to_thread(emulation_findings, station)
            controller.devices.unemulated = tuple(map(str, unemulated))
        self._living.create_task(self._take_command(station, controller, known, alone))
        async with _beside(self._show(controller)), _beside(show_network(controller.devices.network, self._link)):
            await controller.run()

    async def _known(self, station: ReadyStation) -> RestoredState:
        """Return what is known from before, at rest where it is not certain that nobody has stopped the station
        since.
        """
        known = await asyncio.to_thread(what_is_known, self._database, station.automaton)
        ended, keeper = await asyncio.to_thread(how_it_ended, self._database, self._last_word), self.keeper
        if keeper is not None and ended.word is None and not (ended.is_certain and _follows(ended, keeper)):
            by_itself = station.goes_on and known.was_at_work
            ended = LastEnding(await keeper.settled(SETTLED_WITHIN if by_itself else 0.0))
        if ended.word is not None:
            self._recording.record_late(
                ended.word.entry.model_copy(
                    update={"details": {**ended.word.entry.details, "carried_out": ended.word.time}}
                ),
                ended.word.time,
            )
        return as_it_ended(known, ended, None if keeper is None else keeper.taken_from)

    async def _take_command(
        self, station: ReadyStation, controller: Controller, known: RestoredState, alone: asyncio.Task[None]
    ) -> None:
        running, keeper = self._running, self.keeper
        await asyncio.wait({alone})
        if alone.exception() is not None:
            return  # all of this ends
        await self._deployment.wait_for_devices(running.emulated)
        controller.take_command()
        self._deployment.tell_that_it_runs()
        if time.monotonic() < self._at_rest_until:
            LOG.info("production does not go on by itself", because="somebody wanted to stop it before it was ready")
        elif running.start:
            async with _beside(start_when_alone(controller, self._handle)):
                await asyncio.Event().wait()
        elif keeper is not None and keeper.taken_from is not None and known.was_at_work and station.goes_on:
            async with _beside(go_on(controller, self._handle, keeper.taken_from)):
                await asyncio.Event().wait()

    async def _act(self, command: Command) -> DataModel | None:
        """Carry out a command that is recorded, and return what it makes. Raises `CommandRefused`."""
        made: DataModel | None = None
        preparation, keeper = self._preparation, self.keeper
        # Who commands may stop the station though it cannot renew its lease: nothing is said to a device meanwhile.
        if keeper is not None and not keeper.held and (keeper.epoch is None or not command.harmless):
            raise self._not_yet(command, stands_by(keeper))
        if (refusal := self._deploying.refusal()) is not None and not command.harmless:
            raise refusal
        if isinstance(command, Deploy):
            self._deploying.check(command)
        if preparation.controller is None or not preparation.controller.commands:
            # What has no supervisor does not run, so another model may take its place at once.
            if preparation.trouble is None or not isinstance(command, Deploy):
                raise self._not_yet(command, self._refusal())
        else:
            made = await preparation.controller.command(command)
        if isinstance(command, Deploy):
            control = None if preparation.controller is None else preparation.controller.view().control
            await self._deploying.carry_out(command, control, time.time())
        return made

    async def _handle(self, command: Command) -> CarriedOut:
        """Record a command and carry it out. Raises `CommandRefused`."""
        made: DataModel | None = None

        async def act(command: Command) -> None:
            nonlocal made
            made = await self._act(command)

        controller = self._preparation.controller
        before = 0 if controller is None else controller.records.newest
        audited = await self._recording.carry_out(command, self._preparation.tasks, act)
        if controller is None:
            return CarriedOut(made=made)
        view = self._seen(controller)
        self._shown.note(view)
        self._link.publish(view)
        return CarriedOut(await self._lasting.settle(command, controller, before, audited), made)

    async def _answer(self, query: Query[Any]) -> DataModel:
        """Return what is told only when somebody asks for it. Raises `CommandRefused`."""
        if self._preparation.controller is None:
            raise self._refusal()
        return await self._preparation.controller.answer(query)

    def _not_yet(self, command: Command, refusal: CommandRefused) -> CommandRefused:
        """The refusal of what cannot be done yet. Whoever wanted to stop the station then is not to see it go on."""
        if not command.harmless:
            return refusal
        keeper, now = self.keeper, time.monotonic()
        if keeper is not None and keeper.epoch is None:
            until, what = now + WISH_LASTS, message("refused.preparing.stays-at-rest-if", seconds=WISH_LASTS)
        else:
            until, what = math.inf, message("refused.preparing.stays-at-rest")
        self._at_rest_until = max(self._at_rest_until, until)
        detail = message("sentences", first=refusal.detail, second=what)
        return CommandRefused(refusal.slug, detail, refusal.status, title=refusal.title)

    def _refusal(self) -> CommandRefused:
        """Return why nothing can be commanded or asked yet."""
        refusal = self._preparation.refusal()
        return self._deployment.refusal() or refusal if refusal.slug == PREPARING else refusal

    def _seen(self, controller: Controller) -> StationView:
        standby = None if self.keeper is None else standby_view(self.keeper)
        return controller.view().model_copy(update={"deployment": self._deployment.view(), "standby": standby})

    async def _show(self, controller: Controller) -> None:
        failed = ""
        while True:
            controller.changed.clear()
            try:
                view = self._seen(controller)
                if self._shown.is_news(view):
                    self._link.publish(view)
                else:
                    self._link.publish_alive(view.time)
            except Exception as error:  # who looks on is told that nothing is heard; the station goes on
                if failed != (failed := repr(error)):
                    LOG.exception("the station cannot be shown")
            await asyncio.sleep(SHOW_EVERY)
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(SHOW_AT_REST - SHOW_EVERY):
                    await controller.changed.wait()

    async def _show_preparing(self) -> None:
        identity, began, known = _identity(self._running, ""), time.time(), self._preparation
        while True:
            standby = None if self.keeper is None else standby_view(self.keeper)
            view = known.view(identity, began, standby, self._deployment.view(), self._deployment.control).model_copy(
                update={"mode": self._begins_in}
            )
            self._link.publish(view)
            await asyncio.sleep(SHOW_EVERY)


@contextlib.asynccontextmanager
async def _beside(life: Coroutine[None, None, None]) -> AsyncIterator[None]:
    """Run `life` as long as the block lasts. What it fails at is logged and does not disturb the block."""

    async def logged() -> None:
        try:
            await life
        except Exception:
            LOG.exception("a task of the controller failed")

    task = asyncio.create_task(logged())
    try:
        yield
    finally:
        task.cancel()
        await asyncio.wait({task})
        life.close()  # which has never begun where the block was over at once


async def _prepared(preparation: Preparation) -> Supervisor | None:
    """The supervisor."""
    began = time.monotonic()
    supervisor = await asyncio.shield(preparation.supervisor)
    if supervisor is not None:
        LOG.info("safe states computed", seconds=round(time.monotonic() - began, 2))
    return supervisor


async def _require_sole_command(running: Running, station: ReadyStation) -> None:
    question = running.connect(f"{NODE}_check")
    try:
        commanded = {p.topic.name: p.topic.type_name for p in station.pipelines.outgoing.values()}
        await require_sole_publisher(question, commanded, "the controller")
    finally:
        question.close()


async def show_network(network: NetworkWatch, link: ControllerLink) -> None:
    """Show the network whenever something has changed in it. The document is made in short steps between the ticks."""
    while True:
        network.changed.clear()
        link.publish_network(await _in_steps(network_steps(*network.seen, network.uses)))
        await network.changed.wait()


async def _in_steps(steps: Generator[None, None, NetworkView]) -> NetworkView:
    while True:
        try:
            next(steps)
        except StopIteration as done:
            view: NetworkView = done.value
            return view
        await asyncio.sleep(0)


def _follows(ended: LastEnding, keeper: LeaseKeeper) -> bool:
    """Return whether nobody has had the lease between this station's last life and this one: a journal that is held up
    does not tell who had. Where nothing was ever recorded there was none.
    """
    life = ended.life
    if life is None:
        return True
    return life.epoch is not None and keeper.epoch == life.epoch + 1


def _is_dual(running: Running) -> bool:
    """Return whether the model that runs asks for a second person's approval of what takes its place."""
    station = running.station
    return not isinstance(station, UnusableModel) and station.approval_is_dual


def _identity(running: Running, transport: str) -> StationIdentity:
    station = running.station
    if isinstance(station, UnusableModel):
        return StationIdentity(
            name=station.name,
            title=station.name,
            titles={"": station.name},
            description="",
            transport=transport,
            emulated=running.emulated,
        )
    automaton = station.automaton
    title = automaton.title
    return StationIdentity(
        name=automaton.name,
        title=title,
        titles=dict(title.words) if isinstance(title, Title) else {"": title},
        description=automaton.description,
        transport=transport,
        emulated=running.emulated,
        deployment_approval="dual" if _is_dual(running) else "single",
    )
