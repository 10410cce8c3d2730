"""The supervisor by enumeration of the variables that matter is the supervisor of the definition."""

from __future__ import annotations

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state, sense, start_guard_holds, synchronise
from sequence_planner.language.types import BOOLEAN, EnumerationType
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.supervisor import Supervision, SynthesisError, relevant, synthesise
from sequence_planner.synthesis.transition_relation import Plant
from support.automata import Does, automaton
from support.examples import examples

from .choices import Choices, made_by
from .explicit import Explicit, Key
from .random_devices import device_station
from .random_stations import automaton as random_automaton

OFF = (BOOLEAN, False)


def any_station(choices: Choices) -> Automaton:
    return device_station(choices) if choices.chance(2) else random_automaton(choices)


@examples(220)
@given(made_by(any_station))
def test_safe_and_reachable_states_are_those_of_the_definition(station: Automaton) -> None:
    """Over the variables that matter, they are the projections of those over all variables."""
    explicit = Explicit(station)
    supervision = Supervision(Plant(station, relevant(station)))
    diagrams = supervision.plant.diagrams

    def projected(key: Key) -> Key:
        values = dict(zip(station.variables, key, strict=True))
        return tuple(values[name] for name in diagrams.names)

    def members(states: Function) -> set[Key]:
        return {tuple(member.values()) for member in diagrams.exported(states, diagrams.names).members()}

    safe = members(supervision.safe)
    for key in explicit.states:
        assert (projected(key) in safe) == (key in explicit.safe)
    for supervised in (False, True):
        reached = supervision.reachable(supervised)
        assert members(reached) == set(map(projected, explicit.reachable(supervised)))
        assert diagrams.count(reached) == len(members(reached))


@examples(200)
@given(made_by(any_station))
def test_there_is_a_supervisor_exactly_when_the_initial_state_is_safe(station: Automaton) -> None:
    """And its guards say for every safe state, over fewer variables, what the safe set says."""
    explicit = Explicit(station)
    if explicit.initial not in explicit.safe:
        with pytest.raises(SynthesisError):
            synthesise(station)
        return
    supervisor = synthesise(station)
    for key in explicit.safe:
        state = explicit.states[key]
        for ability in station.abilities.values():
            if not ability.restart and (after := explicit.started(state, ability)) is not None:
                shown = ability.name not in supervisor.guards or supervisor.guards[ability.name].includes(state)
                assert shown == supervisor.allows(state, after) == (explicit.key(after) in explicit.safe)


def test_a_finish_that_writes_nothing_of_interest_still_refuses_one_that_does() -> None:
    """Both write `log`, and so neither is applied: `stop` can never make the forbidden state."""
    places = EnumerationType(("nowhere", "here", "there"))
    station = automaton(
        {
            "stop": Does(start=(), finish="done", finally_=("danger := true", "log := here")),
            "note": Does(start=(), finish="done", finally_=("log := there",)),
        },
        measured={"done": OFF},
        estimated={"danger": OFF, "log": (places, "nowhere")},
        effects={"finishes": ("not done", ("done := true",))},
        forbidden={"no_danger": "danger"},
    )
    assert synthesise(station).safe.includes(initial_state(station))


def test_effects_that_dispute_a_variable_cannot_both_happen() -> None:
    station = automaton(
        {},
        measured={"a": OFF, "b": OFF, "side": OFF},
        effects={"one": ("not b", ("a := true", "side := true")), "other": ("not a", ("b := true", "side := false"))},
        forbidden={"not_both": "a and b"},
    )
    assert synthesise(station).safe.includes(initial_state(station))


def test_what_the_environment_does_by_itself_is_an_error_with_the_shortest_trace() -> None:
    station = automaton(
        {},
        measured={"warm": OFF, "hot": OFF},
        effects={"warms": ("not warm", ("warm := true",)), "heats": ("warm", ("hot := true",))},
        forbidden={"never_hot": "hot"},
    )
    with pytest.raises(SynthesisError) as error:
        synthesise(station)
    assert str(error.value).splitlines() == [
        "specification never_hot cannot be met: no start could prevent this from the initial state on",
        "  tick 1: warm := true",
        "  tick 2: hot := true",
        "  violated with warm = true, hot = true",
    ]


def test_without_a_way_to_rest_there_is_no_supervisor_and_faults_and_restart_abilities_are_no_way() -> None:
    def station(restart: bool, faults: tuple[str, ...]) -> Automaton:
        return automaton(
            {"home": Does(start=("target := true",), restart=restart)},
            measured={"there": OFF},
            output={"target": OFF},
            effects={"arrives": ("target", ("there := true",))},
            faults=faults,
            rest="there",
        )

    assert synthesise(station(restart=False, faults=())).safe.everything
    for without in (station(restart=True, faults=()), station(restart=False, faults=("arrives",))):
        with pytest.raises(SynthesisError, match="rest"):
            synthesise(without)


def test_a_fault_must_not_be_able_to_lead_into_a_forbidden_state() -> None:
    station = automaton(
        {"open": Does(start=("valve := true",))},
        measured={"burst": OFF},
        output={"valve": OFF},
        effects={"bursts": ("valve", ("burst := true",))},
        faults=("bursts",),
        forbidden={"no_burst": "burst"},
    )
    supervisor, state = synthesise(station), initial_state(station)
    assert not supervisor.allows(state, {**state, "valve": True})


@pytest.fixture
def valve() -> tuple[Automaton, Supervisor, State]:
    """The valve must not be open while it is hot; nothing says when it becomes hot."""
    station = automaton(
        {"open": Does(start=("valve := true",)), "paint": Does(start=("painted := true",))},
        measured={"hot": OFF},
        output={"valve": OFF, "painted": OFF},
        forbidden={"no_hot_valve": "valve and hot"},
    )
    return station, synthesise(station), initial_state(station)


def test_a_start_must_be_safe_for_every_value_that_an_unknown_could_have(
    valve: tuple[Automaton, Supervisor, State],
) -> None:
    station, supervisor, cold = valve
    opened = {**cold, "valve": True}
    assert supervisor.allows(cold, opened)
    unknown = synchronise(station, sense(cold, {"hot": None}))
    assert start_guard_holds(station.abilities["open"], unknown)
    assert not supervisor.allows(unknown, {**unknown, "valve": True})
    assert supervisor.allows(unknown, {**unknown, "painted": True})


def test_outside_the_safe_set_nothing_starts(valve: tuple[Automaton, Supervisor, State]) -> None:
    _, supervisor, cold = valve
    unsafe = {**cold, "valve": True, "hot": True}
    assert not supervisor.allows(unsafe, {**unsafe, "painted": True})
    assert not supervisor.allows(unsafe, {**unsafe, "valve": False})


def test_variables_that_do_not_matter_are_not_enumerated(valve: tuple[Automaton, Supervisor, State]) -> None:
    _, supervisor, _ = valve
    assert set(supervisor.safe.names) == {"valve", "hot"}
