"""The reference tick, step by step, by example."""

from __future__ import annotations

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import (
    apply_effects,
    effect_writes,
    finish,
    initial_state,
    record_activity,
    reverts,
    sense,
    start,
    start_guard_holds,
    supervised_start,
    synchronise,
    update_operations,
    writes,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton

OFF = (BOOLEAN, False)
BOLTS = EnumerationType(("empty", "placed", "tightened"))


def tool() -> Automaton:
    """A tool that runs until it reports its torque, which ends `executing` in the same message."""
    return automaton(
        {
            "run": Does(
                start=("go := true",),
                enabled="not go and not running",
                executing="running and not torque",
                finished="torque",
                finish="executing and torque",
                finally_=("go := false", "bolts := tightened"),
            )
        },
        measured={"running": OFF, "torque": OFF},
        output={"go": OFF},
        estimated={"bolts": (BOLTS, "placed")},
        goals={"tighten": "bolts == tightened"},
    )


def test_flags_equal_their_predicates_in_the_initial_state() -> None:
    state = initial_state(tool())
    assert (state["run.enabled"], state["run.executing"], state["run.finished"]) == (True, False, False)


def test_a_finish_sees_executing_of_the_last_tick_and_the_measurement_of_this_one() -> None:
    station = tool()
    running = synchronise(station, {**initial_state(station), "go": True, "running": True})
    assert running["run.executing"] is True

    finishing = finish(station, sense(running, {"torque": True}))
    settled = synchronise(station, finishing.state)

    assert finishing.finished == ("run",)
    assert (settled["bolts"], settled["go"], settled["run.executing"]) == ("tightened", False, False)


def test_a_device_faster_than_its_messages_is_never_seen_executing() -> None:
    station = tool()
    started = synchronise(station, {**initial_state(station), "go": True})
    finishing = finish(station, sense(started, {"running": True, "torque": True}))
    assert finishing.finished == ()
    assert synchronise(station, finishing.state)["run.finished"] is True


def test_finishes_happen_at_once_on_the_state_before_them() -> None:
    station = automaton(
        {
            "one": Does(start=(), finish="done", finally_=("a := b",)),
            "other": Does(start=(), finish="done", finally_=("b := a",)),
        },
        measured={"done": OFF},
        estimated={"a": OFF, "b": (BOOLEAN, True)},
    )
    after = finish(station, sense(initial_state(station), {"done": True})).state
    assert (after["a"], after["b"]) == (True, False)


def test_of_two_conflicting_finishes_neither_is_applied_and_both_are_reported() -> None:
    station = automaton(
        {
            "one": Does(start=(), finish="done", finally_=("bolts := placed", "a := true")),
            "other": Does(start=(), finish="done", finally_=("bolts := tightened",)),
            "third": Does(start=(), finish="done", finally_=("b := true",)),
        },
        measured={"done": OFF},
        estimated={"bolts": (BOLTS, "empty"), "a": OFF, "b": OFF},
    )
    finishing = finish(station, sense(initial_state(station), {"done": True}))
    assert finishing.finished == ("third",)
    assert (finishing.state["bolts"], finishing.state["a"], finishing.state["b"]) == ("empty", False, True)
    assert finishing.conflicts == (("one", "other", "bolts"),)


def test_finishes_that_write_the_same_value_do_not_conflict() -> None:
    station = automaton(
        {name: Does(start=(), finish="done", finally_=("bolts := placed",)) for name in ("one", "other")},
        measured={"done": OFF},
        estimated={"bolts": (BOLTS, "empty")},
    )
    finishing = finish(station, sense(initial_state(station), {"done": True}))
    assert (finishing.finished, finishing.conflicts) == (("one", "other"), ())
    assert finishing.state["bolts"] == "placed"


def test_an_undetermined_flag_keeps_its_value() -> None:
    station = tool()
    running = synchronise(station, {**initial_state(station), "running": True})
    silent = synchronise(station, sense(running, {"running": None, "torque": None}))
    assert (silent["run.executing"], silent["run.finished"]) == (True, False)
    # What is still decided is decided: the tool has been told to go.
    assert synchronise(station, {**silent, "go": True})["run.enabled"] is False


def test_a_flag_never_determined_has_no_value() -> None:
    station = tool()
    state = synchronise(station, sense(station.initial_valuation, {"running": None, "torque": None}))
    assert state["run.executing"] is None
    assert not start_guard_holds(station.abilities["run"], state)


def test_what_is_undetermined_neither_starts_nor_finishes_nor_activates() -> None:
    station = tool()
    running = synchronise(station, {**initial_state(station), "go": True, "running": True})
    unknown = sense(running, {"torque": None})
    assert finish(station, unknown).finished == ()
    idle = synchronise(station, sense(initial_state(station), {"running": None}))
    assert idle["run.enabled"] is True  # kept from the tick before, and yet
    assert not start_guard_holds(station.abilities["run"], idle)


def test_flags_that_read_flags_are_synchronised_in_their_order() -> None:
    station = automaton(
        {
            "watch": Does(start=(), enabled="not move.executing"),
            "move": Does(start=("target := true",), executing="target and not there"),
        },
        measured={"there": OFF},
        output={"target": OFF},
    )
    state = initial_state(station)
    assert state["watch.enabled"] is True
    moving = start(station, state, station.abilities["move"])
    assert moving is not None
    assert (moving["move.executing"], moving["watch.enabled"]) == (True, False)


def test_effects_of_one_tick_read_the_state_before_and_none_enables_another() -> None:
    station = automaton(
        {},
        measured={"first": OFF, "second": OFF},
        effects={
            "a": ("true", ("first := true",)),
            "b": ("first", ("second := true",)),
            "swap": ("true", ("first := second",)),
        },
    )
    state = initial_state(station)
    a, b, swap = station.effects
    assert apply_effects(state, []) == state
    assert apply_effects(state, [a, b]) is None
    assert apply_effects(state, [a, swap]) is None  # true and false to one variable
    after = apply_effects(state, [a])
    assert after is not None
    assert apply_effects(after, [a, b]) == {**state, "first": True, "second": True}


def test_an_effect_keeps_an_unknown_variable_unknown() -> None:
    station = automaton({}, measured={"x": OFF, "y": OFF}, effects={"e": ("true", ("x := true", "y := true"))})
    state = synchronise(station, sense(station.initial_valuation, {"x": None}))
    assert effect_writes(station.effects[0], state) == {"y": True}
    assert apply_effects(state, station.effects) == {**state, "y": True}


def test_an_action_with_an_undetermined_condition_or_value_is_not_taken() -> None:
    station = automaton(
        {
            "choose": Does(start=("a := true", "b := true if x")),
            "copy": Does(start=("a := x",)),
        },
        measured={"x": OFF},
        output={"a": OFF, "b": OFF},
    )
    unknown = synchronise(station, sense(station.initial_valuation, {"x": None}))
    choose, copy = station.abilities.values()
    assert writes(choose.start_actions, unknown) is None
    assert start(station, unknown, choose) is None
    assert start(station, unknown, copy) is None
    assert writes(choose.start_actions, {**unknown, "x": False}) == {"a": True}


def robot() -> tuple[Automaton, Supervisor]:
    poses = EnumerationType(("home", "above"))
    station = automaton(
        {f"go_{pose}": Does(start=(f"target := {pose}",), enabled=f"target != {pose}") for pose in poses.values},
        measured={"pose": (poses, "home")},
        output={"target": (poses, "home"), "count": (IntegerRange(0, 2), 0)},
    )
    return station, synthesise(station)


def started(station: Automaton, supervisor: Supervisor, published: State, state: State, name: str) -> State | None:
    return supervised_start(station, supervisor, published, state, station.abilities[name])


def test_a_start_that_would_revert_an_unpublished_output_waits_for_the_next_tick() -> None:
    station, supervisor = robot()
    published = initial_state(station)
    above = started(station, supervisor, published, published, "go_above")
    assert above is not None
    home = start(station, above, station.abilities["go_home"])
    assert home is not None
    assert reverts(station, published, above, home) == {"target"}

    assert started(station, supervisor, published, above, "go_home") is None
    assert started(station, supervisor, above, above, "go_home") is not None  # once it is published


def test_an_output_may_change_twice_before_it_is_published_as_long_as_it_does_not_come_back() -> None:
    station, _ = robot()
    published = initial_state(station)
    assert reverts(station, published, {**published, "count": 1}, {**published, "count": 2}) == frozenset()
    assert reverts(station, published, {**published, "count": 1}, {**published, "count": 0}) == {"count"}


def test_operations_activate_on_their_precondition_and_complete_on_their_goal() -> None:
    station = tool()
    state = initial_state(station)
    active = update_operations(station, state, frozenset())
    assert active == {"tighten"}
    assert update_operations(station, state, active) == active
    tightened = {**state, "bolts": "tightened"}
    assert update_operations(station, tightened, active) == frozenset()
    assert update_operations(station, tightened, frozenset()) == frozenset()  # a goal that holds is not activated


def test_an_operation_whose_goal_is_undetermined_stays_as_it_is() -> None:
    station = automaton({}, measured={"x": OFF}, goals={"reach": "x"})
    unknown = synchronise(station, sense(station.initial_valuation, {"x": None}))
    assert update_operations(station, unknown, frozenset()) == frozenset()
    assert update_operations(station, unknown, frozenset({"reach"})) == {"reach"}


def test_flags_follow_what_is_active_before_a_finish_can_see_them_apart() -> None:
    """Else the finish would see an operation that has ended and a flag that says it has not."""
    active = "operation.light.active"
    station = automaton(
        {"shine": Does(start=(), executing=active, finish=f"executing and not {active}", finally_=("lamp := true",))},
        measured={"lit": OFF},
        output={"lamp": OFF},
        estimated={active: OFF},
        goals={"light": "lit"},
    )
    begun = record_activity(station, initial_state(station), frozenset({"light"}))
    assert begun["shine.executing"] is True
    ended = record_activity(station, begun, frozenset())
    assert ended["shine.executing"] is False
    assert finish(station, ended).finished == ()
