"""The controller: one event loop on which messages, commands, plans and time become ticks, and ticks become messages.

It never waits for anything but its own events. Messages and acknowledgements wake it at once; otherwise it looks at the
clock often enough to notice a topic that fell silent and a command that is due again.

An error in one piece of its work takes nothing else down: a tick that raises has not happened, an alarm says so, and it
is tried again at the next look at the clock.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial

import structlog

from sequence_planner.analysis.document import AnalysisDocument
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.control.alarms import Alarms
from sequence_planner.control.clients import Clients
from sequence_planner.control.command_desk import CommandDesk
from sequence_planner.control.commander import Commander
from sequence_planner.control.commands import (
    Command,
    CommandRefused,
)
from sequence_planner.control.execution import Execution, TickOutcome
from sequence_planner.control.feeds import Feeds
from sequence_planner.control.inbox import Inbox
from sequence_planner.control.link_messages import About
from sequence_planner.control.moment import Moment
from sequence_planner.control.network_watch import NetworkWatch
from sequence_planner.control.observing import Observing
from sequence_planner.control.outside import Outside
from sequence_planner.control.overrides import Overrides
from sequence_planner.control.pipeline_graph import pipelines_view
from sequence_planner.control.pipeline_view import FlowsView, PipelinesView
from sequence_planner.control.questions import Questions
from sequence_planner.control.tasks import TaskDesk
from sequence_planner.control.view import Production, StationIdentity, StationView
from sequence_planner.control.viewing import Viewing
from sequence_planner.emulation.process import NODE as EMULATED_DEVICES
from sequence_planner.expressions.types import Value
from sequence_planner.planning.plan import Circumstances
from sequence_planner.ros.service_graph import TellsServices
from sequence_planner.ros.transport import QualityEvent, Sample, Transport
from sequence_planner.station import ReadyStation
from sequence_planner.synthesis.guards import Guard

LOG = structlog.get_logger(__name__)

LOOK_EVERY = 0.05  # seconds between two looks at the clock
GRAPH_EVERY = 1.0  # seconds between two looks at the ROS graph
MOST_TICKS = 100  # in a row without anything new; then the station is taken to be restless


class Controller:
    """A running station. Used from one event loop; `run` is its life."""

    def __init__(
        self,
        identity: StationIdentity,
        station: ReadyStation,
        supervisor: Supervisor,
        transport: Transport,
    ) -> None:
        automaton, pipelines, registry = station.automaton, station.pipelines, station.registry
        self.execution = Execution(automaton, supervisor)
        self.execution.production = Production.WAITING
        self.desk = TaskDesk(automaton, pipelines.feeds)
        self.feeds = Feeds(pipelines, registry, automaton.initial_valuation)
        self.network = NetworkWatch(pipelines, registry)
        self._transport = transport
        transport.watch(self._hear_quality)
        self._inbox = Inbox(self.feeds.reports)
        self._wake = asyncio.Event()
        self._clients = Clients(pipelines, registry, transport, self.feeds, self._hear)
        self._commander = Commander(pipelines.outgoing, registry, transport)
        self._overrides = Overrides(pipelines, self.feeds, self._commander, self._clients)
        self._orders = CommandDesk(
            self.execution, self.desk, self._overrides, self._start_production, self._real_devices
        )
        self._observing = Observing()
        self._pipelines = pipelines
        self._outside = Outside(self.execution)
        self._alarms = Alarms(self.execution, self._outside, self.feeds, self.network, self._commander)
        self._viewing = Viewing(identity, self.execution, self._outside, self.feeds, self.network)
        self._questions = Questions(self.execution, self._outside, self._take)
        self._measured: dict[str, Value | None] = {}
        self._again = False
        self._due = True  # a tick is wanted whatever the measurements say
        self._in_a_row = 0  # ticks that only followed from the one before
        self._next_graph = 0.0
        for pipeline in pipelines.incoming.values():
            transport.subscribe(pipeline.topic.name, pipeline.topic.type_name, pipeline.topic.quality, self._hear)

    async def run(self) -> None:
        """Tick until cancelled."""
        try:
            while True:
                moment = Moment.now()
                self._step(moment)
                if self._inbox or (self._again and self._in_a_row < MOST_TICKS):
                    await asyncio.sleep(0)
                else:
                    self._wake.clear()
                    await _first(self._wake, self._rest())
        finally:
            self._clients.close()
            self.feeds.running.close()
            self._commander.close()
            self._questions.close()

    def _rest(self) -> float:
        """Seconds until the next look at the clock: at the latest when a stage of a pipeline waits for it."""
        is_started = self.execution.production is Production.STARTED
        dues = [due for due in (self.feeds.due, self._commander.due if is_started else None) if due is not None]
        return min(LOOK_EVERY, max(0.0, min(dues) - time.monotonic())) if dues else LOOK_EVERY

    async def command(self, command: Command) -> None:
        """Carry out a command. Raises `CommandRefused`."""
        self._orders.carry_out(command, Moment.now())
        LOG.info("command", **command.model_dump(mode="json"))
        self._tick_again()

    def view(self) -> StationView:
        """What there is to show now."""
        moment = Moment.now()
        alarms = self._alarms.current(self._questions.trouble, moment)
        overrides, control = self._overrides.view(moment), self._orders.in_control.view()
        return self._viewing.view(self.desk, self._commander, overrides, alarms, control, moment)

    def answer(self, about: About) -> PipelinesView | FlowsView:
        """What is told only when somebody asks for it."""
        if about == "pipelines":
            return pipelines_view(self._pipelines)
        outgoing = self._commander.observed() | self._clients.observed()
        return self._observing.view(self.feeds.observed() | outgoing, Moment.now())

    def know(self, analysis: AnalysisDocument, guards: Mapping[str, Guard] | None) -> None:
        """Take note of what synthesis has found beside the supervisor, to be shown."""
        self._viewing.analysis, self._viewing.guards = analysis, guards or {}

    def strangers(self, node: str) -> list[str]:
        """What speaks against the station's devices being those of `node` alone, as the network is now."""
        return self.network.strangers(self._transport.graph(), node)

    def _real_devices(self) -> list[str]:
        return self.network.others(self._transport.graph(), f"/{EMULATED_DEVICES}")

    def note_unrecorded(self, why: str | None) -> None:
        """Commands cannot be recorded, for this reason; None when they can again."""
        self._alarms.unrecorded = why

    def _start_production(self) -> None:
        if self.execution.production is Production.STARTED:
            raise CommandRefused("production-started", "Production is started", "Production has been started already.")
        self._see_network()
        if self.network.rivals:
            text = "; ".join(self.network.rivals.values())
            raise CommandRefused(
                "other-commander", "Somebody else commands the devices", f"{text}. Stop the other one."
            )
        self.execution.start_production()
        now = Moment.now().monotonic
        self._commander.publish_all(self.execution.published, now)
        self._clients.heed(self.execution.published, now)

    def _hear(self, samples: Sequence[Sample]) -> None:
        self._inbox.put(samples)
        self._wake.set()

    def _hear_quality(self, event: QualityEvent) -> None:
        """A quality of service is not kept; on what is not agreed on, `network` looks itself."""
        if event.kind == "incompatible":
            LOG.warning("a quality of service is not agreed on", topic=event.topic, text=event.text)
        elif event.topic in self.feeds.topics:
            self.feeds.abandon(event.topic, event.text)
            self._wake.set()
        else:
            self.feeds.reports.note(event.topic, event.text, time.monotonic(), lasting=False)

    def _tick_again(self) -> None:
        self._due = self._again = True
        self._in_a_row = 0
        self._wake.set()

    def _look_at_network(self, moment: Moment) -> None:
        if moment.monotonic >= self._next_graph:
            self._next_graph = moment.monotonic + GRAPH_EVERY
            self._see_network()

    def _see_network(self) -> None:
        graph = self._transport.graph()
        ends = self._transport.services() if isinstance(self._transport, TellsServices) else None
        for topic in self.network.look(graph, ends):
            if topic in self.feeds.topics:
                self.feeds.abandon(topic)
        self._clients.look(graph)

    def _step(self, moment: Moment) -> None:
        """All ticks that are due: one for each part of what was heard, and one for the look at the clock."""
        self._attempt("looking at the network", lambda: self._look_at_network(moment))
        self._again = False
        for part in self._inbox.parts():
            # What a message says counts from when it was received, however late its turn comes.
            self._attempt("a tick", partial(self._tick, part, moment, part[-1].received))
        self._attempt("a tick", lambda: self._tick((), moment, moment.monotonic))
        self._attempt("sending commands", lambda: self._repeat(moment))
        self._attempt("asking the planner", lambda: self._questions.ask(moment.monotonic))

    def _repeat(self, moment: Moment) -> None:
        if self.execution.production is Production.STARTED:
            self._commander.repeat(moment.monotonic)
            self._clients.heed(self.execution.published, moment.monotonic)

    def _tick(self, samples: Sequence[Sample], moment: Moment, monotonic: float) -> None:
        """Take messages of `monotonic`, of which no topic has more than one, and tick if that is something new."""
        self.feeds.take(samples)
        self.feeds.wake(monotonic)
        measured = self.feeds.measured(monotonic) | self.desk.measured()
        obstacles = self._obstacles()
        circumstances = Circumstances(self.feeds.offline(monotonic))
        news = (measured, obstacles, circumstances) != (
            self._measured,
            self.execution.obstacles,
            self.execution.circumstances,
        )
        if not news and not self._due:
            return
        self._measured, self.execution.obstacles = measured, obstacles
        self.execution.face(circumstances)
        self._due = True  # until it is done
        outcome = self.execution.tick(measured, moment)
        self._due = outcome.changed  # what a tick changed can make another possible at once
        self._again = self._again or self._due
        self._in_a_row = self._in_a_row + 1 if outcome.changed and not news else 0
        self._alarms.restless = outcome.finished if self._in_a_row >= MOST_TICKS else ()
        if self.execution.production is Production.STARTED:
            self._commander.publish(self.execution.published, moment.monotonic)
            self._clients.heed(self.execution.published, moment.monotonic)
        self.desk.update(self.execution.state, outcome.finished, outcome.ended, moment.epoch)
        self._alarms.note(outcome)
        self._viewing.note(outcome, moment.epoch)
        _log(outcome)

    def _obstacles(self) -> tuple[str, ...]:
        """What keeps every ability from starting."""
        owed = [f"the command on {topic} to be sent" for topic in self._commander.owed]
        return (*self.network.rivals.values(), *owed)

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
