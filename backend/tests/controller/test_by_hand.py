"""What nothing commanded is noted: never in normal runs, and always where somebody moved a device by hand."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import pytest
from pydantic import JsonValue

from controller.mixing import mixer
from sequence_planner.automaton.automaton import State, target
from sequence_planner.automaton.reactions import Reactions
from sequence_planner.automaton.tick import apply_effects, initial_state
from sequence_planner.controller.recovery.manual import KIND, LATENCY, LONGEST, STAYS, ByHand, WentOn, on_its_way
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.language.types import Value
from support.places import BOLT_TIGHTENING, MODELS
from support.simulated import Rig

STATIONS = sorted(each.name for each in MODELS.iterdir() if (each / "station.yaml").exists())


@dataclass
class Watched(Rig):
    """A rig that notes what nothing commanded."""

    told: list[Mapping[str, JsonValue]] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__post_init__()
        self.by_hand = ByHand(self.execution, self.station.pipelines, self._tell)

    def _tell(self, kind: str, content: Mapping[str, JsonValue]) -> None:
        assert kind == KIND
        self.told.append(content)

    @property
    def changed(self) -> dict[str, JsonValue]:
        """What was noted, by variable."""
        found: dict[str, JsonValue] = {}
        for content in self.told:
            changed = content.get("changed", {})
            assert isinstance(changed, dict)
            found |= changed
        return found

    def put(self, variable: str, value: Value) -> None:
        self.devices.set_value(variable, value)
        self.tick()


def working(station: str, seed: int = 0, step: float = 0.1) -> Watched:
    rig = Watched(folder=MODELS / station, seed=seed, step=step)
    rig.run(1)
    rig.start_production()
    return rig


@pytest.mark.parametrize("station", STATIONS)
@pytest.mark.parametrize("step", [0.1, 0.3])
def test_no_normal_run_has_anything_of_it(station: str, step: float) -> None:
    rig = working(station, round(step * 100), step)
    rig.run(60)
    assert rig.started, "it works"
    assert rig.told == []


@pytest.mark.parametrize("station", STATIONS)
@pytest.mark.parametrize("seed", range(1, 5))
def test_whoever_moves_a_device_by_hand_is_noticed(station: str, seed: int) -> None:
    draw = random.Random(seed)
    rig = working(station, seed, 0.3)
    rig.run(draw.uniform(3, 40))
    recent: list[State] = []
    for _ in range(round((LATENCY + 0.5) / rig.step)):
        rig.run(rig.step)
        recent.append(rig.execution.state)
    moves = list(_impossible(rig, recent))
    assert moves, "there is much that a device does not do by itself"
    name, value = draw.choice(moves)
    before = rig.execution.state[name]
    rig.put(name, value)
    assert rig.execution.state[name] == value
    assert rig.changed[name] == [before, value]


def _impossible(rig: Watched, recent: list[State]) -> Iterator[tuple[str, Value]]:
    """What effects cannot have brought about, however many of them in whatever order, by the reference tick."""
    automaton, state = rig.station.automaton, rig.execution.state
    reached: dict[tuple[Value | None, ...], State] = {}
    to_see = list(recent)
    while to_see and len(reached) < 20_000:
        each = to_see.pop()
        key = tuple(each[name] for name in automaton.variables)
        if key not in reached:
            reached[key] = each
            to_see += [after for effect in automaton.effects if (after := apply_effects(each, [effect])) is not None]
    assert not to_see
    between = {w.variable: w.between for node in rig.station.pipelines.nodes for w in node.writings}
    written = {target(action) for effect in automaton.effects for action in effect.actions}
    for name in sorted(written & rig.devices.topics.keys()):
        possible = {each[name] for each in reached.values()} | {between.get(name)}
        for value in automaton.variables[name].type.domain:
            if state[name] is not None and value not in possible and _can_be_said(rig, name, value):
                yield name, value


def _can_be_said(rig: Watched, name: str, value: Value) -> bool:
    """Whether a device that has this value is heard to have it, which takes more than one where one field says two."""
    topics = rig.station.pipelines.topics_of(rig.station.pipelines.feeds[name])
    return len(topics) == 1 and name not in ("robot.previous_pose",)


def test_a_goal_that_a_server_has_taken_up_is_on_its_way_and_nobody_has_moved_anything() -> None:
    """It is accepted before it is executed. Mostly nobody sees that; on a busy machine it is heard on its own."""
    station, _ = mixer()
    reactions = Reactions(station.automaton, on_its_way(station.pipelines))
    before = {**initial_state(station.automaton), "tank.stirring": "idle"}
    wanted = {**before, "tank.stir": True}
    for status in ("accepted", "executing"):
        assert reactions.explain([wanted], "tank.stirring", status)
        assert not reactions.explain([before], "tank.stirring", status), "nobody wants anything"
    assert not reactions.explain([wanted], "tank.stirring", "lost")


def test_how_the_station_went_on_is_told_and_the_notice_goes() -> None:
    rig = working("bolt_tightening")
    down = "robot.move_to_position(bolt_pair_3)"
    assert rig.run(60, until=lambda: down in rig.started and rig.value("robot.pose") == "bolt_pair_3")
    rig.run(0.3)
    rig.put("robot.pose", "home")
    assert rig.changed["robot.pose"] == ["bolt_pair_3", "home"]
    (notice,) = rig.by_hand.notices(rig.now)
    assert (notice.resource, notice.how, notice.by) == ("robot", WentOn.EXECUTES, down), "it goes back by itself"
    assert rig.told[-1]["by_ability"] == down
    assert len(rig.told) == 1
    assert rig.by_hand.notices(rig.now + STAYS - 1)
    assert not rig.by_hand.notices(rig.now + STAYS + 1)


def test_what_was_under_way_goes_on_and_is_not_finished_by_a_hand() -> None:
    rig = working("bolt_tightening")
    down = "robot.move_to_position(bolt_pair_3)"
    assert rig.run(60, until=lambda: down in rig.started and rig.value("robot.pose") == "unknown")
    rig.put("robot.pose", "home")
    (notice,) = rig.by_hand.notices(rig.now)
    assert (notice.how, notice.by) == (WentOn.EXECUTES, down)
    assert rig.run(30, until=lambda: rig.value("robot.pose") == "bolt_pair_3")
    assert len(rig.told) == 1


def test_a_notice_does_not_stay_for_ever() -> None:
    rig = working("bolt_tightening")
    assert rig.run(60, until=lambda: rig.value("robot.pose") == "above_engine")
    rig.execution.change_mode(Mode.PAUSED, "Eva", Timestamp(rig.now, rig.now))
    rig.run(5)
    rig.put("robot.tool_is_attached", False)
    assert rig.changed == {"robot.tool_is_attached": [True, False]}
    rig.run(2)  # attached again: as it was commanded, so that is none of it
    assert len(rig.told) == 1
    assert rig.told[0]["how"] == WentOn.EXECUTES
    assert not rig.by_hand.notices(rig.now + LONGEST + 100)


def test_what_a_person_forces_and_what_was_not_heard_is_none_of_it() -> None:
    rig = working("bolt_tightening")
    rig.run(2)
    rig.execution.force("robot.pose", "bolt_pair_1", Timestamp(rig.now + 5, rig.now + 5), "Eva", "its camera is dirty")
    rig.run(8)
    rig.silent = set(rig.station.pipelines.incoming)
    rig.run(1)
    rig.devices.set_value("nutrunner.programmed_torque_reached", True)
    rig.silent = set()
    rig.run(3)
    assert rig.told == []


def test_before_production_people_may_move_what_they_like() -> None:
    rig = Watched(folder=BOLT_TIGHTENING)
    rig.run(1)
    rig.put("robot.pose", "bolt_pair_1")
    assert rig.told == []
