"""The real controller on a network inside one process, and what disturbs it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable
from typing import NoReturn

import pytest

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import SetMode, StartProduction
from sequence_planner.controller.features.automatic_start import start_when_alone
from sequence_planner.controller.views.station import Priority, StationView
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.execution.events import Answered, Heard
from sequence_planner.execution.vocabulary import Mode, PlanStatus, Production
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import children
from sequence_planner.language.types import BOOLEAN
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import TransportError
from sequence_planner.ros.transports.memory import MemoryNetwork, MemoryTransport
from sequence_planner.station import ReadyStation
from support.automata import Does, automaton
from support.cell import COMMAND, COMMAND_TYPE, IDENTITY, Arm, Bench, bench, cell
from support.databases import journal
from support.waiting import until_async


def run(scenario: Callable[[Bench], Awaitable[None]]) -> None:
    async def live() -> None:
        async with bench() as on:
            await scenario(on)

    asyncio.run(live())


def alarm(on: Bench, key: str) -> bool:
    """Whether the alarm is there and its cause lasts."""
    found = on.controller.view().alarms.get(key)
    return found is not None and found.ended is None


def completed(on: Bench) -> int:
    return on.controller.view().operations["fetch(left)"].completed


def value(on: Bench, name: str) -> object:
    return on.controller.execution.state[name]


def end_planner() -> None:
    """Kill the planner's process, as the system does when memory is short."""
    (planner,) = planners()
    planner.kill()
    planner.join()


def planners() -> list[Child]:
    return [child for child in children() if child.name == "planner"]


def test_an_operation_is_carried_out() -> None:
    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        with arm.saying("home"):
            await on.until(lambda: value(on, "arm.pose") == "home")
            assert arm.commands == []
            await on.start()
            await on.until(lambda: "out" in arm.commands)
        with arm.saying("out"):
            await on.until(lambda: completed(on) == 1)
        assert on.controller.view().alarms == {}

    run(scenario)


def test_a_planner_that_is_killed_over_a_question_is_asked_again() -> None:
    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        with arm.saying("home"):
            await on.until(lambda: value(on, "arm.pose") == "home")
            await on.start()
            await on.until(lambda: on.controller.execution.plan.status is PlanStatus.PLANNING and bool(planners()))
            end_planner()
            await on.until(lambda: alarm(on, "planner"))
            await on.until(lambda: "out" in arm.commands)
            await on.until(lambda: not alarm(on, "planner"))

    run(scenario)


def test_a_tick_that_raises_has_not_happened_and_is_taken_once_it_can_be(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error strikes after a start: half a tick must not be published, now or later."""

    def broken(changed: bool) -> NoReturn:
        raise RuntimeError("a rare case")

    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        execution = on.controller.execution
        with arm.saying("home"):
            await on.until(lambda: value(on, "arm.pose") == "home")
            await on.start()
            await on.until(lambda: execution.plan.status is PlanStatus.PLANNING)
            monkeypatch.setattr(execution, "_update_operations", broken)
            await on.until(lambda: execution.plan.status is PlanStatus.FOLLOWED)
            await on.until(lambda: alarm(on, "controller:a tick"))
            ticks = execution.ticks
            await asyncio.sleep(0.3)
            shown = on.controller.view().alarms["controller:a tick"]
            assert shown.priority is Priority.HIGH
            assert "RuntimeError: a rare case" in shown.text
            assert set(arm.commands) == {"home"}
            assert value(on, "arm.goto") == "home"
            assert execution.plan.order.names == ("arm.move(out)",)
            assert not execution.plan.order.running
            assert execution.ticks == ticks
            monkeypatch.undo()
            await on.until(lambda: "out" in arm.commands)
            await on.until(lambda: not alarm(on, "controller:a tick"))

    run(scenario)


def test_a_command_that_cannot_be_sent_is_owed_and_nothing_is_started_meanwhile(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuses(self: MemoryTransport, topic: str, type_name: str, data: bytes) -> NoReturn:
        raise TransportError("the network is down")

    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        with arm.saying("home"):
            await on.until(lambda: value(on, "arm.pose") == "home")
            with monkeypatch.context() as broken:
                broken.setattr(on.transport, "publish", refuses.__get__(on.transport))
                await on.start()
                await on.until(lambda: on.controller.execution.plan.status is PlanStatus.FOLLOWED)
                await on.until(lambda: alarm(on, "command"))
                shown = on.controller.view()
                assert shown.alarms["command"].priority is Priority.HIGH
                assert shown.topics[COMMAND].trouble == "the network is down"
                owed = [f"the command on {COMMAND} to be sent"]
                await on.until(lambda: on.controller.view().plan.steps[0].waits_for == owed)
                assert value(on, "arm.goto") == "home"
            await on.until(lambda: arm.commands[-1:] == ["out"])
            assert arm.commands[0] == "home", "what was owed comes first"
            assert not alarm(on, "command")

    run(scenario)


def test_production_is_not_started_beside_another_commander() -> None:
    async def scenario(on: Bench) -> None:
        other = on.network.join(cell()[0].registry, "other", asyncio.get_running_loop())
        other.advertise(COMMAND, COMMAND_TYPE, QualityOfService.RELIABLE)
        with pytest.raises(CommandRefused, match="/other also publishes /arm/command") as refused:
            await on.start()
        assert refused.value.slug == "other-controller"
        other.close()
        await on.start()
        assert on.controller.execution.production is Production.STARTED

    run(scenario)


def test_nothing_is_started_while_another_commands_the_same_devices() -> None:
    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        await on.start()
        other = on.network.join(cell()[0].registry, "other", asyncio.get_running_loop())
        other.advertise(COMMAND, COMMAND_TYPE, QualityOfService.RELIABLE)
        await on.until(lambda: alarm(on, "rival"))
        with arm.saying("home"):
            await on.until(lambda: on.controller.execution.plan.status is PlanStatus.FOLLOWED)
            await asyncio.sleep(0.2)
            assert value(on, "arm.goto") == "home"
            assert "/other also publishes" in on.controller.view().plan.steps[0].waits_for[0]
            other.close()
            await on.until(lambda: "out" in arm.commands)

    run(scenario)


@pytest.mark.parametrize("real", ["commands", "reports"])
def test_production_starts_by_itself_with_emulated_devices_only(real: str) -> None:
    """A real device that speaks or listens is never commanded without a person."""

    async def scenario(on: Bench) -> None:
        device = on.network.join(cell()[0].registry, "real_arm", asyncio.get_running_loop())
        if real == "commands":
            device.subscribe(COMMAND, COMMAND_TYPE, QualityOfService.RELIABLE, lambda samples: None)
        else:
            Arm(on.network, "other_arm")
        starting = asyncio.create_task(start_when_alone(on.controller, on.controller.command, look_every=0.02))
        await asyncio.sleep(0.2)
        Arm(on.network)
        await asyncio.sleep(0.2)
        assert on.controller.view().production is Production.WAITING
        assert not starting.done()
        if real == "commands":
            device.close()
            await asyncio.wait_for(starting, 5)
        else:
            await on.start()  # a person may
            await asyncio.wait_for(starting, 5)
        assert on.controller.execution.production is Production.STARTED

    run(scenario)


def test_each_value_of_a_burst_has_its_own_tick() -> None:
    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        arm.say("home")
        await on.until(lambda: value(on, "arm.pose") == "home")
        arm.say("out", "unknown", "home")
        await on.until(lambda: value(on, "arm.pose") == "home" and completed(on) == 1)

    run(scenario)


def test_what_was_said_while_the_controller_stood_still_counts_and_is_then_old() -> None:
    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        arm.say("home")
        await on.until(lambda: value(on, "arm.pose") == "home")
        arm.say("out")
        time.sleep(1.2)  # noqa: ASYNC251 - the loop stands still, and with it the controller
        await on.until(lambda: completed(on) == 1)
        await on.until(lambda: value(on, "arm.pose") is None)

    run(scenario)


def test_a_mode_is_taken_at_once_and_keeps_the_plan() -> None:
    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        await on.controller.command(SetMode(actor=SYSTEM, mode=Mode.PAUSED))
        with arm.saying("home"):
            await on.start()
            await on.until(lambda: on.controller.execution.plan.status is PlanStatus.FOLLOWED)
            await asyncio.sleep(0.2)
            assert set(arm.commands) == {"home"}
            (step,) = on.controller.view().plan.steps
            assert step.waits_for == ["automatic mode: the station is paused"]
            await on.controller.command(SetMode(actor=SYSTEM, mode=Mode.AUTOMATIC))
            await on.until(lambda: "out" in arm.commands, seconds=1)

    run(scenario)


def test_a_station_at_rest_does_nothing() -> None:
    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        with arm.saying("out"):
            await on.start()
            await on.until(lambda: completed(on) == 0 and value(on, "arm.pose") == "out")
            await asyncio.sleep(0.3)
            ticks, used = on.controller.execution.ticks, time.process_time()
            await asyncio.sleep(1)
            assert on.controller.execution.ticks == ticks
            assert time.process_time() - used < 0.25

    run(scenario)


def test_production_is_started_once() -> None:
    async def scenario(on: Bench) -> None:
        await on.start()
        with pytest.raises(CommandRefused) as refused:
            await on.controller.command(StartProduction(actor=SYSTEM))
        assert refused.value.slug == "production-started"

    run(scenario)


def test_a_station_that_never_comes_to_rest_is_said_and_paced() -> None:
    """A finish whose guard goes on holding: a model's mistake must not take all the machine's time."""
    blinking = automaton(
        {"blink": Does(start=(), finish="true", finally_=("on := false if on", "on := true if not on"))},
        estimated={"on": (BOOLEAN, False)},
    )
    everything_is_safe = Supervisor(StateSet((), ()), {})

    async def scenario(database: Database) -> None:
        registry = cell()[0].registry
        transport = MemoryNetwork().join(registry, "sequence_planner", asyncio.get_running_loop())
        station = ReadyStation(blinking, StationPipelines({}, {}), registry)
        controller = build_controller(IDENTITY, station, everything_is_safe, transport, database)
        controller.take_command()
        running = asyncio.create_task(controller.run())
        await until_async(lambda: "restless" in controller.view().alarms)
        assert "blink" in controller.view().alarms["restless"].text
        ticks = controller.execution.ticks
        await asyncio.sleep(1)
        assert controller.execution.ticks - ticks < 100
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)

    with journal() as database:
        asyncio.run(scenario(database))


@pytest.mark.parametrize("why", ["its node has gone", "it says nothing more"])
def test_a_value_that_is_unknown_and_the_alarm_of_its_device_are_in_one_view(
    why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Soon after the start only a node that has gone is known to be silent: it is looked for once it is missed."""
    monkeypatch.setattr("sequence_planner.controller.io.devices.GRAPH_EVERY", 60.0)

    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        arm.say("home")
        await on.until(lambda: value(on, "arm.pose") == "home")
        on.controller.devices.see_network()
        if why == "its node has gone":
            arm.transport.close()
        else:
            monkeypatch.setattr("sequence_planner.controller.io.links.GRACE", 0.0)
        while (view := on.controller.view()).variables["arm.pose"].value is not None:
            assert not view.alarms
            on.controller.changed.clear()
            await asyncio.wait_for(on.controller.changed.wait(), 20)
        assert list(view.alarms) == ["silent:arm"]

    run(scenario)


def test_an_operation_says_which_steps_are_for_it_and_when_it_was_done_last() -> None:
    """From the moment the plan is there, which comes between two ticks."""

    async def scenario(on: Bench) -> None:
        arm = Arm(on.network)
        views: list[StationView] = []

        def hear(heard: Heard) -> None:
            if isinstance(heard.happening, Answered):
                views.append(on.controller.view())

        on.controller.execution.listeners.append(hear)
        with arm.saying("home"):
            await on.start()
            await on.until(lambda: bool(views))
            view = views[0]
            fetch = view.operations["fetch(left)"]
            assert {fetch.first_step, fetch.last_step} <= {step.id for step in view.plan.steps}
            assert fetch.last_step is not None
            assert fetch.steps == [step.id for step in view.plan.steps]
            assert (fetch.began, fetch.ended) == (None, None)
            assert view.plan.since <= view.time
        with arm.saying("out"):
            await on.until(lambda: completed(on) == 1)
            view = on.controller.view()
            fetch = view.operations["fetch(left)"]
            assert fetch.began is not None
            assert fetch.ended is not None
            assert fetch.began < fetch.ended <= view.time
            assert fetch.work, "a step ran for it"
            began, ended = fetch.work[0].began, fetch.work[-1].ended
            assert ended is not None
            assert fetch.began <= began < ended <= fetch.ended

    run(scenario)
