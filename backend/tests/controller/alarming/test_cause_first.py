"""A fault is one alarm that begins with its cause: what follows is a part of it, and what waits for it is named."""

from __future__ import annotations

from controller.alarming.scene import Scene, Told
from controller.faulty import FaultyRig
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.views.execution import failing
from sequence_planner.controller.views.station import AlarmState, AlarmView, Priority, QuestionView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.simulation.faults import Clear, Fault, FaultKind
from sequence_planner.texts.message import as_it_was

ROBOT_IS_STILL = "still:robot"


class Watched(FaultyRig):
    """The station with its alarms, which are looked after as a controller does."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.told = Told()
        self.feeds = Inputs(self.station.pipelines, self.station.registry)
        self.scene = Scene(self.execution, self.station, self.told, feeds=self.feeds, tasks=self.desk)

    def tick(self) -> None:
        super().tick()
        for name, feed in self.feeds.expected.items():
            feed.last = self._heard.get(name)
        self.scene.note(self.ticks[-1])
        self.scene.current(Timestamp(self.now, self.now))

    @property
    def shown(self) -> dict[str, AlarmView]:
        return self.scene.current(Timestamp(self.now, self.now))


def stuck() -> Watched:
    """The robot goes down to a placed pair with the tool turning, and stops there."""
    rig = Watched()
    rig.start_production()
    down = "robot.move_to_position(bolt_pair_3)"
    assert rig.run(120, until=lambda: down in rig.started)
    assert rig.run(2, until=lambda: rig.value("robot.pose") == "unknown")
    rig.faulty.start(Fault(FaultKind.STUCK, "robot"), rig.now)
    return rig


def test_a_robot_that_is_stuck_is_one_alarm_of_the_robot() -> None:
    rig = stuck()
    rig.run(60)
    lasting = {key: alarm for key, alarm in rig.shown.items() if alarm.ended is None}
    assert lasting.keys() == {ROBOT_IS_STILL}
    alarm = lasting[ROBOT_IS_STILL]
    assert alarm.text == "Robot UR10 does not go on. It still reports: robot.moving and robot.pose == unknown"
    assert "“Tighten bolt pairs 1 to 3”" in alarm.consequence
    late = "The robot is not at bolt pair 3 yet. Robot UR10: “Move to bolt pair 3” has not finished within 30 s"
    assert late in alarm.parts
    assert alarm.priority is Priority.HIGH, "it led outside the safe states"
    assert any("outside its safe states" in part for part in alarm.parts)


def test_why_the_state_is_unsafe_is_told_as_soon_as_it_can_be_known() -> None:
    rig = stuck()
    rig.run(10)
    assert rig.shown.keys() == {ROBOT_IS_STILL}
    came = [key for key, event in rig.told.events if event == "came"]
    assert came[-1] == ROBOT_IS_STILL and len(came) <= 2, came


def test_the_watch_can_say_which_device_needs_help() -> None:
    rig = stuck()
    assert failing(rig.station.automaton, rig.shown, rig.execution.running()) == []
    rig.run(60)
    assert failing(rig.station.automaton, rig.shown, rig.execution.running()) == ["Robot UR10"]
    rig.faulty.clear(Clear())
    rig.run(15)
    assert failing(rig.station.automaton, rig.shown, rig.execution.running()) == []


def test_what_the_station_asks_about_because_of_it_is_a_part_of_it() -> None:
    rig = stuck()
    rig.run(30)
    because = ["bolts[bolt_pair_3] == placed never goes together with robot.target_pose == bolt_pair_3"]
    rig.scene.consistency.questions = [
        QuestionView(
            variable="bolts[bolt_pair_3]",
            believed="placed",
            so=as_it_was("pair 3 is placed"),
            possible=["empty"],
            because=because,
            because_messages=[],
        )
    ]
    rig.run(1)
    (alarm,) = rig.shown.values()
    assert "It is believed that bolts[bolt_pair_3] == placed" in " ".join(alarm.parts)


def test_what_outlasts_it_is_told_with_it_for_some_time() -> None:
    """The state is still unsafe, and there still is no plan: these do not follow from one another alone."""
    rig = stuck()
    rig.run(45)
    rig.execution.change_mode(Mode.HOLD, "Eva", Timestamp(rig.now, rig.now))  # so the tool stands on the bolts
    rig.run(2)
    rig.faulty.clear(Clear())
    rig.run(3)
    (alarm,) = rig.shown.values()
    assert alarm.text.startswith("Robot UR10 did not go on")
    assert alarm.text.endswith("That is over, but something that came of it lasts")
    assert any("outside its safe states" in part for part in alarm.parts)


def test_once_it_is_over_it_reads_so() -> None:
    rig = stuck()
    rig.run(45)
    rig.faulty.clear(Clear())
    rig.run(30)
    (alarm,) = (alarm for alarm in rig.shown.values() if alarm.state is AlarmState.RETURNED)
    assert alarm.text.startswith("Robot UR10 did not go on")
    assert any(part == "Robot UR10: “Move to bolt pair 3” did not finish within 30 s" for part in alarm.parts)
    assert not any(" has not " in part for part in alarm.parts)


def test_what_waited_for_a_device_that_works_again_is_no_alarm_of_its_own() -> None:
    """The nutrunner runs, and waits for a robot that is stuck between two pairs, at the one that is done."""
    rig = Watched()
    rig.start_production()
    up = "robot.move_to_position(above_engine)"

    def is_on_its_way() -> bool:
        runs = rig.value("nutrunner.tool_is_running_forward") is True
        return runs and rig.started[-1] == up and "tightened" in rig.execution.state.values()

    assert rig.run(240, until=is_on_its_way)
    rig.faulty.start(Fault(FaultKind.STUCK, "robot"), rig.now)
    rig.run(45)
    (while_it_lasts,) = rig.shown.values()
    late = "No torque with the robot at bolt pair 3. Nutrunner: “Run the nutrunner” has not finished within 30 s"
    assert late in while_it_lasts.parts
    rig.faulty.clear(Clear())
    for _ in range(30):
        rig.run(1)
        assert len(rig.shown) == 1, [alarm.text for alarm in rig.shown.values()]
    (alarm,) = rig.shown.values()
    assert alarm.state is AlarmState.RETURNED
