"""The supervisor of a random automaton beside the one of its definition, state by state and start by start."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from random import Random

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.types import Value
from sequence_planner.model.efa_document import read_plain
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.supervisor import Supervision, SynthesisError, relevant, synthesise
from sequence_planner.synthesis.transition_relation import Plant

from .choices import Choices
from .explicit import Explicit
from .explicit_plain import ExplicitPlain
from .random_devices import device_station
from .random_synthesis import large_document, large_station

Key = tuple[Value, ...]


def compare_plain(seed: str) -> Counter[str]:
    """Compare the plain automaton that `seed` makes; what has been met. Raises `AssertionError`."""
    explicit = ExplicitPlain(large_document(Choices(Random(seed).randrange)))
    met = Counter(automata=1, states=len(explicit.states))
    if not explicit.initial:
        return met + Counter({"automata without an initial state": 1})
    automaton = plain_automaton(read_plain(json.dumps(explicit.document), "random.efa.json"))
    met["automata with several initial states"] = len(explicit.initial) > 1
    reached = {kind: explicit.distances(explicit.initial, kind).keys() for kind in (False, True)}
    met += _compare_sets(automaton, list(explicit.states), explicit.safe, reached, explicit.initial)
    if (supervisor := _supervisor(automaton, explicit.initial <= explicit.safe)) is None:
        return met + Counter({"automata without a supervisor": 1})
    names: dict[str, list[str]] = {}
    for name in (*automaton.abilities, *(effect.name for effect in automaton.effects)):
        names.setdefault(event_of(name), []).append(name)
    for transition in explicit.document["transitions"]:
        name = names[transition["event"]].pop(0)
        if transition["controllable"]:
            for before, after in explicit.taken(transition).items():
                if before in explicit.safe:
                    states = explicit.valuation(before), explicit.valuation(after)
                    met += _compare_start(supervisor, name, *states, after in explicit.safe)
    return met


def compare_station(seed: str) -> Counter[str]:
    """Compare the station that `seed` makes; what has been met. Raises `AssertionError`."""
    choices = Choices(Random(seed).randrange)
    station = device_station(choices) if choices.chance(4) else large_station(choices)
    explicit = Explicit(station)
    met = Counter(stations=1, states=len(explicit.states))
    met["stations with restart abilities"] = any(ability.restart for ability in station.abilities.values())
    met["stations with faults"] = any(effect.fault for effect in station.effects)
    met["stations with activities"] = bool(station.operations)
    reached = {kind: explicit.reachable(kind) for kind in (False, True)}
    met += _compare_sets(station, explicit.states, explicit.safe, reached, {explicit.initial})
    if (supervisor := _supervisor(station, explicit.initial in explicit.safe)) is None:
        return met + Counter({"stations without a supervisor": 1})
    for key in explicit.safe:
        for name, after in explicit.starts[key].items():
            states = explicit.states[key], explicit.states[after]
            met += _compare_start(supervisor, name, *states, after in explicit.safe)
    return met


def _compare_sets(
    automaton: Automaton,
    states: Iterable[Key],
    safe: Iterable[Key],
    reached: Mapping[bool, Iterable[Key]],
    initial: Iterable[Key],
) -> Counter[str]:
    """Over all variables, and over those that matter."""
    safe, states = frozenset(safe), tuple(states)
    for names in (tuple(automaton.variables), relevant(automaton)):
        supervision = Supervision(Plant(automaton, names))
        diagrams = supervision.plant.diagrams
        position = {name: number for number, name in enumerate(automaton.variables)}
        kept = [position[name] for name in diagrams.names]

        def projected(keys: Iterable[Key], kept: list[int] = kept) -> set[Key]:
            return {tuple(key[number] for number in kept) for key in keys}

        def members(function: Function, supervision: Supervision = supervision) -> set[Key]:
            diagrams = supervision.plant.diagrams
            return {tuple(each.values()) for each in diagrams.exported(function, diagrams.names).members()}

        computed = members(supervision.safe)
        agrees = all((tuple(key[number] for number in kept) in computed) == (key in safe) for key in states)
        assert agrees, f"the safe states over {diagrams.names} differ"
        assert supervision.possible == (frozenset(initial) <= safe), "it differs whether there is a supervisor"
        for supervised, keys in reached.items():
            function, expected = supervision.reachable(supervised), projected(keys)
            assert members(function) == expected, f"reached with supervisor {supervised}: other states than expected"
            assert diagrams.count(function) == len(expected), f"reached with supervisor {supervised}: another number"
    lost = set(reached[False]) - safe
    return Counter({"reachable states": len(set(reached[False])), "reachable states that are not safe": len(lost)})


def _supervisor(automaton: Automaton, possible: bool) -> Supervisor | None:
    try:
        supervisor = synthesise(automaton)
    except SynthesisError:
        assert not possible, "there is a supervisor, and none is found"
        return None
    assert possible, "a supervisor is found where there is none"
    return supervisor


def _compare_start(supervisor: Supervisor, name: str, before: State, after: State, allowed: bool) -> Counter[str]:
    assert supervisor.allows(before, after) == allowed, f"the start {name} in {before} is allowed: not {allowed}"
    guarded = name not in supervisor.guards or supervisor.guards[name].includes(before)
    assert guarded == allowed, f"the guard of {name} in {before} says {guarded}"
    return Counter({"starts allowed" if allowed else "starts that must wait": 1})
