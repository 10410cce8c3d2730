"""Builds the controller of a station: the one place that knows all of its parts, and who listens to whom."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.alarms.sources import AlarmSources, build_alarms
from sequence_planner.controller.commands.bus import CommandBus, QueryBus
from sequence_planner.controller.commands.registry import COMMANDS, QUERIES
from sequence_planner.controller.controller import Controller, Parts
from sequence_planner.controller.features.control_lock import ControlLock
from sequence_planner.controller.features.failures import Failures
from sequence_planner.controller.features.jobs import JobHandler
from sequence_planner.controller.features.modes import Modes
from sequence_planner.controller.features.pipelines import PipelineTraffic
from sequence_planner.controller.features.records import Records
from sequence_planner.controller.features.tasks import TaskHandler
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.ticks import Ticker
from sequence_planner.controller.metrics import Figures
from sequence_planner.controller.planner_client import AdvisorClient, PlannerQuestions
from sequence_planner.controller.recovery.build import build_recovery
from sequence_planner.controller.recovery.consistency import KIND as BELIEFS
from sequence_planner.controller.recovery.consistency import Beliefs, ConsistencyMonitor
from sequence_planner.controller.recovery.explain import ConditionContext
from sequence_planner.controller.recovery.manual import ByHand
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.builder import ViewBuilder
from sequence_planner.controller.views.station import StationIdentity
from sequence_planner.db.database import Database
from sequence_planner.execution.executor import Executor
from sequence_planner.journal.writer import Fence
from sequence_planner.ros.transport import Transport
from sequence_planner.station import ReadyStation


def build_controller(
    identity: StationIdentity,
    station: ReadyStation,
    supervisor: Supervisor,
    transport: Transport,
    database: Database,
    known: RestoredState | None = None,
    fence: Fence = lambda _: True,
) -> Controller:
    """Build what runs `station` and writes into the journal of `database`; `known` is what came back from there.

    Raises `ValueError` when nobody handles one of the commands or queries.
    """
    automaton, known = station.automaton, known or RestoredState()
    wake, failures = asyncio.Event(), Failures()
    execution = Executor(automaton, supervisor, known.beginning)
    devices = Devices(station, transport, wake.set)
    # Whoever listens to the execution hears of each event in this order: it is written down first.
    records = Records(execution, known.beginning, devices, database, fence, failures, wake.set)
    tasks = TaskHandler(automaton, station.pipelines.feeds)
    outside = SafeStateMonitor(execution)
    adviser = AdvisorClient(automaton, supervisor)

    beliefs = Beliefs(execution, known.beginning, known.beliefs, partial(records.add_note, BELIEFS, lasts=True))
    records.recorder.know(BELIEFS, beliefs.document())
    alarms = build_alarms(execution, outside, devices, records, failures.known, known, adviser.expect)
    by_hand = ByHand(execution, station.pipelines, records.add_note)
    consistency = ConsistencyMonitor(execution)
    ticker = Ticker(execution, devices, tasks, records, failures, wake.set)

    def take_news(news: Callable[[], None]) -> None:
        """Take note of what the planner says."""
        failures.attempt("hearing the planner", news)
        ticker.again()

    planner = PlannerQuestions(execution, outside, take_news)
    sources = AlarmSources(alarms, records, ticker, tasks, consistency, by_hand, lambda: planner.trouble)
    in_control = ControlLock(known.control)
    viewing = ViewBuilder(identity, execution, outside, devices, beliefs, tasks, records, sources, in_control)
    ticker.listeners += [lambda outcome, moment: alarms.note(outcome), viewing.note]
    around = ConditionContext(devices.feeds.heard_on, viewing.since, beliefs, lambda: viewing.guards)
    recovery = build_recovery(
        execution,
        adviser,
        beliefs,
        consistency,
        alarms.still,
        in_control,
        around,
        devices.real_devices,
        lambda command, moment: bus.perform(command, moment),  # noqa: PLW0108
    )
    features = (
        Modes(execution, outside, devices, consistency),
        tasks,
        JobHandler(execution),
        recovery.corrections,
        recovery.offers,
        recovery.trials,
        recovery.forces,
        recovery.approvals,
        in_control,
        alarms,
        PipelineTraffic(station.pipelines, devices),
        devices.overrides,
        consistency,
        recovery.why_not,
        Figures(
            records.writer,
            lambda: records.trouble is not None,
            ticker.took,
            planner.answers,
            lambda: {"planner": planner.replaced, "adviser": adviser.replaced},
        ),
    )
    viewing.show(features)
    bus = CommandBus(
        features,
        COMMANDS.values(),
        in_control=in_control,
        require_one=recovery.approvals.require_one,
        real_devices=devices.real_devices,
    )
    works = (
        ("sending commands", records.repeat),
        ("looking for contradictions", lambda moment: consistency.look()),
        ("looking after alarms", sources.update),
        ("noting how it stands", viewing.note_standing),
        ("asking the planner", lambda moment: planner.ask(moment.monotonic)),
    )
    return Controller(
        Parts(
            execution=execution,
            devices=devices,
            records=records,
            ticker=ticker,
            failures=failures,
            alarms=alarms,
            consistency=consistency,
            viewing=viewing,
            commands=bus,
            queries=QueryBus(features, QUERIES.values()),
            works=works,
            close=(devices.close, planner.close, consistency.close, adviser.close),
            wake=wake,
        )
    )
