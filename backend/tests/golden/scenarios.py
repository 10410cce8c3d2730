"""What happens in each golden journal, life by life, and which kinds of records it must have."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from core.actors import EVA
from golden.life import WHY, Life
from sequence_planner.actor import SYSTEM
from sequence_planner.automaton.structure import Kind
from sequence_planner.control.commands import SetMode
from sequence_planner.control.job_commands import ForgetJob, JobOperation, JobWait, SequenceJobs, SetByOrder
from sequence_planner.control.production_commands import ServiceKind, SetStepping, TakeStep
from sequence_planner.control.restart_commands import (
    ConfirmEstimates,
    ReleaseForce,
    StopErrand,
    TryAbility,
    UndoCorrection,
)
from sequence_planner.control.view import Mode
from sequence_planner.emulation.faults import FaultKind

STATIONS: Final = Path(__file__).parents[3] / "models"
BOLTS, TRUCK = STATIONS / "bolt_tightening", STATIONS / "truck_engine_station"
PAIR: Final = {BOLTS: "bolt_pair_1", TRUCK: "AtBoltPair1TCPPose"}
Script = Callable[[Life], Awaitable[None]]


@dataclass(frozen=True)
class Scenario:
    """A journal: the station, what is done in each life of its controller, and kinds of records that must come of it.

    Before the second life another model is deployed, where `edit` says how one text of its operations takes the place
    of another. Devices begin anew with the second life unless they `stay`.
    """

    station: Path
    lives: tuple[Script, ...]
    kinds: frozenset[str] = frozenset()
    edit: tuple[str, str] | None = None


async def produce(life: Life) -> None:
    await life.start()
    await life.work(30)


async def pause_and_hold(life: Life) -> None:
    await life.start()
    for mode in (Mode.PAUSED, Mode.HOLD, Mode.HOLD, Mode.PAUSED):
        await life.work(2)
        await life.mode(mode)
        await asyncio.sleep(0.4)
        await life.mode(Mode.AUTOMATIC)
    await life.work(3)


async def step(life: Life) -> None:
    await life.start()
    await life.work(1)
    await life.controller.command(SetStepping(actor=EVA, on=True))
    for _ in range(6):
        await life.controller.command(TakeStep(actor=EVA))
        await asyncio.sleep(0.5)
    await life.controller.command(SetStepping(actor=EVA, on=False))
    await life.work(3)


async def nothing_heard(life: Life) -> None:
    """Each resource falls silent while the station works, and comes back."""
    await life.start()
    for resource in _resources(life):
        await life.work(1)
        life.devices.fail(FaultKind.SILENT, resource, 3.0)
        await asyncio.sleep(3.5)
    await life.work(3)


async def faults(life: Life) -> None:
    """Random faults from which a station recovers by itself."""
    await life.start()
    resources = _resources(life)
    for kind in (
        FaultKind.STUCK,
        FaultKind.SLOW,
        FaultKind.GARBAGE,
        FaultKind.DROP,
        FaultKind.OFFLINE,
        FaultKind.STUCK,
    ):
        amount = {FaultKind.SLOW: 3.0, FaultKind.DROP: 0.5}.get(kind, 1.0)
        life.devices.fail(kind, life.chance.choice(resources), life.chance.uniform(0.5, 1.5), amount=amount)
        await asyncio.sleep(life.chance.uniform(1.0, 1.6))
    await life.work(3)


async def moved_by_hand(life: Life) -> None:
    """Devices are moved by hand and started again; then estimates are whatever somebody says, and it goes on."""
    await life.start()
    automaton = life.controller.execution.automaton
    for _ in range(6):
        name = life.chance.choice(sorted(life.devices.emulated.topics))
        life.devices.emulated.put(name, life.chance.choice(automaton.variables[name].type.domain))
        await asyncio.sleep(0.7)
    life.devices.fail(FaultKind.RESTARTED, life.chance.choice(_resources(life)), 0.5)
    await asyncio.sleep(1.0)
    await life.enter_restart()
    for _ in range(3):
        name = life.chance.choice(automaton.names(Kind.ESTIMATED))
        await life.correct({name: life.chance.choice(automaton.variables[name].type.domain)})
        await asyncio.sleep(0.3)
    await life.leave_restart()
    await asyncio.sleep(2.0)


async def correct(life: Life) -> None:
    bolt = f"bolts[{PAIR[_station(life)]}]"
    await life.start()
    await life.work(2)
    await life.enter_restart()
    await life.correct({bolt: "tightened"})
    await asyncio.sleep(0.3)
    last = life.view.last_correction
    assert last is not None
    await life.controller.command(UndoCorrection(actor=EVA, reason=WHY, revision=last.revision))
    await life.correct({bolt: "placed"})
    seen = life.value(bolt)
    assert seen is not None
    await life.controller.command(ConfirmEstimates(actor=EVA, reason=WHY, values={bolt: seen}))
    await life.leave_restart()
    await life.work(4)


async def work_by_order(life: Life) -> None:
    """Jobs, one behind the other: the first is paused, goes on, and is stopped, the second aborted and forgotten."""
    master, jobs = next(iter(life.controller.execution.automaton.work_masters.items()))
    first, *_, last = jobs.operations
    await life.start()
    await life.controller.command(SetByOrder(actor=EVA, reason=WHY, on=True))
    await life.job("a", master)
    await life.work(3)
    await life.tell_job("a", "pause")
    await asyncio.sleep(1.0)
    await life.tell_job("a", "resume")
    await life.work(2)
    await life.tell_job("a", "stop")
    await life.until(lambda: life.view.jobs["a"].state == "stopped")
    await life.job("b", master)
    waits = [JobWait(job="b", operation=first, for_=[JobOperation(job="a", operation=last)])]
    await life.controller.command(SequenceJobs(actor=SYSTEM, waits=waits))
    await life.work(2)
    await life.tell_job("b", "abort")
    await life.until(lambda: life.view.jobs["b"].state == "aborted")
    await life.controller.command(ForgetJob(actor=SYSTEM, job="b"))
    await life.job("c", master)
    await life.work(2)
    await life.controller.command(SetByOrder(actor=EVA, reason=WHY, on=False))
    await asyncio.sleep(0.5)


async def ends_at_work(life: Life) -> None:
    """The controller ends while the station works, with a device on its way."""
    await life.start()
    await life.work(4)
    await life.until(lambda: bool(life.controller.execution.running()))


async def goes_on(life: Life) -> None:
    """The controller is there again: a person decides on outputs, says what is there, and the station goes on."""
    await life.start()
    values = {name: life.value(name) for name in life.controller.execution.automaton.names(Kind.ESTIMATED)}
    seen = {name: value for name, value in values.items() if value is not None}
    await life.controller.command(ConfirmEstimates(actor=EVA, reason=WHY, values=seen))
    await life.work(4)


async def force(life: Life) -> None:
    """An output and what a device says are forced, released, and left until their time is over."""
    output, value, measured, other = {
        BOLTS: ("nutrunner.set_tool_idle", True, "robot.pose", "unknown"),
        TRUCK: ("engine.read_tag", False, "agv.act_pos", "moving"),
    }[_station(life)]
    await life.start()
    await life.work(1)
    await life.force(output, value, 60)
    await asyncio.sleep(1.0)
    await life.controller.command(ReleaseForce(actor=EVA, name=output))
    await life.work(2)
    await life.force(measured, other, 1.0)
    await asyncio.sleep(2.0)
    await life.work(2)


async def out_of_service(life: Life) -> None:
    """A resource, an ability and an operation are taken out of service and put back, one by one."""
    automaton = life.controller.execution.automaton
    pair = PAIR[_station(life)]
    await life.start()
    await life.work(2)
    operation = next(name for name in automaton.operations if pair in name)
    ability = next(name for name in automaton.abilities if pair in name and automaton.abilities[name].human)
    for of, name in (
        (ServiceKind.RESOURCE, "nutrunner"),
        (ServiceKind.ABILITY, ability),
        (ServiceKind.OPERATION, operation),
    ):
        await life.service(of, name, False)
        await asyncio.sleep(1.2)
        await life.service(of, name, True)
    await life.work(2)


async def recover(life: Life) -> None:
    """In restart mode a plan by hand is stopped on its way, another one carried out, and the first advice taken."""
    pose, far = {BOLTS: ("robot.pose", "above_engine"), TRUCK: ("robot.pose", "AboveEngineTCPPose")}[_station(life)]
    await life.start()
    await life.work(3)
    await life.enter_restart()
    await life.goal(f"{pose} == {far}")
    await asyncio.sleep(0.2)
    await life.controller.command(StopErrand(actor=EVA))
    await life.until(lambda: not life.controller.execution.running())
    await life.goal(f"{pose} == {far}")
    await life.errand_over()
    if await life.advised() is not None:
        await life.errand_over()
    await life.leave_restart()
    await life.work(2)


async def reset_an_operation(life: Life) -> None:
    """What was done is taken back by a plan to the precondition of an operation, as it is offered in restart mode."""
    await life.start()
    await life.work(4)
    await life.enter_restart()
    await life.reset({BOLTS: "prepare_planning_scene", TRUCK: "identify_engine"}[_station(life)])
    await life.errand_over()
    await life.leave_restart()
    await life.work(2)


async def try_abilities(life: Life) -> None:
    """One run of an ability alone; another one is called off on its way."""
    ability = {BOLTS: "robot.move_to_position(above_engine)", TRUCK: "engine.identify"}[_station(life)]
    await life.start()
    await life.mode(Mode.PAUSED)
    await life.until(lambda: not life.controller.execution.running())
    await life.controller.command(TryAbility(actor=EVA, ability=ability))
    await life.until(lambda: bool(life.controller.execution.running()))
    await life.controller.command(StopErrand(actor=EVA))
    await life.until(lambda: not life.controller.execution.running())
    await life.errand_over()
    if life.controller.execution.startable(ability) is not None:
        await life.controller.command(TryAbility(actor=EVA, ability=ability))
        await life.errand_over()
    await life.controller.command(SetMode(actor=EVA, mode=Mode.AUTOMATIC))
    await life.work(3)


async def by_hand_for_the_robot(life: Life) -> None:
    """The operator switches the robot off and works in its place for a while."""
    await life.start()
    await life.work(3)
    life.devices.emulated.put("operator.takes_over", True)
    await asyncio.sleep(2.5)
    life.devices.emulated.put("operator.takes_over", False)
    await life.work(2)


async def asked(life: Life) -> None:
    """What is believed does not fit what is measured: a person answers the question by a correction."""
    await life.start()
    await life.until(lambda: life.value("engine.tag_is_read") is True)
    await life.enter_restart()
    await life.correct({"ladder_frame": "in_gripper"})
    await life.until(lambda: bool(life.view.questions))
    question = life.view.questions[0]
    await life.correct({question.variable: question.possible[0]})
    await life.until(lambda: not life.view.questions)
    await life.leave_restart()
    await life.work(3)


def _station(life: Life) -> Path:
    return STATIONS / life.view.station.name


def _resources(life: Life) -> list[str]:
    return sorted({each.topic.resource for each in life.station.pipelines.incoming.values()})


ORDERED: Final = frozenset({"by-order-changed", "job-taken", "jobs-sequenced", "job-commanded", "job-forgotten"})
CORRECTED: Final = frozenset({"corrected", "confirmed"})
ERRAND: Final = frozenset({"errand-taken", "errand-stopped", "mode-changed"})
MOVES: Final = {BOLTS: ("title: Tighten {pair}", "title: Tighten {pair} again"), TRUCK: ("priority: 1", "priority: 2")}
_OF_BOTH: Final[dict[str, tuple[tuple[Script, ...], frozenset[str]]]] = {
    "production": ((produce,), frozenset({"asked", "answered", "production-started", "snapshot"})),
    "pause-and-hold": ((pause_and_hold,), frozenset({"mode-changed"})),
    "faults": ((faults,), frozenset({"alarm"})),
    "moved-by-hand": ((moved_by_hand,), frozenset({"corrected"})),
    "corrections": ((correct,), CORRECTED),
    "jobs": ((work_by_order,), ORDERED),
    "restart": ((ends_at_work, goes_on), frozenset({"corrected", "confirmed"})),
    "forces": ((force,), frozenset({"forced", "force-released"})),
    "service": ((out_of_service,), frozenset({"service-changed"})),
    "errands": ((recover,), ERRAND),
}
SCENARIOS: Final[dict[str, Scenario]] = {
    **{
        f"{station.name}-{name}": Scenario(station, lives, kinds)
        for station in (BOLTS, TRUCK)
        for name, (lives, kinds) in _OF_BOTH.items()
    },
    **{
        f"{station.name}-deployment": Scenario(station, (ends_at_work, goes_on), CORRECTED, MOVES[station])
        for station in (BOLTS, TRUCK)
    },
    "bolt_tightening-steps": Scenario(BOLTS, (step,), frozenset({"stepping-changed", "step-taken"})),
    "bolt_tightening-silent": Scenario(BOLTS, (nothing_heard,), frozenset({"explained"})),
    "bolt_tightening-reset": Scenario(BOLTS, (reset_an_operation,), frozenset({"errand-taken"})),
    "bolt_tightening-trials": Scenario(BOLTS, (try_abilities,), frozenset({"errand-taken", "errand-stopped"})),
    "truck_engine_station-by-hand": Scenario(TRUCK, (by_hand_for_the_robot,)),
    "truck_engine_station-questions": Scenario(TRUCK, (asked,), frozenset({"corrected"})),
}
