"""Ways back into the safe set are as short as a breadth-first search on the reference tick finds them."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass, replace

from hypothesis import assume, given

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import StateSet
from sequence_planner.automaton.tick import (
    apply_effects,
    finish,
    initial_state,
    reverts,
    start,
    start_guard_holds,
    synchronise,
)
from sequence_planner.language.evaluator import holds
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.planning.problem import PlanTick, RecoveryPath, WayBackAnswer, WayBackRequest
from sequence_planner.planning.recovery_path import WaysBack, deciding
from sequence_planner.synthesis.supervisor import SynthesisError, synthesise
from support.automata import Does, automaton
from support.examples import examples

from .breadth_first import Shortest
from .choices import Choices, made_by
from .explicit import outcomes
from .random_devices import device_station
from .random_stations import automaton as random_station
from .random_stations import state_of

LONGEST = 6
PLACES = EnumerationType(("home", "away", "out"))

Key = tuple[Value | None, ...]


@dataclass(frozen=True)
class Lost:
    """A station in a state outside its safe set; some abilities are for restart only."""

    station: Automaton
    safe: StateSet
    state: State


def lost(choices: Choices, unknown: bool = False) -> Lost | None:
    """None when of several stations none was found in such a state."""
    for _ in range(4):
        station = device_station(choices) if choices.chance(2) else random_station(choices)
        restarting = choices.different(list(station.abilities), 0, 1)
        abilities = {n: replace(a, restart=a.restart or n in restarting) for n, a in station.abilities.items()}
        station = replace(station, abilities=abilities)
        if not station.specifications and station.rest is None:
            continue
        with contextlib.suppress(SynthesisError):
            safe = synthesise(station).safe
            for _ in range(8):
                state = state_of(choices, station, unknown)
                if not safe.includes(state):
                    return Lost(station, safe, state)
    return None


def shortest_way(given_: Lost) -> Shortest | None:
    """The fewest ticks, then the fewest starts, of at most `LONGEST` ticks."""
    helpful = [effect for effect in given_.station.effects if not effect.fault]
    layer = {tuple(given_.state.values()): (given_.state, 0)}
    seen = set(layer)
    for ticks in range(1, LONGEST + 1):
        back: list[int] = []
        following: dict[Key, tuple[State, int]] = {}
        for before, so_far in layer.values():
            for settled in outcomes(given_.station, before, helpful):
                for end, count in moments(given_.station, before, settled):
                    key, total = tuple(end.values()), so_far + count
                    if given_.safe.includes(end):
                        back.append(total)
                    elif key not in seen and (key not in following or total < following[key][1]):
                        following[key] = (end, total)
        if back:
            return Shortest(ticks, min(back))
        seen |= following.keys()
        layer = following
    return None


def moments(station: Automaton, published: State, settled: State) -> Iterator[tuple[State, int]]:
    """The state after step 3, and every state that starts in the same tick lead to, with their number."""
    found = {(tuple(settled.values()), frozenset[str]())}
    pending = [(settled, frozenset[str]())]
    while pending:
        state, taken = pending.pop()
        yield state, len(taken)
        for name in station.abilities.keys() - taken:
            after = started(station, published, state, name)
            if after is not None and (key := (tuple(after.values()), taken | {name})) not in found:
                found.add(key)
                pending.append((after, taken | {name}))


def started(station: Automaton, published: State, state: State, name: str) -> State | None:
    """A start by the written guards alone, be it one for restart."""
    ability = station.abilities[name]
    after = start(station, state, ability) if start_guard_holds(ability, state) else None
    return None if after is None or reverts(station, published, state, after) else after


def replayed(station: Automaton, state: State, ticks: tuple[PlanTick, ...]) -> list[State]:
    """The states after step 3 and after each start; AssertionError where a tick cannot be taken."""
    visited: list[State] = []
    for tick in ticks:
        published = state
        sensed = apply_effects(state, [e for e in station.effects if e.name in tick.effects and not e.fault])
        assert sensed is not None
        state = synchronise(station, finish(station, sensed).state)
        visited.append(state)
        for name in tick.starts:
            after = started(station, published, state, name)
            assert after is not None
            state = after
            visited.append(state)
    return visited


def violated(station: Automaton, state: State) -> set[str]:
    return {s.name for s in station.specifications.values() if holds(s.forbidden, state)}


def check(given_: Lost, ways: WaysBack | None = None) -> None:
    """The way of `ways`, or of new ones, is the expected one."""
    station, state = given_.station, given_.state
    answer = (ways or WaysBack(station, given_.safe)).answer(WayBackRequest(state, deadline=60, longest=LONGEST))
    best = shortest_way(given_)
    if best is None:
        assert (answer.way, answer.searched) == (None, LONGEST)
        return
    way = answer.way
    assert way is not None
    assert Shortest(len(way.ticks), len(way.starts)) == best
    assert way.minimal_starts
    visited = replayed(station, state, way.ticks)
    assert [given_.safe.includes(each) for each in visited] == [False] * (len(visited) - 1) + [True]
    assert visited[-1] == way.end
    assert set(way.breaks) == set[str]().union(*(violated(station, s) for s in visited)) - violated(station, state)


@examples(80)
@given(made_by(lost))
def test_ways_back_are_as_short_as_breadth_first_search_finds_them(given_: Lost | None) -> None:
    assume(given_ is not None)
    assert given_ is not None
    check(given_)


@examples(50)
@given(made_by(lambda choices: lost(choices, unknown=True)))
def test_ways_back_from_states_with_unknown_values_are_too(given_: Lost | None) -> None:
    assume(given_ is not None)
    assert given_ is not None
    check(given_)


def several(choices: Choices) -> list[Lost]:
    """A station outside its safe set, and the same in further states outside."""
    first = lost(choices)
    if first is None:
        return []
    states = [state_of(choices, first.station, unknown=choices.chance(4)) for _ in range(4)]
    return [first, *(replace(first, state=state) for state in states if not first.safe.includes(state))]


@examples(20)
@given(made_by(several))
def test_question_after_question_is_answered_as_the_first(questions: list[Lost]) -> None:
    assume(questions)
    ways = WaysBack(questions[0].station, questions[0].safe)
    for each in questions:
        check(each, ways)


@examples(35)
@given(made_by(lost))
def test_what_threatens_is_what_can_be_violated_soonest_without_a_start(given_: Lost | None) -> None:
    assume(given_ is not None)
    assert given_ is not None
    station = given_.station
    answer = WaysBack(station, given_.safe).answer(WayBackRequest(given_.state, deadline=60, longest=LONGEST))
    soonest: list[set[str]] = []
    layer = {tuple(given_.state.values()): given_.state}
    if not violated(station, given_.state):
        for _ in range(LONGEST):
            layer = {tuple(a.values()): a for s in layer.values() for a in outcomes(station, s, station.effects)}
            soonest = [names for state in layer.values() if (names := violated(station, state))]
            if soonest:
                break
    assert set(answer.threatened) in (soonest or [set()])


def twins(choices: Choices) -> tuple[Lost, State] | None:
    """A state outside, and another that agrees with it on all that decides ways back."""
    first = lost(choices)
    if first is None:
        return None
    kept = deciding(first.station, first.safe)
    other = state_of(choices, first.station)
    return first, synchronise(first.station, {**other, **{name: first.state[name] for name in kept}})


@examples(35)
@given(made_by(twins))
def test_states_that_agree_on_what_decides_have_ways_back_of_the_same_length(given_: tuple[Lost, State] | None) -> None:
    assume(given_ is not None)
    assert given_ is not None
    first, other = given_
    ways = WaysBack(first.station, first.safe)
    one, another = (ways.answer(WayBackRequest(s, deadline=60, longest=LONGEST)) for s in (first.state, other))
    assert _length(one) == _length(another)
    assert bool(one.threatened) == bool(another.threatened)


def _length(answer: WayBackAnswer) -> Shortest | None:
    return None if answer.way is None else Shortest(len(answer.way.ticks), len(answer.way.starts))


def armed_robot() -> Automaton:
    """A robot that must not leave home while its arm is out, and an arm that only a restart ability retracts."""
    return automaton(
        {
            "go_out": Does(start=("target := out",), enabled="target == home and at == home"),
            "retract": Does(start=("extend := false",), enabled="extend", restart=True),
        },
        measured={"extended": (BOOLEAN, False), "at": (PLACES, "home")},
        output={"extend": (BOOLEAN, False), "target": (PLACES, "home")},
        effects={
            "arm_retracts": ("not extend and extended", ("extended := false",)),
            "robot_leaves": ("target == out and at == home", ("at := away",)),
            "robot_arrives": ("target == out and at == away", ("at := out",)),
        },
        forbidden={"arm_in": "at != home and extended"},
    )


def way(**changes: Value | None) -> WayBackAnswer:
    """What is said of the robot in its initial state with `changes`."""
    station = armed_robot()
    state = synchronise(station, {**initial_state(station), **changes})
    return WaysBack(station, synthesise(station).safe).answer(WayBackRequest(state))


def test_a_restart_ability_may_lead_back() -> None:
    answer = way(at="away", target="out", extended=True, extend=True)
    assert isinstance(answer.way, RecoveryPath)
    assert [(tick.effects, tick.starts) for tick in answer.way.ticks] == [((), ("retract",)), (("arm_retracts",), ())]
    assert answer.way.breaks == ()
    assert answer.threatened == ()


def test_a_station_can_come_back_by_itself() -> None:
    answer = way(at="away", target="out", extended=True, extend=False)
    assert answer.way is not None
    assert answer.way.starts == ()
    assert [tick.effects for tick in answer.way.ticks] == [("arm_retracts",)]


def test_what_devices_could_violate_is_named() -> None:
    """The robot is about to leave; that the arm comes in first is not certain."""
    answer = way(at="home", target="out", extended=True, extend=False)
    assert answer.threatened == ("arm_in",)
    assert answer.way is not None
    assert [tick.effects for tick in answer.way.ticks] == [("arm_retracts",)]


def test_where_no_way_leads_back_it_is_said_how_far_was_searched() -> None:
    answer = way(at="away", target="home", extended=True, extend=None)
    assert answer.way is None
    assert answer.searched == WayBackRequest({}).longest
