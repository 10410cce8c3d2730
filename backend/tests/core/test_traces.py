"""Traces replay on the reference, and no shorter ones exist; so does what shows that specifications cannot be met."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import replace
from itertools import combinations
from typing import Any

from hypothesis import given

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.tick import apply_effects
from sequence_planner.language.types import BOOLEAN
from sequence_planner.synthesis.diagnosis import Unmeetable
from sequence_planner.synthesis.minimal_conflict import Conflict, minimal_conflict
from sequence_planner.synthesis.reachability import Tracer
from sequence_planner.synthesis.supervisor import Supervision, SynthesisError, supervised
from sequence_planner.synthesis.traces import StepKind
from sequence_planner.synthesis.transition_relation import Plant
from support.automata import Does, automaton
from support.examples import examples

from .choices import Choices, made_by
from .explicit import Explicit, Key
from .explicit_plain import ExplicitPlain
from .plain_questions import meant
from .random_devices import device_station
from .random_plain import document
from .random_stations import automaton as random_automaton
from .replaying import replay

OFF = (BOOLEAN, False)


def any_station(choices: Choices) -> Automaton:
    return device_station(choices) if choices.chance(2) else random_automaton(choices)


def distances(explicit: Explicit, starts: bool, faults: bool, within: Iterable[Key]) -> dict[Key, int]:
    """How many steps away from the initial state each state is."""
    found = {explicit.initial: 0} if explicit.initial in set(within) else {}
    layer = set(found)
    uncontrollable = explicit.uncontrollable if faults else explicit.helpful
    while layer:
        following: set[Key] = set()
        for key in layer:
            following |= uncontrollable[key] | (set(explicit.starts[key].values()) if starts else set())
        layer = (following & set(within)) - found.keys()
        found |= dict.fromkeys(layer, max(found.values()) + 1)
    return found


@examples(120)
@given(made_by(lambda c: (any_station(c), c.chance(2), c.chance(2), c.chance(2), c.number(0, 999))))
def test_a_trace_replays_and_is_a_shortest_one(drawn: tuple[Automaton, bool, bool, bool, int]) -> None:
    station, starts, faults, safely, pick = drawn
    explicit = Explicit(station)
    plant = Plant(station, tuple(station.variables))
    keys = sorted(explicit.states, key=str)
    end = keys[pick % len(keys)]
    within = Supervision(plant).safe if safely else None
    trace = Tracer(plant, starts=starts, faults=faults, within=within).shortest(
        plant.diagrams.states(explicit.states[end])
    )
    reached = distances(explicit, starts, faults, explicit.safe if safely else explicit.states)
    assert (trace is None) == (end not in reached)
    if trace is None:
        return
    states = replay(station, trace)
    assert explicit.key(states[-1]) == end
    assert len(trace.steps) == reached[end]
    assert not safely or {explicit.key(state) for state in states} <= explicit.safe
    kinds = {step.kind for step in trace.steps}
    assert starts or StepKind.START not in kinds
    assert faults or not {name for step in trace.steps for name in step.names} & {
        effect.name for effect in station.effects if effect.fault
    }


@examples(60)
@given(made_by(lambda c: (any_station(c), c.number(0, 999))))
def test_the_effects_of_a_tick_are_as_few_as_explain_it(drawn: tuple[Automaton, int]) -> None:
    station, pick = drawn
    explicit = Explicit(station)
    plant = Plant(station, tuple(station.variables))
    reached = sorted(distances(explicit, True, True, explicit.states), key=str)
    trace = Tracer(plant).shortest(plant.diagrams.states(explicit.states[reached[pick % len(reached)]]))
    assert trace is not None
    before = trace.initial
    for step in trace.steps:
        if step.kind is StepKind.TICK:
            effects = [effect for effect in station.effects if effect.name in step.names]
            sensed = apply_effects(before, effects)
            for fewer in combinations(station.effects, len(effects) - 1) if effects else ():
                assert apply_effects(before, fewer) != sensed
        before = step.state


@examples(120)
@given(made_by(lambda c: (document(c), c.number(0, 999))))
def test_traces_of_plain_automata(drawn: tuple[dict[str, Any], int]) -> None:
    explicit, station = meant(drawn[0])
    if station is None:
        return
    plant = Plant(station, tuple(station.variables))
    keys = sorted(explicit.states, key=str)
    end = keys[drawn[1] % len(keys)]
    trace = Tracer(plant).shortest(plant.diagrams.states(explicit.valuation(end)))
    reached = explicit.distances(explicit.initial, supervised=False)
    assert (trace is None) == (end not in reached)
    if trace is not None:
        assert tuple(replay(station, trace)[-1].values()) == end
        assert len(trace.steps) == reached[end]


@examples(200)
@given(made_by(any_station))
def test_specifications_that_cannot_be_met_are_shown_by_a_trace(station: Automaton) -> None:
    """A shortest one into what is forbidden, if nothing could prevent it; else one that says what is wrong."""
    explicit = Explicit(station)
    if explicit.initial in explicit.safe:
        return
    reason = why(station)
    assert reason.trace is not None
    states = replay(station, reason.trace)
    alone = distances(explicit, False, True, explicit.states)
    if forced := explicit.forbidden & alone.keys():
        assert len(reason.trace.steps) == min(alone[key] for key in forced)
        assert reason.trace.steps == () or reason.trace.steps[-1].forbidden_by
        assert StepKind.START not in {step.kind for step in reason.trace.steps}
        assert reason.trace.breaks[0] in reason.message
    else:
        assert "rest" in reason.message
        assert any(explicit.key(state) not in explicit.safe for state in states)


@examples(60)
@given(made_by(any_station))
def test_the_specifications_in_conflict_are(station: Automaton) -> None:
    explicit = Explicit(station)
    if explicit.initial in explicit.safe:
        return
    conflict = minimal_conflict(station, why(station).trace)
    assert conflict.minimal
    kept = {name: station.specifications[name] for name in conflict.specifications}
    alone = Explicit(replace(station, specifications=kept))
    assert alone.initial not in alone.safe
    assert set(conflict.uncontrollable) <= {
        *(effect.name for effect in station.effects),
        *(f"{ability.name}.finish" for ability in station.abilities.values()),
    }


@examples(150)
@given(made_by(document))
def test_a_plain_automaton_in_conflict(written: dict[str, Any]) -> None:
    """What is in conflict is so with all other transitions controllable; and nothing of it can be taken out."""
    explicit, station = meant(written)
    if station is None or explicit.initial <= explicit.safe:
        return
    trace = why(station).trace
    assert trace is not None
    replay(station, trace)
    conflict = minimal_conflict(station, trace)

    def conflicting(specifications: Collection[str], uncontrollable: Collection[str]) -> bool:
        forbidden = [text for n, text in enumerate(written["forbidden"], 1) if f"forbidden_{n}" in specifications]
        seen: Counter[str] = Counter()
        changed = []
        for each in written["transitions"]:
            seen[each["event"]] += 1
            name = each["event"] if seen[each["event"]] == 1 else f"{each['event']}#{seen[each['event']]}"
            changed.append({**each, "controllable": name not in uncontrollable})
        tried = ExplicitPlain({**written, "forbidden": forbidden, "transitions": changed})
        return not tried.initial <= tried.safe

    specifications, uncontrollable = set(conflict.specifications), set(conflict.uncontrollable)
    assert conflict.minimal
    assert conflicting(specifications, uncontrollable)
    assert not any(conflicting(specifications - {name}, uncontrollable) for name in specifications)
    assert not any(conflicting(specifications, uncontrollable - {name}) for name in uncontrollable)


def why(station: Automaton) -> Unmeetable:
    try:
        supervised(station)
    except SynthesisError as error:
        return error.reason
    raise AssertionError("there is a supervisor")


def test_what_does_not_matter_is_not_in_conflict() -> None:
    station = automaton(
        {"paint": Does(start=("wet := true",)), "dry": Does(start=(), finish="hot", finally_=("wet := false",))},
        measured={"warm": OFF, "hot": OFF, "loud": OFF},
        estimated={"wet": OFF},
        effects={
            "warms": ("not warm", ("warm := true",)),
            "heats": ("warm", ("hot := true",)),
            "shouts": ("true", ("loud := true",)),
        },
        forbidden={"quiet_paint": "loud and wet and hot", "never_hot": "hot"},
    )
    reason = why(station)
    assert reason.trace is not None
    assert reason.trace.lines() == [
        "tick 1: warm := true (warms)",
        "tick 2: hot := true (heats), which never_hot forbids",
    ]
    assert minimal_conflict(station, reason.trace) == Conflict(("never_hot",), ("heats", "warms"), minimal=True)


def test_a_finish_can_be_in_conflict() -> None:
    station = automaton(
        {"glue": Does(start=(), finish="ready", finally_=("stuck := true",))},
        measured={"ready": OFF},
        estimated={"stuck": OFF},
        effects={"gets_ready": ("true", ("ready := true",))},
        forbidden={"loose": "stuck"},
    )
    assert minimal_conflict(station).uncontrollable == ("gets_ready", "glue.finish")


def test_rest_that_is_reached_only_through_what_is_forbidden() -> None:
    def station(finished: str) -> Automaton:
        return automaton(
            {"go": Does(start=("gate := true",)), "work": Does(start=(finished,), enabled="gate")},
            output={"gate": OFF},
            estimated={"done": OFF},
            forbidden={"closed_gate": "gate and not done"},
            rest="done and gate",
        )

    reason = why(station("done := true"))
    assert "can be reached safely: the shortest way there breaks `closed_gate` in step 1." in reason.message
    assert reason.lines == (
        "start 1: go: gate := true, which closed_gate forbids",
        "start 2: work: done := true",
    )
    reason = why(station("done := false"))
    assert "no state described by `rest` in station.yaml can be reached. So it is also without any" in reason.message
    assert minimal_conflict(station("done := true")) == Conflict(("closed_gate",), (), minimal=True)
    assert minimal_conflict(station("done := false")) == Conflict((), (), minimal=True)


def test_rest_that_is_reached_only_where_devices_could_break_something() -> None:
    station = automaton(
        {"lift": Does(start=("lifted := true",)), "work": Does(start=("done := true",), enabled="lifted")},
        measured={"fell": OFF},
        output={"lifted": OFF},
        estimated={"done": OFF},
        effects={"slips": ("lifted and not done", ("fell := true",))},
        forbidden={"never_fallen": "fell"},
        rest="done",
    )
    reason = why(station)
    assert "leaves it to chance, from step 1 on, whether `never_fallen` is broken" in reason.message
    assert reason.lines == ("start 1: lift: lifted := true", "start 2: work: done := true")
    assert minimal_conflict(station, reason.trace) == Conflict(("never_fallen",), ("slips",), minimal=True)


def test_rest_that_devices_take_away() -> None:
    station = automaton(
        {"rinse": Does(start=("clean := true",))},
        measured={"rotten": OFF},
        estimated={"clean": OFF},
        effects={"rots": ("not rotten", ("rotten := true",))},
        rest="clean and not rotten",
    )
    reason = why(station)
    assert reason.message.startswith("from where the devices alone can lead no state described by `rest`")
    assert reason.lines == ("tick 1: rotten := true (rots)",)
    assert minimal_conflict(station, reason.trace) == Conflict((), ("rots",), minimal=True)
