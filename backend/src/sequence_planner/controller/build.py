"""Builds the controller of a station: the one place that knows all of its parts, and who listens to whom."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.alarms.build import build_alarms
from sequence_planner.controller.commands.bus import CommandBus, QueryBus
from sequence_planner.controller.commands.registry import COMMANDS, QUERIES
from sequence_planner.controller.controller import Controller, Parts
from sequence_planner.controller.features.control_lock import ControlLock
from sequence_planner.controller.features.failures import Failures
from sequence_planner.controller.features.jobs import JobHandler, JobViews
from sequence_planner.controller.features.modes import Modes
from sequence_planner.controller.features.plan import KIND as OPERATIONS
from sequence_planner.controller.features.plan import LivePlan, Operations
from sequence_planner.controller.features.records import Records
from sequence_planner.controller.features.tasks import OpenTasks, TaskHandler
from sequence_planner.controller.features.variables import KIND as BELIEFS
from sequence_planner.controller.features.variables import Beliefs, Variables
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.ticks import Ticker
from sequence_planner.controller.metrics import Figures
from sequence_planner.controller.planner_client import AdvisorClient, PlannerQuestions
from sequence_planner.controller.recovery.build import build_recovery
from sequence_planner.controller.recovery.consistency import ConsistencyMonitor
from sequence_planner.controller.recovery.manual import ByHand
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.tracing.build import build_lookers
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
    tasks, in_control = TaskHandler(automaton, station.pipelines.feeds), ControlLock(known.control)
    advisor = AdvisorClient(automaton, supervisor)
    beliefs = Beliefs(execution, known.beginning, known.beliefs, partial(records.add_note, BELIEFS, lasts=True))
    records.recorder.know(BELIEFS, beliefs.document())
    watching = build_alarms(execution, devices, records, known, advisor.expect)
    alarms, links, outside, consequences = watching.alarms, watching.links, watching.outside, watching.consequences
    consistency = ConsistencyMonitor(execution, untold=lambda: links.untold)
    ticker = Ticker(execution, devices, tasks, records, failures, wake.set)

    def take_news(news: Callable[[], None]) -> None:
        """Take note of what the planner says."""
        failures.attempt("hearing the planner", news)
        ticker.again()

    planner = PlannerQuestions(execution, outside, take_news)
    viewing = ViewBuilder(identity, execution)
    variables = Variables(execution, devices.feeds.heard_on, beliefs)
    around, forces, breakpoints, approvals, recovery = build_recovery(
        execution,
        advisor,
        beliefs,
        consistency,
        watching.still,
        in_control,
        devices.feeds.heard_on,
        station.pipelines.timed,
        variables.since,
        lambda: viewing.guards,
        devices.real_devices,
        lambda command, moment: bus.perform(command, moment),  # noqa: PLW0108
    )
    plan = LivePlan(execution, consequences, around, lambda: planner.trouble, lambda: links.untold)
    operations = Operations(
        execution, plan.timetable, known.progress, partial(records.add_note, OPERATIONS, lasts=True)
    )
    records.recorder.know(OPERATIONS, operations.journalled())
    jobs = JobViews(
        execution,
        lambda: records.jobs,
        tasks,
        alarms,
        lambda: in_control.holder is not None,
        consequences.held_up,
        around,
    )
    modes = Modes(execution, outside, devices, links, consistency, alarms, jobs.waits, records.add_note)
    ticker.listeners += [each.after_tick for each in (variables, watching.abilities, operations, plan)]
    ticker.listeners.append(breakpoints.take_note)
    features = (  # in this order their alarms are looked at, and then shown
        links,
        watching.who_can,
        watching.abilities,
        watching.operator_plans,
        plan,
        failures,
        ticker,
        records,
        outside,
        watching.beginning,
        consistency,
        forces,
        breakpoints,
        OpenTasks(execution, tasks, modes.goes_on, consequences.waiting_for),
        ByHand(execution, station.pipelines, records.add_note),
        watching.of_model,
        alarms,
        modes,
        jobs,
        variables,
        operations,
        tasks,
        JobHandler(execution),
        *recovery,
        approvals,
        in_control,
        *build_lookers(execution, station, devices, variables, around),
        devices,
        devices.overrides,
        Figures(
            records.writer,
            lambda: records.trouble is not None,
            ticker.took,
            planner.answers,
            lambda: {"planner": planner.replaced, "adviser": advisor.replaced},
        ),
    )
    alarms.look_at(features)
    viewing.show(features)
    bus = CommandBus(
        features,
        COMMANDS.values(),
        in_control=in_control,
        require_one=approvals.require_one,
        real_devices=devices.real_devices,
    )
    works = (
        ("sending commands", records.repeat),
        ("looking for contradictions", lambda moment: consistency.look()),
        ("looking after alarms", alarms.look),
        ("pausing after the product", modes.stop_after_cycle),
        ("pausing at a breakpoint", breakpoints.pause),
        ("noting how it stands", modes.note_standing),
        ("asking the planner", lambda moment: planner.ask(moment.monotonic)),
    )
    return Controller(
        Parts(
            execution=execution,
            devices=devices,
            records=records,
            ticker=ticker,
            attempt=failures.attempt,
            viewing=viewing,
            commands=bus,
            queries=QueryBus(features, QUERIES.values()),
            works=works,
            begin=consistency.begin,
            close=(devices.close, planner.close, consistency.close, advisor.close),
            wake=wake,
        )
    )
