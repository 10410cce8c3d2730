"""Alarms: each as long as its cause, and none that a person cannot see in time."""

from __future__ import annotations

import asyncio

from control.rig import Rig, never
from sequence_planner.control.alarms import Alarms
from sequence_planner.control.commander import Commander
from sequence_planner.control.execution import TickOutcome
from sequence_planner.control.feeds import Feeds
from sequence_planner.control.moment import Moment
from sequence_planner.control.network_watch import NetworkWatch
from sequence_planner.control.outside import Outside
from sequence_planner.ros.memory import MemoryNetwork

PLACE = "operator.place_bolt_pair(bolt_pair_1)"


def alarms(rig: Rig) -> Alarms:
    station = rig.station

    async def join() -> Commander:
        transport = MemoryNetwork().join(station.registry, "sequence_planner", asyncio.get_running_loop())
        return Commander(station.pipelines.outgoing, station.registry, transport)

    feeds = Feeds(station.pipelines, station.registry)
    network = NetworkWatch(station.pipelines, station.registry)
    return Alarms(rig.execution, Outside(rig.execution), feeds, network, asyncio.run(join()))


def outcome(
    finished: tuple[str, ...] = (), started: tuple[str, ...] = (), conflicts: tuple[tuple[str, str, str], ...] = ()
) -> TickOutcome:
    nothing: frozenset[str] = frozenset()
    return TickOutcome(finished, (), started, nothing, nothing, conflicts, nothing, changed=True)


def test_a_conflict_is_shown_until_one_of_the_two_goes_on() -> None:
    """It lasts one tick, and a tick is shorter than a look; what it left undone lasts."""
    shown = alarms(Rig())
    shown.note(outcome(conflicts=(("a", "b", "x"), ("a", "c", "x"))))
    shown.note(outcome())
    now = Moment(1000, 10)
    assert {"conflict:a:b:x", "conflict:a:c:x"} <= shown.current(None, now).keys()
    shown.note(outcome(started=("b",)))
    assert "conflict:a:b:x" not in shown.current(None, now)
    assert "conflict:a:c:x" in shown.current(None, now)
    shown.note(outcome(finished=("a",)))
    assert "conflict:a:c:x" not in shown.current(None, now)


def test_a_clock_that_is_set_makes_nothing_overdue() -> None:
    rig = Rig(acknowledges=never)
    rig.start_production()
    shown = alarms(rig)
    assert rig.run(10, until=lambda: rig.value("robot.attach_tool") is True)
    attach = "overdue:robot.attach_in_planning_scene"
    assert attach not in shown.current(None, Moment(rig.now + 86400, rig.now + 1))
    assert attach in shown.current(None, Moment(rig.now - 86400, rig.now + 11))


def test_an_alarm_keeps_the_time_at_which_it_came() -> None:
    shown = alarms(Rig())
    first = shown.current("the planner has ended", Moment(1000, 10))
    later = shown.current("the planner has ended", Moment(1060, 70))
    assert first["planner"].since == later["planner"].since == 1000
    assert "planner" not in shown.current(None, Moment(1070, 80))
    assert shown.current("the planner has ended", Moment(1080, 90))["planner"].since == 1080


def test_an_ability_that_does_not_begin_in_time_is_noticed() -> None:
    rig = Rig()
    rig.start_production()
    shown = alarms(rig)
    assert rig.run(60, until=lambda: "nutrunner.run_nut" in rig.started)
    shown.note(rig.ticks[-1])
    unseen = "no-reaction:nutrunner.run_nut"
    assert unseen not in shown.current(None, Moment(rig.now + 4, rig.now + 4))
    late = Moment(rig.now + 6, rig.now + 6)
    assert shown.current(None, late)[unseen].text == "Run the nutrunner has not begun within 5 s"

    assert rig.run(5, until=lambda: rig.value("nutrunner.run_nut.executing") is True)
    shown.note(rig.ticks[-1])
    assert unseen not in shown.current(None, late)
    overdue = shown.current(None, Moment(rig.now + 40, rig.now + 40))
    assert {"overdue:nutrunner.run_nut"} == {key for key in overdue if key.endswith("run_nut")}  # one cause, one alarm


def test_a_specification_that_is_broken_for_certain_is_an_alarm_whatever_else_is_unknown() -> None:
    rig = Rig()
    shown = alarms(rig)
    assert rig.execution.blind
    now = Moment(1000, 10)
    assert "unsafe-state" not in shown.current(None, now)  # for all that is known it may be safe
    rig.execution.state = {
        **rig.execution.state,
        "bolts[bolt_pair_1]": "placed",
        "robot.target_pose": "bolt_pair_1",
        "nutrunner.run_nut.executing": False,
    }
    assert "The tool must turn before it meets placed bolts" in shown.current(None, now)["unsafe-state"].text
