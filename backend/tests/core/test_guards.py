"""The guards shown to people: they say what the supervisor does, in few words, and put back they make it needless."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import combinations
from typing import Any

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import And, Expression, variables
from sequence_planner.language.types import BOOLEAN
from sequence_planner.model.efa_document import read_plain
from sequence_planner.synthesis import guards as saying
from sequence_planner.synthesis.guards import Restrictions, SupervisorGuard, shown_guards
from sequence_planner.synthesis.supervisor import Supervision, relevant
from sequence_planner.synthesis.transition_relation import Plant
from support.automata import Does, automaton
from support.examples import examples

from .choices import Choices, made_by
from .explicit import Explicit
from .explicit_plain import ExplicitPlain
from .random_devices import device_station
from .random_plain import document
from .random_stations import automaton as random_automaton


def supervised(automaton: Automaton) -> Supervision:
    return Supervision(Plant(automaton, relevant(automaton)))


def shown(automaton: Automaton) -> Mapping[str, SupervisorGuard]:
    return shown_guards(supervised(automaton))


def texts(guards: Mapping[str, SupervisorGuard]) -> dict[str, str]:
    return {name: print_expression(guard.expression) for name, guard in guards.items() if guard.expression is not None}


def read(written: Mapping[str, Any]) -> Automaton:
    return plain_automaton(read_plain(json.dumps(written), "example.efa.json"))


def printed(automaton: Automaton, guard: SupervisorGuard) -> Expression:
    """The guard as a person would write it down again."""
    assert guard.expression is not None
    return automaton.read_condition(print_expression(guard.expression))


# The examples.


def test_the_worked_example_shows_its_two_guards(supervision: Supervision) -> None:
    guards = shown_guards(supervision)
    assert texts(guards) == {
        "robot.move(bolt_pair)": "not operator.task and (bolts != placed or nutrunner.run_nut.executing)",
        "operator.place_bolt": "robot.pose != bolt_pair and robot.target_pose != bolt_pair",
    }
    assert [guards[name].literals for name in texts(guards)] == [2, 3]
    for guard in guards.values():
        assert (guard.specifications, guard.rest) == (("no_standing_tool_on_placed_bolts",), False)


def philosophers(number: int) -> dict[str, Any]:
    """They take their two forks in either order, and release both."""
    forks, seats = [f"fork_{i}" for i in range(number)], [f"seat_{i}" for i in range(number)]
    transitions: list[dict[str, Any]] = []
    for i, seat in enumerate(seats):
        left, right = forks[i], forks[(i + 1) % number]
        for name, guard, writes in (
            ("left", f"{seat} == thinks and {left}", {seat: "left", left: False}),
            ("right", f"{seat} == thinks and {right}", {seat: "right", right: False}),
            ("then_left", f"{seat} == right and {left}", {seat: "eats", left: False}),
            ("then_right", f"{seat} == left and {right}", {seat: "eats", right: False}),
            ("release", f"{seat} == eats", {seat: "thinks", left: True, right: True}),
        ):
            transitions.append({"event": f"{name}_{i}", "controllable": True, "guard": guard, "set": writes})
    return {
        "name": "philosophers",
        "variables": {seat: ["thinks", "left", "right", "eats"] for seat in seats} | dict.fromkeys(forks, "bool"),
        "initial": " and ".join([*forks, *(f"{seat} == thinks" for seat in seats)]),
        "transitions": transitions,
        "marked": " and ".join(forks),
    }


def test_no_philosopher_may_be_the_last_to_take_the_same_side() -> None:
    guards = shown(read(philosophers(5)))
    assert guards.keys() == {f"{side}_{i}" for side in ("left", "right") for i in range(5)}
    assert sum(guard.literals or 0 for guard in guards.values()) <= 40
    assert texts(guards)["left_4"] == "seat_0 != left or seat_1 != left or seat_2 != left or seat_3 != left"
    assert all(guard.rest and not guard.specifications for guard in guards.values())


def test_guards_over_many_variables_are_found_as_well() -> None:
    guards = shown(read(philosophers(16)))
    assert [guard.literals for guard in guards.values()] == [15] * 32


def crane(**parts: object) -> dict[str, Any]:
    """A crane between 0 and 4, which a gust of wind can push from 2 to 3; a wall stands there."""
    move = {"event": "forward", "controllable": True, "guard": "true", "set": {"x": "x + 1"}}
    gust = {"event": "gust", "controllable": False, "guard": "x == 2 and wind", "set": {"x": "3"}}
    return {
        "name": "crane",
        "variables": {"x": {"min": 0, "max": 4}, "wind": "bool", "wall": "bool"},
        "initial": "x == 0 and wall",
        "transitions": [move, gust],
        "forbidden": ["x >= 3 and wall"],
        **parts,
    }


def test_a_start_is_refused_for_what_follows_from_it_uncontrollably() -> None:
    (guard,) = shown(read(crane())).values()
    assert print_expression(printed(read(crane()), guard)) == "x <= 1 and (x == 0 or not wind)"


def test_transitions_of_one_event_share_a_guard_where_they_agree() -> None:
    steps = [
        {"event": "go", "controllable": True, "guard": guard, "set": {"x": x}}
        for guard, x in (("wind", 3), ("x == 0", 1))
    ]
    together = shown(read(crane(transitions=[steps[0], {**steps[1], "guard": "not wind"}])))
    assert texts(together) == {"go": "not wind"}
    assert together["go"].starts == ("go", "go#2")
    apart = shown(read(crane(transitions=steps)))
    assert texts(apart) == {"go#1": "false"}
    assert apart["go#1"].starts == ("go",)


def test_a_guard_for_the_sake_of_rest_names_the_specification_without_which_it_would_go() -> None:
    """There is a way in with a load, and no way out that would not drop it."""
    station = automaton(
        {
            "load": Does(start=("loaded := true",), when="not loaded"),
            "enter": Does(start=("inside := true",), when="not inside"),
            "leave": Does(start=("inside := false", "dropped := loaded"), when="inside"),
        },
        output={"loaded": (BOOLEAN, False), "inside": (BOOLEAN, False), "dropped": (BOOLEAN, False)},
        forbidden={"keep_the_load": "dropped"},
        rest="not inside",
    )
    guards = shown(station)
    assert texts(guards) == {"load": "not inside", "enter": "not loaded"}
    assert {name: (guard.specifications, guard.rest) for name, guard in guards.items()} == {
        "load": (("keep_the_load",), True),
        "enter": (("keep_the_load",), True),
    }


def test_a_guard_too_long_to_read_is_not_said() -> None:
    """The number of buttons pressed must stay even."""
    buttons = [f"button_{number}" for number in range(7)]
    presses = [
        {"event": f"press_{n}", "controllable": True, "guard": "not done", "set": {b: f"not {b}"}}
        for n, b in enumerate(buttons)
    ]
    done = {"event": "finish", "controllable": True, "guard": "not done", "set": {"done": True}}
    odd = "false"
    for button in buttons:
        odd = f"({odd}) != {button}" if odd != "false" else button
    guard = shown(
        read(
            {
                "name": "even",
                "variables": dict.fromkeys([*buttons, "done"], "bool"),
                "initial": " and ".join(f"not {each}" for each in [*buttons, "done"]),
                "transitions": [*presses, done],
                "forbidden": [f"done and ({odd})"],
            }
        )
    )["finish"]
    assert (guard.expression, guard.literals) == (None, None)
    assert guard.specifications == ("forbidden_1",)
    first = ["button_6", *(f"not button_{number}" for number in range(6))]
    assert len(guard.blocked) == 3
    assert sorted(print_expression(guard.blocked[0]).split(" and ")) == sorted(first)


def test_there_are_no_guards_without_a_supervisor() -> None:
    station = automaton(
        {"go": Does(start=("x := true",))}, output={"x": (BOOLEAN, False)}, forbidden={"never": "not x"}
    )
    with pytest.raises(ValueError, match="no supervisor"):
        shown(station)


# The laws.


def any_station(choices: Choices) -> Automaton:
    return device_station(choices) if choices.chance(2) else random_automaton(choices)


@examples(80)
@given(made_by(any_station))
def test_the_guards_of_a_station_say_what_the_definition_says(station: Automaton) -> None:
    """In every state that can be reached under the supervisor and in which the written guard holds."""
    supervision = supervised(station)
    if not supervision.possible:
        return
    explicit, guards = Explicit(station), shown_guards(supervision)
    expressions = {name: printed(station, guard) for name, guard in guards.items()}
    refused = set[str]()
    for key in explicit.reachable(supervised=True):
        for name, after in explicit.starts[key].items():
            if after not in explicit.safe:
                refused.add(name)
            said = name not in guards or holds(expressions[name], explicit.states[key])
            assert said == (after in explicit.safe)
    assert refused == guards.keys()


@examples(80)
@given(made_by(lambda choices: (any_station(choices), choices.pick((0, 300, 3_000, 10**6)), choices.number(0, 3))))
def test_guards_found_with_little_effort_say_the_same_or_what_is_blocked(given_: tuple[Automaton, int, int]) -> None:
    station, effort, literals = given_
    supervision = supervised(station)
    if not supervision.possible:
        return
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(saying, "MOST_LITERALS", literals)
        explicit, guards = Explicit(station), shown_guards(supervision, effort)
    assert guards.keys() == shown_guards(supervision).keys()
    said = {name: printed(station, guard) for name, guard in guards.items() if guard.expression is not None}
    for key in explicit.reachable(supervised=True):
        for name, after in explicit.starts[key].items():
            assert name not in said or holds(said[name], explicit.states[key]) == (after in explicit.safe)
            if name in guards and after in explicit.safe:
                assert not any(holds(each, explicit.states[key]) for each in guards[name].blocked)
    for name, guard in guards.items():
        assert guard.expression is None or not guard.blocked
        assert guard.expression is not None or guard.blocked or effort < 10**6
        held = [[key for key in explicit.states if holds(each, explicit.states[key])] for each in guard.blocked]
        assert all(any(explicit.starts[key].get(name) not in (None, *explicit.safe) for key in keys) for keys in held)


@examples(80)
@given(made_by(document))
def test_the_guards_of_a_plain_automaton_say_what_the_definition_says(written: dict[str, Any]) -> None:
    explicit = ExplicitPlain(written)
    if not explicit.initial or not explicit.initial <= explicit.safe:
        return
    plain = read(written)
    guards = shown(plain)
    expressions = {name: printed(plain, guard) for name, guard in guards.items()}
    guard_of = {start: name for name, guard in guards.items() for start in guard.starts}
    reached = explicit.distances(explicit.initial, supervised=True)
    names = transition_names(written["transitions"])
    for transition, name in zip(written["transitions"], names, strict=True):
        if transition["controllable"]:
            taken = {key: after for key, after in explicit.taken(transition).items() if key in reached}
            for key, after in taken.items():
                said = name not in guard_of or holds(expressions[guard_of[name]], explicit.valuation(key))
                assert said == (after in explicit.safe)


def transition_names(transitions: Iterable[Mapping[str, Any]]) -> list[str]:
    """The names that the transitions have in the automaton."""
    names: list[str] = []
    for transition in transitions:
        number = sum(event_of(name) == transition["event"] for name in names)
        names.append(transition["event"] if number == 0 else f"{transition['event']}#{number + 1}")
    return names


def with_guards(automaton: Automaton, guards: Mapping[str, SupervisorGuard]) -> Automaton:
    """The automaton with the guards written down in it."""
    abilities = dict(automaton.abilities)
    for guard in guards.values():
        for name in guard.starts:
            written = abilities[name].start_guard
            abilities[name] = replace(abilities[name], start_guard=And((written, printed(automaton, guard))))
    return replace(automaton, abilities=abilities)


def check_put_back(automaton: Automaton) -> None:
    """With the guards put back, the same states are reached, and the supervisor has nothing more to forbid."""
    names = tuple(automaton.variables)
    supervision = Supervision(Plant(automaton, names))
    if not supervision.possible:
        return
    whole = Restrictions(supervision, of_safe=True)  # as where too many states are reached
    check_needless(automaton, supervision, {name: whole.guard(name) for name in whole.starts})
    check_needless(automaton, supervision, shown_guards(supervision))


def check_needless(automaton: Automaton, supervision: Supervision, guards: Mapping[str, SupervisorGuard]) -> None:
    names = tuple(automaton.variables)
    guarded = Supervision(Plant(with_guards(automaton, guards), names))
    assert guarded.possible

    def members(of: Supervision, supervised: bool) -> set[tuple[object, ...]]:
        states = of.plant.diagrams.exported(of.reachable(supervised), names).members()
        return {tuple(state[name] for name in names) for state in states}

    expected = members(supervision, True)
    assert members(guarded, True) == expected
    assert members(guarded, False) == expected
    assert not shown_guards(guarded)


@examples(50)
@given(made_by(any_station))
def test_guards_put_back_into_a_station_make_the_supervisor_needless(station: Automaton) -> None:
    check_put_back(station)


@examples(50)
@given(made_by(document))
def test_guards_put_back_into_a_plain_automaton_make_the_supervisor_needless(written: dict[str, Any]) -> None:
    if ExplicitPlain(written).initial:
        check_put_back(read(written))


@examples(50)
@given(made_by(any_station))
def test_a_guard_reads_as_few_variables_as_possible_and_these_before_flags(station: Automaton) -> None:
    """Then those declared first."""
    supervision = supervised(station)
    if not supervision.possible:
        return
    explicit, guards = Explicit(station), shown_guards(supervision)
    plant = supervision.plant
    flags = [flag.name for flag in station.flags if plant.says((flag.predicate,))]
    candidates = [*(name for name in station.variables if name in plant.diagrams.bits), *flags]
    reached = explicit.reachable(supervised=True)
    for name, guard in guards.items():
        assert guard.expression is not None
        startable = [key for key in reached if name in explicit.starts[key]]
        on = [explicit.states[key] for key in startable if explicit.starts[key][name] in explicit.safe]
        off = [explicit.states[key] for key in startable if explicit.starts[key][name] not in explicit.safe]

        def tells(names: Iterable[str], on: list[State] = on, off: list[State] = off) -> bool:
            names = tuple(names)
            return {tuple(s[n] for n in names) for s in on}.isdisjoint(tuple(s[n] for n in names) for s in off)

        size = next(size for size in range(len(candidates)) if any(map(tells, combinations(candidates, size))))
        fewest = [chosen for chosen in combinations(candidates, size) if tells(chosen)]
        best = min(fewest, key=lambda chosen: (sum(n in flags for n in chosen), [n not in chosen for n in candidates]))
        assert set(variables(guard.expression)) == (set(best) if on else set())


@examples(40)
@given(made_by(any_station))
def test_reasons_are_the_specifications_that_nothing_could_keep_after_a_refused_start(station: Automaton) -> None:
    supervision = supervised(station)
    if not supervision.possible:
        return
    explicit, guards = Explicit(station), shown_guards(supervision)
    doomed = {s.name: unpreventable(explicit, s.forbidden) for s in station.specifications.values()}
    reached = explicit.reachable(supervised=True)
    for name, guard in guards.items():
        targets = [explicit.starts[key][name] for key in reached if name in explicit.starts[key]]
        refused = [key for key in targets if key not in explicit.safe]
        expected = {each for each, keys in doomed.items() if any(key in keys for key in refused)}
        assert guard.rest == any(not any(key in keys for keys in doomed.values()) for key in refused)
        if expected or not guard.rest:
            assert set(guard.specifications) == expected


def unpreventable(explicit: Explicit, forbidden: Expression) -> set[tuple[object, ...]]:
    """The states from which the environment alone can bring about what is forbidden."""
    found = {key for key, state in explicit.states.items() if evaluate(forbidden, state) is True}
    while more := {key for key, after in explicit.uncontrollable.items() if after & found} - found:
        found |= more
    return set(found)
