"""What happens in each golden journal, life by life, and which kinds of records it must have."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from golden.life import WHY, Life
from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.commands.approvals import ReleaseForce
from sequence_planner.controller.commands.execution import EnterRestart, SetStepping, TakeStep
from sequence_planner.controller.commands.jobs import ForgetJob, JobOperation, JobWait, SequenceJobs, SetByOrder
from sequence_planner.controller.commands.recovery import ConfirmEstimates, StopOperatorPlan, TryAbility, UndoCorrection
from sequence_planner.core.actor import SYSTEM
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.simulation.faults import FaultKind
from support.people import EVA
from support.places import MODELS

STATIONS: Final = MODELS
BOLTS, TRUCK = STATIONS / "bolt_tightening", STATIONS / "truck_engine_station"
PAIR: Final = {BOLTS: "bolt_pair_1", TRUCK: "AtBoltPair1TCPPose"}
Script = Callable[[Life], Awaitable[None]]


@dataclass(frozen=True)
class Scenario:
    """A journal: the station, what is done in each life of its controller, and kinds of records that must come of it.

    Where there is an `edit`, one text of a file of the model takes the place of another: what runs from the life
    `since` on, counted from 0, is that model, as if it had been deployed. Devices go on as they are.
    """

    station: Path
    lives: tuple[Script, ...]
    kinds: frozenset[str] = frozenset()
    edit: tuple[str, str, str] | None = None
    since: int = 1


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
        life.devices.emulated.set_value(name, life.chance.choice(automaton.variables[name].type.domain))
        await asyncio.sleep(0.7)
    life.devices.fail(FaultKind.RESTARTED, life.chance.choice(_resources(life)), 0.5)
    await asyncio.sleep(1.0)
    await life.controller.command(EnterRestart(actor=EVA))
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
    """Two jobs: the second waits for the first and is aborted; the first is paused, goes on, and is stopped."""
    second, first = life.controller.execution.automaton.work_masters.values()
    await life.start()
    await life.controller.command(SetByOrder(actor=EVA, reason=WHY, on=True))
    await life.job("a", first.name)
    await life.job("b", second.name)
    before = JobOperation(job="a", operation=list(first.operations)[-1])
    waits = [JobWait(job="b", operation=next(iter(second.operations)), for_=[before])]
    await life.controller.command(SequenceJobs(actor=SYSTEM, waits=waits))
    await life.work(3)
    await life.tell_job("a", "pause")
    await asyncio.sleep(1.0)
    await life.tell_job("a", "resume")
    await life.tell_job("b", "abort")
    await life.work(2)
    await life.tell_job("a", "stop")
    await life.until(lambda: life.view.jobs["a"].state == "stopped")
    await life.controller.command(ForgetJob(actor=SYSTEM, job="b"))
    await life.controller.command(SetByOrder(actor=EVA, reason=WHY, on=False))
    await life.work(2)


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
        await asyncio.sleep(4.0 if of is ServiceKind.RESOURCE else 1.2)  # it is found out why there is no plan
        await life.service(of, name, True)
    await life.work(2)


async def recover(life: Life) -> None:
    """In restart mode a plan by hand is stopped on its way, another one carried out, and the first advice taken."""
    await life.start()
    await life.work(3)
    await life.enter_restart()
    await life.goal(_elsewhere(life))
    await asyncio.sleep(0.2)
    await life.controller.command(StopOperatorPlan(actor=EVA))
    await life.until(lambda: not life.controller.execution.running())
    await life.goal(_elsewhere(life))
    await life.operator_plan_over()
    if await life.advised() is not None:
        await life.operator_plan_over()
    await life.leave_restart()
    await life.work(2)


async def reset_an_operation(life: Life) -> None:
    """What was done is taken back by a plan to the precondition of an operation, as it is offered in restart mode."""
    await life.start()
    await life.work(4)
    await life.enter_restart()
    await life.reset({BOLTS: "prepare_planning_scene", TRUCK: "identify_engine"}[_station(life)])
    await life.operator_plan_over()
    await life.leave_restart()
    await life.work(2)


async def try_abilities(life: Life) -> None:
    """Two runs of one ability each alone; the first is called off on its way, if it is not over by then."""
    execution = life.controller.execution
    await life.start()
    await life.work(1)
    await life.mode(Mode.PAUSED)
    await life.until(lambda: not execution.running())
    for stopped in (True, False):
        moves = (name for name in execution.automaton.abilities if name.startswith("robot.move_to_position"))
        ability = next(name for name in moves if execution.startable(name) is not None)
        await life.controller.command(TryAbility(actor=EVA, ability=ability))
        await life.until(lambda: bool(execution.running()) or execution.operator_plan is None)
        if stopped and execution.operator_plan is not None:
            await life.controller.command(StopOperatorPlan(actor=EVA))
        await life.operator_plan_over()
        await life.until(lambda: not execution.running())
    await life.mode(Mode.AUTOMATIC)
    await life.work(3)


async def by_hand_for_the_robot(life: Life) -> None:
    """The operator switches the robot off and works in its place for a while."""
    await life.start()
    await life.work(3)
    life.devices.emulated.set_value("operator.takes_over", True)
    await asyncio.sleep(2.5)
    life.devices.emulated.set_value("operator.takes_over", False)
    await life.work(2)


def _elsewhere(life: Life) -> str:
    """That the robot is where it is not now."""
    home, far = {BOLTS: ("home", "above_engine"), TRUCK: ("HomeJOINTPose", "AboveEngineTCPPose")}[_station(life)]
    return f"robot.pose == {home if life.value('robot.pose') == far else far}"


def _station(life: Life) -> Path:
    return STATIONS / life.view.station.name


def _resources(life: Life) -> list[str]:
    return sorted({each.topic.resource for each in life.station.pipelines.incoming.values()})


_MASTER: Final = "another:\n  title: Another\n  operations:\n    {}:\n\n"
ORDERED: Final = frozenset({"by-order-changed", "job-taken", "jobs-sequenced", "job-commanded", "job-forgotten"})
CORRECTED: Final = frozenset({"corrected", "confirmed"})
ERRAND: Final = frozenset({"errand-taken", "errand-stopped", "mode-changed"})
CHANGED: Final = {
    BOLTS: ("operations.yaml", 'en: "Tighten {pair}"', 'en: "Tighten {pair} again"'),
    TRUCK: ("operations.yaml", "priority: 1", "priority: 2"),
}
TWO_MASTERS: Final = {  # so that two jobs can be under way at once
    BOLTS: ("work_masters.yaml", "truck_engine:\n", f"{_MASTER.format('prepare_planning_scene')}truck_engine:\n"),
    TRUCK: ("work_masters.yaml", "\nengine:\n", f"\n{_MASTER.format('take_nutrunner')}engine:\n"),
}
_OF_BOTH: Final[dict[str, tuple[tuple[Script, ...], frozenset[str]]]] = {
    "production": ((produce,), frozenset({"asked", "answered", "production-started", "snapshot"})),
    "pause-and-hold": ((pause_and_hold,), frozenset({"mode-changed"})),
    "faults": ((faults,), frozenset({"alarm"})),
    "moved-by-hand": ((moved_by_hand,), frozenset({"corrected"})),
    "corrections": ((correct,), CORRECTED),
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
        f"{station.name}-deployment": Scenario(station, (ends_at_work, goes_on), CORRECTED, CHANGED[station])
        for station in (BOLTS, TRUCK)
    },
    **{
        f"{station.name}-jobs": Scenario(station, (work_by_order,), ORDERED, TWO_MASTERS[station], 0)
        for station in (BOLTS, TRUCK)
    },
    "bolt_tightening-steps": Scenario(BOLTS, (step,), frozenset({"stepping-changed", "step-taken"})),
    "bolt_tightening-silent": Scenario(BOLTS, (nothing_heard,), frozenset({"alarm"})),
    "bolt_tightening-reset": Scenario(BOLTS, (reset_an_operation,), frozenset({"errand-taken"})),
    "bolt_tightening-trials": Scenario(BOLTS, (try_abilities,), frozenset({"errand-taken"})),
    "truck_engine_station-by-hand": Scenario(TRUCK, (by_hand_for_the_robot,)),
}
