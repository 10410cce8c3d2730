"""What the station says at once when something does not take part: who can still do what, and what nobody can."""

from __future__ import annotations

from controller.faulty import FaultyRig
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.recovery.who_can import WhoCan, at_once
from sequence_planner.controller.views.station import WhoCanView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import ServiceKind
from sequence_planner.simulation.faults import Fault, FaultKind
from sequence_planner.simulation.truck_station.poses import PAIRS
from stations.simulated import HallRig
from support.simulated import Rig, never

TIGHTEN = "tighten_bolt_pair"


def found(execution: Executor, now: float) -> WhoCanView:
    """What is said now; that something does not take part is known."""
    who_can = WhoCan(execution)
    who_can.look((), now)
    assert who_can.found is not None
    return who_can.found


def nobody(view: WhoCanView) -> dict[str, list[str]]:
    """What nobody can complete, and what it lacks."""
    return {each.operation: each.lacks for each in view.nobody}


def others(view: WhoCanView) -> dict[str, tuple[list[str], dict[str, object]]]:
    """What may still be completed, by whom, and what has to be so first."""
    return {each.operation: (each.by, dict(each.once)) for each in view.others}


class Heard(HallRig):
    """Whose robot is known to be silent when its node is away."""

    @property
    def offline(self) -> frozenset[str]:
        return frozenset() if self.execution.state["robot.pose"] is not None else frozenset({"robot"})


def out(rig: Rig, of: ServiceKind, name: str) -> None:
    """Somebody takes it out of service."""
    rig.execution.set_service(of, name, False, "Eva", "it rattles", Timestamp(rig.now, rig.now))


def bolted(seed: int = 3) -> Heard:
    """The truck station between its second bolt and its third."""
    rig = Heard(seed=seed)
    rig.improves = False
    rig.start_production()
    assert rig.live(300, until=lambda: f"{TIGHTEN}({PAIRS[1]})" in rig.completed)
    return rig


def test_nothing_is_said_while_all_take_part() -> None:
    rig = Rig()
    rig.start_production()
    rig.run(5)
    who_can = WhoCan(rig.execution)
    who_can.look((), rig.now)
    assert who_can.found is None
    assert who_can.lacking == {}


def test_without_its_robot_nobody_tightens_and_the_operator_still_places() -> None:
    rig = FaultyRig()
    rig.start_production()
    assert rig.run(120, until=lambda: "robot.move_to_position(bolt_pair_3)" in rig.started)
    rig.faulty.start(Fault(FaultKind.OFFLINE, "robot"), rig.now)
    assert rig.run(10, until=lambda: "robot" in rig.execution.conduct.silent)
    view = found(rig.execution, rig.now)
    assert [(each.name, each.why) for each in view.absent] == [("robot", "silent")]
    assert nobody(view)["tighten_bolt_pair(bolt_pair_3)"] == ["Robot UR10"]
    assert not [name for name in others(view) if name.startswith("tighten")]
    placing = [by for name, (by, once) in others(view).items() if name.startswith("place") and not once]
    assert all(by == ["Operator"] for by in placing)


def test_without_the_robot_of_the_truck_station_the_operator_can_take_over_the_bolts_and_nothing_else_of_it() -> None:
    rig = bolted()
    rig.hall.leave("ur10", 1000.0)
    rig.patience = 1.0  # what the robot cannot do takes the planner as long as it is given
    assert rig.live(20, until=lambda: "robot" in rig.execution.conduct.silent)
    view = found(rig.execution, rig.now)
    beyond, possible = nobody(view), others(view)
    assert set(beyond) >= {"take_filter_tool", "tighten_oil_filter", "release_engine"}
    assert {lacks for each in beyond.values() for lacks in each} == {rig.station.automaton.resources["robot"]}
    operator = rig.station.automaton.resources["operator"]
    for pair in PAIRS[2:]:
        by, once = possible[f"{TIGHTEN}({pair})"]
        assert operator in by
        assert once == {"operator.takes_over": True}
    rig.hall.world.person.takes_over = True
    rig.live(1)
    by, once = others(found(rig.execution, rig.now))[f"{TIGHTEN}({PAIRS[2]})"]
    assert operator in by
    assert once == {}


def test_what_it_says_comes_true_and_the_alarm_says_the_same() -> None:
    """Whatever is completed while the robot is away was not said to be beyond everybody, at any moment."""
    rig = bolted()
    out(rig, ServiceKind.RESOURCE, "robot")
    rig.hall.world.person.takes_over = True
    said: set[str] = set()
    who_can = WhoCan(rig.execution)
    rig.completed.clear()

    def look() -> bool:
        who_can.look((), rig.now)
        said.update(who_can.lacking)
        return "take_filter_tool" in rig.execution.active

    assert rig.live(300, until=look)
    assert len([name for name in rig.completed if name.startswith(TIGHTEN)]) == len(PAIRS) - 2
    assert said.isdisjoint(rig.completed)
    text = str(Consequences(rig.execution, who_can).without({"robot"}))
    assert "Nobody can do “Take the filter tool” without it." in text


def test_an_ability_that_was_given_up_is_named() -> None:
    rig = Rig(acknowledges=never)
    rig.start_production()
    rig.run(1)
    out(rig, ServiceKind.ABILITY, "nutrunner.run_nut")
    view = found(rig.execution, rig.now)
    assert [(each.of, each.name) for each in view.absent] == [("ability", "nutrunner.run_nut")]
    assert view.absent[0].why == "out of service"
    assert nobody(view)["tighten_bolt_pair(bolt_pair_1)"] == [view.absent[0].title]


def test_each_of_two_that_are_needed_is_named_and_one_of_no_use_is_not() -> None:
    rig = bolted()
    for name in ("robot", "scene", "agv"):
        out(rig, ServiceKind.RESOURCE, name)
    titles = rig.station.automaton.resources
    assert nobody(found(rig.execution, rig.now))["take_filter_tool"] == [titles["robot"], titles["scene"]]


def test_it_is_looked_at_seldom_but_at_once_when_something_else_is_absent_or_active() -> None:
    rig = Rig()
    rig.start_production()
    out(rig, ServiceKind.RESOURCE, "robot")
    asked: list[float] = []

    def clock() -> float:
        """Each look takes a tenth of a second."""
        asked.append(len(asked) * 0.1)
        return asked[-1]

    who_can, others = WhoCan(rig.execution, at_once, clock), 1
    active = rig.execution.active
    for _ in range(100):
        rig.run(0.1)
        others += rig.execution.active != active
        active = rig.execution.active
        who_can.look((), rig.now)
        assert who_can.found is not None
        told = {each.operation for each in who_can.found.nobody if each.active}
        told |= {each.operation for each in who_can.found.others if each.active}
        assert told == active
    assert len(asked) / 2 <= others + 5, "a twentieth of ten seconds is five looks"
    last = who_can.found
    out(rig, ServiceKind.RESOURCE, "nutrunner")
    who_can.look((), rig.now)
    assert who_can.found is not last, "something else is absent"
