"""The controller: one event loop on which messages, commands, plans and time become ticks, and ticks become messages.

It never waits for anything but its own events. Messages and acknowledgements wake it at once; otherwise it looks at the
clock often enough to notice a topic that fell silent and a command that is due again. Each tick is written down, and
what it tells the devices goes out as soon as that is durable.

An error in one piece of its work takes nothing else down: a tick that raises has not happened, an alarm says so, and it
is tried again at the next look at the clock.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial

import structlog
from pydantic import JsonValue

from sequence_planner.analysis.report import AnalysisDocument
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.alarms.alarm import KIND as ASIDE
from sequence_planner.controller.alarms.alarm import aside_again
from sequence_planner.controller.alarms.manager import AlarmManager
from sequence_planner.controller.commands.approvals import ApprovedCommand, ForceVariable
from sequence_planner.controller.commands.audit import StandingNotes
from sequence_planner.controller.commands.bus import CommandBus
from sequence_planner.controller.commands.command import Command
from sequence_planner.controller.commands.queries import Ask
from sequence_planner.controller.commands.query_handler import Definitions, QueryHandler, work_masters_view
from sequence_planner.controller.commands.registry import COMMANDS
from sequence_planner.controller.features.approvals import Approvals
from sequence_planner.controller.features.control_lock import ControlLock
from sequence_planner.controller.features.forces import Forces
from sequence_planner.controller.features.jobs import JobHandler, KeptJobs
from sequence_planner.controller.features.modes import Modes
from sequence_planner.controller.features.tasks import TaskHandler
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.pipeline_graph import pipelines_view
from sequence_planner.controller.metrics import Figures
from sequence_planner.controller.output_gate import OutputGate
from sequence_planner.controller.planner_client import AdvisorClient, PlannerQuestions
from sequence_planner.controller.recovery.consistency import KIND as BELIEFS
from sequence_planner.controller.recovery.consistency import Beliefs, ConsistencyMonitor
from sequence_planner.controller.recovery.corrections import Corrections
from sequence_planner.controller.recovery.explain import ConditionContext
from sequence_planner.controller.recovery.manual import ByHand
from sequence_planner.controller.recovery.proposals import Offers
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.recovery.trials import Trials
from sequence_planner.controller.recovery.who_can import in_thread
from sequence_planner.controller.recovery.why_not import WhyNot
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.builder import Doubts, ViewBuilder
from sequence_planner.controller.views.metrics import FiguresView
from sequence_planner.controller.views.part import View
from sequence_planner.controller.views.station import Priority, StationIdentity, StationView
from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.recorder import RunRecorder, model_digest
from sequence_planner.execution.vocabulary import Production
from sequence_planner.journal.writer import Fence, RunWriter
from sequence_planner.language.types import Value
from sequence_planner.model.source import Finding
from sequence_planner.ros.transport import Sample, Transport
from sequence_planner.station import ReadyStation
from sequence_planner.synthesis.guards import SupervisorGuard

LOG = structlog.get_logger(__name__)

LOOK_EVERY = 0.05  # seconds between two looks at the clock
LOOK_AT_REST = 0.2  # once there was no tick for a second: news, commands and plans are heard at once all the same
REST = 1.0
PATIENCE = 1.0  # seconds for which outputs may wait for their record before nothing more is started
MOST_UNWRITTEN = 100_000  # records; then nothing more is taken in, and no tick taken
MOST_TICKS = 100  # in a row without anything new; then the station is taken to be restless


class Controller:
    """A running station. Used from one event loop; `run` is its life.

    It only listens, and tells nobody anything but how the station stands, until it is told to `take_command`. From then
    on what happens, and has happened till then, is written into the journal of `database`; `known` is what came back
    from there.
    """

    def __init__(
        self,
        identity: StationIdentity,
        station: ReadyStation,
        supervisor: Supervisor,
        transport: Transport,
        database: Database,
        known: RestoredState | None = None,
        fence: Fence = lambda _: True,
    ) -> None:
        automaton, known = station.automaton, known or RestoredState()
        self.execution = Executor(automaton, supervisor, known.beginning)
        self._writer, self._figures = RunWriter(database, self._journalled, fence), Figures()
        self._recorder = RunRecorder(self.execution, self._writer.write, model_digest(automaton), known.beginning)
        self.begun = self._writer.end
        """The first record of this life."""
        self._wake = asyncio.Event()
        self.changed = asyncio.Event()
        """Set whenever there was a tick, or something was recorded."""
        self._progress = 0, 0  # numbers of ticks, and of what was recorded, when it was set last
        self.devices = Devices(station, transport, self._wake.set)
        feeds, network, commander = self.devices.feeds, self.devices.network, self.devices.commander
        self._release = OutputGate(
            self.execution, lambda: self._recorder.last, self.devices.publish, lambda: bool(commander.owed)
        )
        self._jobs = KeptJobs(self.execution, lambda: self._recorder.last)
        self.desk = TaskHandler(automaton, station.pipelines.feeds)
        self._outside = SafeStateMonitor(self.execution)
        self._alarms = AlarmManager(
            self.execution, self._outside, feeds, network, commander, self._note, known, in_thread
        )
        self._standing = StandingNotes(self._note)
        self._beliefs = Beliefs(self.execution, known.beginning, known.beliefs, partial(self._note, BELIEFS))
        self._recorder.know(BELIEFS, self._beliefs.document())
        self._recorder.know(ASIDE, aside_again(known.aside))
        self._by_hand = ByHand(self.execution, station.pipelines, self._note)
        self._doubting = ConsistencyMonitor(self.execution)
        self._viewing = ViewBuilder(identity, self.execution, self._outside, feeds, network, self._beliefs)
        self._questions = PlannerQuestions(self.execution, self._outside, self._take, self._figures.answers)
        self._adviser = AdvisorClient(automaton, supervisor)
        in_control = self._in_control = ControlLock(known.control)
        self._forces = Forces(self.execution)
        self._approvals = Approvals(self.execution, in_control, self._check, self._perform)
        self._corrections = Corrections(
            self.execution, self._adviser, self._beliefs, self._doubting, self._approvals.require_one
        )
        offers = Offers(self.execution, self._adviser, self._corrections, self._doubting.impossible, self._alarms.still)
        around = ConditionContext(feeds.heard_on, self._viewing.since, self._beliefs, lambda: self._viewing.guards)
        trials = Trials(self.execution, around, self.devices.real_devices)
        self._bus = CommandBus(
            (
                Modes(self.execution, self._outside, self.devices, self._doubting),
                self.desk,
                JobHandler(self.execution),
                self._corrections,
                offers,
                trials,
                self._forces,
                self._approvals,
                in_control,
                self._alarms,
                self.devices.overrides,
            ),
            COMMANDS.values(),
            in_control=in_control,
            require_one=self._approvals.require_one,
            real_devices=self.devices.real_devices,
        )
        self._asking = QueryHandler(
            pipelines=partial(pipelines_view, station.pipelines),
            flows=self.devices.flows,
            record=self.devices.record,
            work_masters=partial(work_masters_view, automaton),
            figures=self._measures,
            corrections=self._corrections,
            offers=offers,
            why_not=WhyNot(self.execution, around, self._adviser),
            definitions=Definitions(self.execution, around, trials),
        )
        self._measured: dict[str, Value | None] = {}
        self._is_unjournalled = False
        self._kept = 0, ""  # what was asked for and is beside the journal, up to that record
        self._again = False
        self._due = True  # a tick is wanted whatever the measurements say
        self._in_a_row = 0  # ticks that only followed from the one before
        self._last = 0, 0.0  # how many ticks there were, and since when

    async def run(self) -> None:
        """Tick until cancelled."""
        self._doubting.begin()
        try:
            while True:
                moment = Timestamp.now()
                self._step(moment)
                self._tell_of_progress()
                if self.devices.waiting or (self._again and self._in_a_row < MOST_TICKS):
                    await asyncio.sleep(0)
                else:
                    self._wake.clear()
                    await _first(self._wake, self._rest())
        finally:
            self.devices.close()
            self._questions.close()
            self._doubting.close()
            self._adviser.close()
            await self._writer.close()

    def _tell_of_progress(self) -> None:
        if self._progress != (progress := (self.execution.ticks, self.last_record)):
            self._progress = progress
            self.changed.set()

    def _rest(self) -> float:
        """Seconds until the next look at the clock: at the latest when a stage of a pipeline waits for it."""
        now, ticks = time.monotonic(), self.execution.ticks
        if ticks != self._last[0]:
            self._last = ticks, now
        look = LOOK_EVERY if now - self._last[1] < REST else LOOK_AT_REST
        due = self.devices.due(self._release.released is not None)
        return look if due is None else min(look, max(0.0, due - now))

    @property
    def commands(self) -> bool:
        """True if it is the one that commands the station's devices."""
        return self.devices.network.commands

    def take_command(self) -> None:
        """Nobody else commands the station's devices, so this one does from now on. Raises `TransportError`."""
        self.devices.take_command()
        self._writer.start()
        self._tick_again()

    def wait_to_command(self) -> None:
        """Somebody else commands the station's devices, and is waited for: shown, and nothing else."""
        self.devices.wait_to_command()

    async def command(self, command: Command) -> None:
        """Carry out a command. Raises `CommandRefused`."""
        self._bus.execute(command, Timestamp.now())
        LOG.info("command", **command.model_dump(mode="json"))
        self._tick_again()

    def view(self) -> StationView:
        """Return what there is to show now."""
        moment = Timestamp.now()
        alarms = self._alarms.current(self._questions.trouble, moment)
        self._viewing.who_can = self._alarms.who_can.found
        overrides, control = self.devices.overrides.view(moment), self._in_control.view()
        jobs = self._jobs.up_to(self._writer.durable)
        doubts = Doubts(
            self._doubting.undecided,
            list(self._doubting.questions),
            self._corrections.last,
            self._approvals.view(moment),
        )
        return self._viewing.view(self.desk, self.devices.commander, overrides, alarms, control, doubts, jobs, moment)

    async def answer(self, ask: Ask) -> View:
        """Return what is told only when somebody asks for it. Raises `CommandRefused`."""
        return await self._asking.answer(ask)

    @property
    def last_record(self) -> int:
        """The number of the last record of what has happened, which may not be durable yet."""
        return self._writer.end.number

    async def until_recorded(self, number: int, patience: float) -> bool:
        """Return whether what has happened up to a record is durable, or becomes so within so many seconds."""
        return await self._writer.until_durable(number, patience)

    def note_kept(self, number: int, what: str) -> None:
        """Note that what was asked for is kept beside the journal until that has the record of this number."""
        self._kept = number, what

    @property
    def is_recorded(self) -> bool | None:
        """True if all that has happened is durable; None where not even that this life has begun."""
        return self._writer.waiting == 0 if self._writer.durable >= self.begun.number else None

    @property
    def undecided(self) -> tuple[str, ...]:
        """The outputs on which a person must decide before production can be started."""
        return tuple(self._doubting.undecided)

    def know(self, analysis: AnalysisDocument, guards: Mapping[str, SupervisorGuard] | None) -> None:
        """Take note of what synthesis has found beside the supervisor, to be shown."""
        self._viewing.analysis, self._viewing.guards = analysis, guards or {}

    def note_unrecorded(self, why: str | None) -> None:
        """Commands cannot be recorded, for this reason; None when they can again."""
        self._alarms.unrecorded = why

    def note_unemulated(self, why: Sequence[Finding]) -> None:
        """There are no emulated devices though there should be, since the model does not allow for them."""
        self._alarms.unemulated = tuple(map(str, why))

    def _check(self, command: ApprovedCommand) -> None:
        """Raises `CommandRefused` when it could not be done now, whoever wants it."""
        if isinstance(command, ForceVariable):
            self._forces.check(command)
        else:
            self._corrections.check(command)

    def _perform(self, command: Command, moment: Timestamp) -> None:
        self._bus.perform(command, moment)

    def _journalled(self) -> None:
        """More records are durable, or it has changed why none are."""
        self._attempt("sending commands", lambda: self._release.durable(self._writer.durable))
        if (self._unjournalled() is not None) != self._is_unjournalled:
            self._wake.set()

    def _note(self, kind: str, content: Mapping[str, JsonValue]) -> None:
        if kind == "alarm" and content["event"] == "came" and content["priority"] != Priority.LOW:
            self._adviser.expect()
        self._recorder.record(kind, time.time(), content, lasts=kind in (ASIDE, BELIEFS))

    def _unjournalled(self) -> str | None:
        """Return why what happens cannot be journalled; None when it can."""
        if self._writer.trouble is not None:
            return self._writer.trouble
        if self._release.longest > PATIENCE:
            return f"the database has not confirmed anything for {PATIENCE:g} s"
        return None

    def _measures(self) -> FiguresView:
        replaced = {"planner": self._questions.replaced, "adviser": self._adviser.replaced}
        return self._figures.view(self._writer, self._unjournalled() is not None, replaced)

    def _tick_again(self) -> None:
        self._due = self._again = True
        self._in_a_row = 0
        self._wake.set()

    def _step(self, moment: Timestamp) -> None:
        """All ticks that are due: one for each part of what was heard, and one for the look at the clock."""
        self._attempt("looking at the network", lambda: self.devices.look(moment))
        self._again = False
        for part in self.devices.heard():
            # What a message says counts from when it was received, however late its turn comes.
            self._attempt("a tick", partial(self._tick, part, moment, part[-1].received))
        self._attempt("a tick", lambda: self._tick((), moment, moment.monotonic))
        self._attempt("sending commands", lambda: self._repeat(moment))
        self._attempt("looking for contradictions", self._doubting.look)
        self._attempt("looking after alarms", lambda: self._look_after_alarms(moment))
        self._attempt("noting how it stands", lambda: self._note_standing(moment))
        self._attempt("asking the planner", lambda: self._questions.ask(moment.monotonic))

    def _repeat(self, moment: Timestamp) -> None:
        if self._release.released is not None:
            self.devices.repeat(self._release.released, moment.monotonic)
            self._release.go_on()

    def _tick(self, samples: Sequence[Sample], moment: Timestamp, monotonic: float) -> None:
        """Take messages of `monotonic`, of which no topic has more than one, and tick if that is something new."""
        feeds = self.devices.feeds
        feeds.take(samples)
        feeds.wake(monotonic)
        measured = feeds.measured(monotonic) | self.desk.measured()
        obstacles, silent = self._obstacles(), feeds.offline(monotonic)
        known = (self._measured, self.execution.obstacles, self.execution.conduct.silent)
        news = (measured, obstacles, silent) != known or self.execution.is_due(moment)
        if (not news and not self._due) or self._writer.waiting > MOST_UNWRITTEN:
            return
        self._measured = measured
        self._due = True  # until it is done
        began = time.perf_counter()
        outcome = self.execution.tick(measured, moment, obstacles, silent)
        self._figures.ticks.note(time.perf_counter() - began)
        self._due = outcome.changed  # what a tick changed can make another possible at once
        self._again = self._again or self._due
        self._in_a_row = self._in_a_row + 1 if outcome.changed and not news else 0
        self._alarms.restless = outcome.finished if self._in_a_row >= MOST_TICKS else ()
        if self.execution.production is Production.STARTED:  # a task, too, is something to be done
            self.desk.update(self.execution.state, outcome.finished, outcome.ended, moment.epoch)
        self._alarms.note(outcome)
        self._viewing.note(outcome, moment.epoch)
        _log(outcome)

    def _look_after_alarms(self, moment: Timestamp) -> None:
        self._alarms.unjournalled = self._unjournalled()
        number, what = self._kept
        self._alarms.kept = what if number > self._writer.durable else None
        self._alarms.undecided = self._doubting.told(self._alarms.untold)
        self._alarms.questions = self._doubting.questions
        self._alarms.problems = {id_: (self.desk.open[id_].ability, each) for id_, each in self.desk.problems.items()}
        self._alarms.moved = self._by_hand.notices(moment.monotonic)
        self._alarms.look(self._questions.trouble, moment)

    def _note_standing(self, moment: Timestamp) -> None:
        if self.commands and self._standing.due(moment):
            alarms = self._alarms.current(self._questions.trouble, moment)
            controlled = self._in_control.view() is not None
            waits = self._viewing.job_waits(self.desk, alarms, controlled, moment)
            self._standing.look(self._viewing.packml, waits, moment)

    def _obstacles(self) -> tuple[str, ...]:
        """Return what keeps every ability from starting."""
        self._is_unjournalled = self._unjournalled() is not None
        unwritten = ["what has happened to be journalled"] if self._is_unjournalled else []
        began = self.execution.production is Production.STARTED and self._release.released is None
        unsent = ["the first commands to be sent"] if began else []
        return (*self.devices.obstacles(), *unwritten, *unsent)

    def _attempt(self, what: str, act: Callable[[], None]) -> None:
        """Do a piece of work. One that fails is shown and logged, once for each way in which it fails."""
        try:
            act()
        except Exception as error:
            how = f"{type(error).__name__}: {error}"
            if self._alarms.failures.get(what) != how:
                LOG.exception("the controller fails", at=what)
            self._alarms.failures[what] = how
        else:
            self._alarms.failures.pop(what, None)

    def _take(self, news: Callable[[], None]) -> None:
        """Take note of what the planner says."""
        self._attempt("hearing the planner", news)
        self._tick_again()


def _log(outcome: TickOutcome) -> None:
    for name in outcome.ended:
        LOG.info("finished", ability=name)
    for name in outcome.started:
        LOG.info("started", ability=name)
    for name in sorted(outcome.completed):
        LOG.info("completed", operation=name)


async def _first(event: asyncio.Event, seconds: float) -> None:
    """Wait for the event, or so many seconds."""
    try:
        async with asyncio.timeout(seconds):
            await event.wait()
    except TimeoutError:
        return
