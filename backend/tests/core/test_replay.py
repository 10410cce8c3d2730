"""Plans held against the reference tick: which still reach their goals, and when a start must wait for that."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import (
    apply_effects,
    finish,
    initial_state,
    start,
    supervised_start,
    synchronise,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType
from sequence_planner.planning.goals.pursuit import moved, settled
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Plan, PlanRequest, PlanTick, goals_of
from sequence_planner.planning.validation.replay import Replay
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton
from support.examples import examples

from .breadth_first import shortest
from .choices import Choices, made_by
from .random_problems import Problem, problem

PLACES = EnumerationType(("home", "away", "out"))


def armed_robot(interlock: str = "at == home and target == home") -> Automaton:
    """A robot with an arm. No guard says that the arm must be in before the robot moves; the arm's own interlock does:
    it retracts only while the robot stands at home and has not been told to go.
    """
    return automaton(
        {
            "retract": Does(start=("extend := false",), enabled="extend", executing="not extend and extended"),
            "move": Does(start=("target := out",), enabled="target == home", executing="target == out and at != out"),
        },
        measured={"extended": (BOOLEAN, True), "at": (PLACES, "home")},
        output={"extend": (BOOLEAN, True), "target": (PLACES, "home")},
        effects={
            "arm_retracts": (f"not extend and extended and {interlock}", ("extended := false",)),
            "robot_leaves": ("target == out and at == home", ("at := away",)),
            "robot_arrives": ("target == out and at == away", ("at := out",)),
        },
        goals={"reach": "at == out and not extended"},
    )


class Followed:
    """A station that follows a plan tick by tick while the environment does what it is told."""

    def __init__(self, station: Automaton, supervisor: Supervisor, plan: Plan, state: State | None = None) -> None:
        self.station, self.supervisor = station, supervisor
        self.replay = Replay(station, supervisor)
        self.state = self.published = initial_state(station) if state is None else state
        self.plan, self.ahead = plan, [name for _, name in plan.starts]
        self.goals = self.missing = goals_of(station, station.operations)

    def rest(self, order: list[str]) -> tuple[PlanTick, ...]:
        """The ticks of the plan behind the one of the last start taken."""
        done = len(self.plan.starts) - len(order)
        return self.plan.ticks[self.plan.starts[done - 1][0] if done else 0 :]

    @property
    def reachable(self) -> bool:
        return self.replay.still_reaches(self.state, self.published, self.missing, self.ahead, self.rest(self.ahead))

    def may_start(self, name: str) -> State | None:
        """The state after the start, if its guards hold and the rest of the order still reaches the goals after it."""
        ability = self.station.abilities[name]
        after = supervised_start(self.station, self.supervisor, self.published, self.state, ability)
        if after is None:
            return None
        order = self.ahead[1:]
        goes_on = self.replay.may_go_on(self.state, after, self.published, self.missing, order, self.rest(order))
        return after if goes_on else None

    def tick(self, *effects: str) -> list[str]:
        """One tick with these effects; the starts taken in it."""
        before = self.state
        sensed = apply_effects(before, [effect for effect in self.station.effects if effect.name in effects])
        assert sensed is not None
        self.state = synchronise(self.station, finish(self.station, sensed).state)
        missing = settled(self.missing, self.state)
        assert missing is not None
        self.missing, self.published = missing, before
        started = []
        while self.ahead and (after := self.may_start(self.ahead[0])) is not None:
            going_on = moved(self.missing, after)
            assert going_on is not None
            self.state, self.missing = after, going_on
            started.append(self.ahead.pop(0))
        return started

    def can_happen(self, effect: str) -> bool:
        """Whether an effect is enabled now."""
        return any(e.name == effect and apply_effects(self.state, [e]) is not None for e in self.station.effects)


@pytest.fixture
def arm() -> Followed:
    station = armed_robot()
    supervisor = synthesise(station)
    answer = Planner(station, supervisor).answer(
        PlanRequest(initial_state(station), goals_of(station, station.operations))
    )
    assert answer.plan is not None
    return Followed(station, supervisor, answer.plan)


def test_retract_wait_for_the_arm_move(arm: Followed) -> None:
    """`move` could start at once for all its guards say, and the arm would never come in."""
    assert [name for _, name in arm.plan.starts] == ["retract", "move"]
    assert arm.tick() == ["retract"]
    moved = supervised_start(arm.station, arm.supervisor, arm.published, arm.state, arm.station.abilities["move"])
    assert moved is not None, "no guard keeps the robot from moving"
    assert not arm.replay.still_reaches(moved, arm.published, arm.goals, (), arm.rest([]))

    assert arm.tick() == []  # the arm takes its time
    assert arm.tick() == []
    assert arm.tick("arm_retracts") == ["move"]
    arm.tick("robot_leaves")
    arm.tick("robot_arrives")
    assert not arm.missing


def test_a_plan_whose_starts_were_all_taken_at_once_does_not_replay(arm: Followed) -> None:
    greedy = [PlanTick((), ("retract", "move")), *(PlanTick(tick.effects, ()) for tick in arm.plan.ticks[1:])]
    assert arm.replay.exactly(arm.state, arm.state, arm.goals, (), arm.plan.ticks)
    assert not arm.replay.exactly(arm.state, arm.state, arm.goals, (), greedy)


def test_a_plan_with_a_start_that_is_not_allowed_does_not_replay_even_if_its_goals_are_reached(arm: Followed) -> None:
    done = synchronise(arm.station, {**arm.state, "at": "out", "extended": False, "target": "out"})
    assert arm.replay.exactly(done, done, arm.goals, (), ())
    assert not arm.replay.exactly(done, done, arm.goals, ("move",), ())
    assert not arm.replay.exactly(done, done, arm.goals, (), [PlanTick((), ("move",))])
    assert not arm.replay.exactly(done, done, arm.goals, (), [PlanTick(("robot_leaves",), ())])


def test_with_nothing_to_wait_for_both_start_in_one_tick() -> None:
    station = armed_robot(interlock="true")
    supervisor = synthesise(station)
    answer = Planner(station, supervisor).answer(
        PlanRequest(initial_state(station), goals_of(station, station.operations))
    )
    assert answer.plan is not None
    assert sorted(Followed(station, supervisor, answer.plan).tick()) == ["move", "retract"]


def test_a_plan_is_broken_when_the_robot_has_left_with_its_arm_out(arm: Followed) -> None:
    assert arm.reachable
    arm.tick()
    moved = start(arm.station, arm.state, arm.station.abilities["move"])
    assert moved is not None
    arm.state = arm.published = {**moved, "at": "away"}
    assert not arm.reachable


def test_a_plan_is_broken_when_a_start_of_it_can_never_be_taken(arm: Followed) -> None:
    arm.state = arm.published = synchronise(arm.station, {**arm.state, "target": "away"})
    assert not arm.reachable


def test_a_plan_that_does_not_know_what_it_waits_for_is_broken(arm: Followed) -> None:
    arm.tick()
    arm.state = synchronise(arm.station, {**arm.state, "extended": None})
    assert not arm.reachable


def test_starts_left_over_once_the_goals_are_reached_break_nothing(arm: Followed) -> None:
    """Somebody has brought the robot out by hand."""
    done = synchronise(arm.station, {**arm.state, "at": "out", "extended": False, "target": "out"})
    assert arm.replay.still_reaches(done, done, arm.goals, ("retract", "move"), arm.plan.ticks)


def test_a_fault_is_not_counted_on() -> None:
    station = automaton(
        {"go": Does(start=("on := true",), enabled="not on")},
        measured={"done": (BOOLEAN, False)},
        output={"on": (BOOLEAN, False)},
        effects={"luck": ("on", ("done := true",))},
        faults=("luck",),
        goals={"reach": "done"},
    )
    replay, state = Replay(station, synthesise(station)), initial_state(station)
    assert not replay.eagerly(state, state, goals_of(station, station.operations), ("go",))


def passing_part(others: dict[str, tuple[str, tuple[str, ...]]]) -> Automaton:
    """A part that passes by when it is released, which takes one tick; the drill that is to meet it takes one too."""
    return automaton(
        {
            "release": Does(start=("gate := true",), enabled="not gate"),
            "drill": Does(start=("turn := true",), enabled="part == away and not turn"),
        },
        measured={"part": (PLACES, "home"), "turning": (BOOLEAN, False), "lamp": (BOOLEAN, False)},
        output={"gate": (BOOLEAN, False), "turn": (BOOLEAN, False)},
        effects={
            "passes": ("gate and part == home", ("part := away",)),
            "is_gone": ("part == away", ("part := out",)),
            "turns": ("turn and not turning", ("turning := true",)),
            **others,
        },
        goals={"reach": "part == away and turning"},
    )


@pytest.mark.parametrize(("others", "taken"), [({}, True), ({"lights": ("not lamp", ("lamp := true",))}, False)])
def test_a_start_that_needs_a_device_to_be_slow_is_taken_only_when_nothing_happens_by_itself(
    others: dict[str, tuple[str, tuple[str, ...]]], taken: bool
) -> None:
    station = passing_part(others)
    supervisor, state = synthesise(station), initial_state(station)
    answer = Planner(station, supervisor).answer(PlanRequest(state, goals_of(station, station.operations)))
    assert answer.plan is not None
    followed = Followed(station, supervisor, answer.plan)
    assert followed.ahead == ["release", "drill"]
    assert not followed.replay.eagerly(state, state, followed.goals, followed.ahead)
    assert followed.reachable
    assert (followed.may_start("release") is not None) is taken


@pytest.fixture(scope="module")
def tightening(worked_example: Automaton, supervisor: Supervisor) -> tuple[Plan, State]:
    """A plan for the worked example, and the state it begins in."""
    placed = synchronise(worked_example, {**initial_state(worked_example), "bolts": "placed"})
    answer = Planner(worked_example, supervisor).answer(
        PlanRequest(placed, goals_of(worked_example, ("tighten_bolt_pair",)))
    )
    assert answer.plan is not None
    return answer.plan, placed


@examples(100)
@given(helps=st.lists(st.lists(st.booleans(), min_size=7, max_size=7), max_size=25))
def test_the_worked_example_is_followed_to_its_goal_whether_devices_are_late_or_early(
    worked_example: Automaton, supervisor: Supervisor, tightening: tuple[Plan, State], helps: list[list[bool]]
) -> None:
    """In each tick some of the expected effects happen; in the end all of them do, one tick after the other."""
    plan, placed = tightening
    followed = Followed(worked_example, supervisor, plan, placed)
    assert len(worked_example.effects) == 7
    for help_ in [*helps, *[[True] * 7] * (2 * len(plan.ticks))]:
        now = [effect.name for effect, happens in zip(worked_example.effects, help_, strict=True) if happens]
        followed.tick(*(name for name in now if followed.can_happen(name)))
        if not followed.missing:
            break
        assert followed.reachable
        assert supervisor.safe.includes(followed.state)
    assert not followed.missing
    assert not followed.ahead


def an_order(choices: Choices) -> tuple[Problem, list[str]]:
    """A problem and any order of starts."""
    given_ = problem(choices)
    names = [ability.name for ability in given_.automaton.abilities.values() if not ability.restart]
    return given_, [choices.pick(names) for _ in range(choices.number(0, 3) if names else 0)]


@examples(150)
@given(made_by(an_order))
def test_what_an_order_reaches_eagerly_can_be_reached(given_: tuple[Problem, list[str]]) -> None:
    (station, supervisor, state), order = (given_[0].automaton, given_[0].supervisor, given_[0].state), given_[1]
    goals = goals_of(station, station.operations)
    if Replay(station, supervisor).eagerly(state, state, goals, order):
        best = shortest(station, supervisor, state, goals, longest=1000)
        assert best is not None
