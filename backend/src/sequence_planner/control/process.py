"""The controller's process: the station is prepared, the network joined, then it runs and shows itself on the link."""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
from collections.abc import AsyncIterator, Callable, Coroutine, Generator
from dataclasses import dataclass
from pathlib import Path

import structlog

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.collection import keep_everything
from sequence_planner.control.alarming.keeping import KIND as ASIDE
from sequence_planner.control.alarming.keeping import aside_from
from sequence_planner.control.asks import Ask
from sequence_planner.control.belief import KIND as BELIEFS
from sequence_planner.control.belief import beliefs_from
from sequence_planner.control.commands import Command, CommandRefused
from sequence_planner.control.controller import Controller
from sequence_planner.control.deploying import DeployedError, Deploying
from sequence_planner.control.happenings import ProductionStarted
from sequence_planner.control.known import Known
from sequence_planner.control.link import ControllerLink
from sequence_planner.control.moment import Moment
from sequence_planner.control.network_graph import network_steps
from sequence_planner.control.network_view import NetworkView
from sequence_planner.control.network_watch import NetworkWatch
from sequence_planner.control.preparation import Preparation, analyse, preparing_view
from sequence_planner.control.production_commands import Deploy
from sequence_planner.control.recording import Recording
from sequence_planner.control.starting import go_on, start_when_alone
from sequence_planner.control.view import StandbyView, StationIdentity, StationView
from sequence_planner.control.view_part import View
from sequence_planner.history.codec import BEGUN, kind_of
from sequence_planner.history.restoring import beginning
from sequence_planner.journal.run_journal import last
from sequence_planner.ros.exclusivity import NotAloneError, require_sole_publisher
from sequence_planner.ros.gated import gated
from sequence_planner.ros.transport import Transport
from sequence_planner.standby.keeper import Keeper
from sequence_planner.standby.lease import open_lease
from sequence_planner.standby.model import digest_of
from sequence_planner.station import ReadyStation
from sequence_planner.storage.database import Database

LOG = structlog.get_logger(__name__)

SHOW_EVERY = 0.1  # seconds between two views
NODE = "sequence_planner"


@dataclass(frozen=True)
class Running:
    """What shall run, and how.

    `start` starts production without a person, for demonstrations: as soon as emulated devices and nothing else are
    there to be commanded. These have just begun, so nothing is believed of them from before. `database` is the URL of
    where commands are recorded, `model` the folder that the station was read from. `standby` is the name of this
    station where several share the database and one commands; else it is None. A controller that is started `again`
    waits as long as somebody else commands the devices, where another one would end with an error.
    """

    station: ReadyStation
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

    Raises `SynthesisEndedError` when that could not be computed, `TransportError` when the network cannot be joined or
    somebody else commands the devices, `StorageError` when the database cannot be used, `DeployedError` once another
    model is in place, and `LeaseLostError` when another station has taken the command.
    """
    preparation = Preparation()
    database = Database.open(running.database)
    async with contextlib.AsyncExitStack() as kept:
        kept.callback(database.close)
        database.upgrade()
        command = await kept.enter_async_context(_command(running))
        recording = Recording(database, preparation.note_unrecorded)
        kept.push_async_callback(recording.close)
        await _live(running, preparation, recording, database, command)


@contextlib.asynccontextmanager
async def _command(running: Running) -> AsyncIterator[Keeper | None]:
    """What keeps the lease of the command, where stations share it; it is let go of at the end."""
    if running.standby is None:
        yield None
        return
    lease = open_lease(running.database, running.standby, digest_of(running.model))
    keeper, deployed = Keeper(lease), False
    keeper.begin()
    try:
        yield keeper
    except DeployedError:
        deployed = True
        raise
    finally:
        await keeper.end(deployed=deployed)


async def _live(
    running: Running, preparation: Preparation, recording: Recording, database: Database, keeper: Keeper | None
) -> None:
    """Prepare the station and run it, while the network is asked whether somebody else commands its devices."""
    try:
        async with asyncio.TaskGroup() as living:
            living.create_task(_Life(running, preparation, recording, database, keeper, living).run())
            if keeper is not None:
                living.create_task(keeper.lost())
    except ExceptionGroup as failed:
        raise failed.exceptions[0] from None


class _Life:
    """Prepares the station, then runs it; it only listens until it is known to be alone.

    What fails at finding that out, or at taking command then, ends all that is `living`. Where stations share a lease
    who holds it is the one: of the others nobody says anything, and who else does keeps production from being started.
    """

    def __init__(
        self,
        running: Running,
        preparation: Preparation,
        recording: Recording,
        database: Database,
        keeper: Keeper | None,
        living: asyncio.TaskGroup,
    ) -> None:
        self._running = running
        self._preparation = preparation
        self._recording = recording
        self._database = database
        self._keeper = keeper
        self._living = living
        self._deploying = Deploying(running.model, running.socket)
        self._link = ControllerLink(running.socket, self._handle, self._answer)

    async def run(self) -> None:
        """All of it."""
        running, keeper = self._running, self._keeper
        alone = self._living.create_task(self._alone() if keeper is None else keeper.taken())
        self._living.create_task(self._deploying.end())
        analysing = analyse(running.station.automaton, self._preparation, running.socket.parent)
        async with self._link, _beside(analysing):
            async with _beside(self._show_preparing()):
                supervisor = await _prepared(self._preparation)
                if supervisor is None:
                    LOG.error("there is no supervisor", because=self._preparation.trouble)
                    await asyncio.Event().wait()
                    return
                if keeper is not None:
                    await keeper.taken()
            transport = running.connect(NODE)
            try:
                await self._run_with(supervisor, transport, alone)
            finally:
                transport.close()

    async def _alone(self) -> None:
        """Wait until nobody else commands the devices. Raises `TransportError`."""
        while True:
            try:
                return await _require_sole_command(self._running)
            except NotAloneError as error:
                if not self._running.again:
                    raise
                self._preparation.note_others(str(error))

    async def _run_with(self, supervisor: Supervisor, transport: Transport, alone: asyncio.Task[None]) -> None:
        """Run the controller on the network."""
        running, keeper = self._running, self._keeper
        known = Known()
        if not running.start:
            known = await asyncio.to_thread(what_is_known, self._database, running.station.automaton)
        identity = _identity(running, transport.name)
        station, database = running.station, self._database
        if keeper is None:
            controller = Controller(identity, station, supervisor, transport, database, known)
        else:
            speaking = gated(transport, lambda: keeper.held)
            controller = Controller(identity, station, supervisor, speaking, database, known, keeper.fence)
        keep_everything()  # a running station must not be held up
        self._preparation.give(controller)
        self._living.create_task(self._take_command(controller, known, alone))
        async with _beside(self._show(controller)), _beside(show_network(controller.devices.network, self._link)):
            await controller.run()

    async def _take_command(self, controller: Controller, known: Known, alone: asyncio.Task[None]) -> None:
        await asyncio.wait({alone})
        if alone.exception() is not None:
            return  # all of this ends
        controller.take_command()
        running, keeper = self._running, self._keeper
        if running.start:
            async with _beside(start_when_alone(controller, self._handle)):
                await asyncio.Event().wait()
        elif keeper is not None and keeper.taken_from is not None and known.produced and running.station.goes_on:
            async with _beside(go_on(controller, self._handle, keeper.taken_from)):
                await asyncio.Event().wait()

    async def _act(self, command: Command) -> None:
        """Carry out a command that is recorded. Raises `CommandRefused`."""
        preparation, keeper = self._preparation, self._keeper
        if keeper is not None and not keeper.held:
            raise _stands_by(keeper)
        if preparation.controller is None or not preparation.controller.commands:
            # What has no supervisor does not run, so another model may take its place at once.
            if preparation.trouble is None or not isinstance(command, Deploy):
                raise preparation.refusal()
        else:
            await preparation.controller.command(command)
        if isinstance(command, Deploy):
            await self._deploying.carry_out(command)

    async def _handle(self, command: Command) -> None:
        """Record a command and carry it out. Raises `CommandRefused`."""
        await self._recording.carry_out(command, self._preparation.tasks, self._act)
        if self._preparation.controller is not None:
            self._link.publish(self._seen(self._preparation.controller))

    async def _answer(self, ask: Ask) -> View:
        """What is told only when somebody asks for it. Raises `CommandRefused`."""
        if self._preparation.controller is None:
            raise self._preparation.refusal()
        return await self._preparation.controller.answer(ask)

    def _seen(self, controller: Controller) -> StationView:
        view = controller.view()
        return view if self._keeper is None else view.model_copy(update={"standby": _standby_view(self._keeper)})

    async def _show(self, controller: Controller) -> None:
        failed = ""
        while True:
            try:
                self._link.publish(self._seen(controller))
            except Exception as error:  # who looks on is told that nothing is heard; the station goes on
                if failed != (failed := repr(error)):
                    LOG.exception("the station cannot be shown")
            await asyncio.sleep(SHOW_EVERY)

    async def _show_preparing(self) -> None:
        identity, began, known = _identity(self._running, ""), time.time(), self._preparation
        while True:
            standby = None if self._keeper is None else _standby_view(self._keeper)
            view = preparing_view(identity, time.time(), began, known.analysis, known.trouble, standby)
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


async def _prepared(preparation: Preparation) -> Supervisor | None:
    """The supervisor."""
    began = time.monotonic()
    supervisor = await asyncio.shield(preparation.supervisor)
    if supervisor is not None:
        LOG.info("safe states computed", seconds=round(time.monotonic() - began, 2))
    return supervisor


async def _require_sole_command(running: Running) -> None:
    question = running.connect(f"{NODE}_check")
    try:
        commanded = {p.topic.name: p.topic.type_name for p in running.station.pipelines.outgoing.values()}
        await require_sole_publisher(question, commanded, "the controller")
    finally:
        question.close()


def what_is_known(database: Database, automaton: Automaton) -> Known:
    """What the journal knows of the station from before. Raises `StorageError`."""
    with database.reading() as connection:
        restored = beginning(connection, automaton, Moment.now())
        aside, beliefs = last(connection, ASIDE), last(connection, BELIEFS)
        begun, started = last(connection, BEGUN), last(connection, kind_of(ProductionStarted))
    return Known(
        restored.beginning if restored else None,
        {} if aside is None else aside_from(json.loads(aside.content)),
        {} if beliefs is None else beliefs_from(json.loads(beliefs.content)),
        restored.left_out if restored else (),
        begun is not None and started is not None and started.number > begun.number,
    )


def _standby_view(keeper: Keeper) -> StandbyView:
    standing = keeper.standing
    return StandbyView(
        name=standing.name,
        active=standing.active,
        holder=standing.holder,
        standing_by=list(standing.standing_by),
        trouble=standing.trouble,
    )


def _stands_by(keeper: Keeper) -> CommandRefused:
    """Why a station that does not hold the lease carries nothing out."""
    holder = keeper.standing.holder
    if keeper.standing.active:
        why = keeper.standing.trouble or "the database is slow"
        detail = f"This station cannot renew the lease of the command: {why}. Try again in a moment."
        return CommandRefused("lease-not-renewed", "The lease of the command is not renewed", detail, 503)
    where = "Another station" if holder is None or holder == keeper.standing.name else holder
    detail = f"{where} commands the devices, and this station stands by for it. Open that one's page."
    return CommandRefused("stands-by", "This station stands by", detail, 503)


async def show_network(network: NetworkWatch, link: ControllerLink) -> None:
    """Show the network whenever something has changed in it. The document is made in short steps between the ticks."""
    shown: object = None
    while True:
        if network.seen != shown:
            shown = network.seen
            link.publish_network(await _in_steps(network_steps(*network.seen, network.uses)))
        await asyncio.sleep(SHOW_EVERY)


async def _in_steps(steps: Generator[None, None, NetworkView]) -> NetworkView:
    while True:
        try:
            next(steps)
        except StopIteration as done:
            view: NetworkView = done.value
            return view
        await asyncio.sleep(0)


def _identity(running: Running, transport: str) -> StationIdentity:
    automaton = running.station.automaton
    return StationIdentity(
        name=automaton.name,
        title=automaton.title,
        description=automaton.description,
        transport=transport,
        emulated=running.emulated,
    )
