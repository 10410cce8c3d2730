"""A text in CIF means what its plain automaton does, as far as a reader of that part of the language can tell."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Set
from itertools import product

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.export.cif import cif_text
from sequence_planner.export.efa import plain_of_station
from sequence_planner.language.evaluator import holds
from sequence_planner.language.types import Value
from sequence_planner.model.efa_document import read_plain
from sequence_planner.model.source import ModelError
from support.examples import examples

from .choices import Choices, made_by
from .cif_reader import Specification, read_cif
from .random_devices import device_station
from .random_plain import document
from .random_stations import automaton as random_automaton

Key = tuple[Value, ...]
# Where each state can go, and whether that is controllable.
Taken = Mapping[Key, Set[tuple[bool, Key]]]


def read(text: str) -> Automaton:
    return plain_automaton(read_plain(text, "example.efa.json"))


def any_station(choices: Choices) -> Automaton:
    return device_station(choices) if choices.chance(2) else random_automaton(choices)


class Translation:
    """States of a plain automaton as those of its text in CIF, of which declarations are in the same order."""

    def __init__(self, plain: Automaton) -> None:
        self.plain = plain
        self.cif: Specification = read_cif(cif_text(plain))
        assert len(self.cif.domains) == len(plain.variables)
        self._names = dict(zip(plain.variables, self.cif.domains, strict=True))
        self._values: dict[str, dict[Value | None, Value]] = {
            name: dict(zip(variable.type.domain, self.cif.domains[self._names[name]], strict=True))
            for name, variable in plain.variables.items()
        }
        self.events = dict(zip(dict.fromkeys(map(event_of, plain_transitions(plain))), self.cif.events, strict=True))

    def of(self, state: State) -> dict[str, Value]:
        return {self._names[name]: self._values[name][state[name]] for name in self.plain.variables}

    def compare(self, state: State) -> None:
        """What can happen in a state, and what the state is."""
        here: set[tuple[str, tuple[Value, ...]]] = set()
        for name, transition in plain_transitions(self.plain).items():
            if (after := step(state, transition)) is not None:
                here.add((self.events[event_of(name)], tuple(self.of(after).values())))
        written = self.of(state)
        there = {(e.event, tuple(after.values())) for e in self.cif.edges if (after := e.after(written)) is not None}
        assert there == here
        forbidden = any(holds(each.forbidden, state) for each in self.plain.specifications.values())
        assert all(invariant(written) for invariant in self.cif.invariants) is not forbidden
        assert self.cif.marked(written) is (self.plain.rest is None or holds(self.plain.rest, state))
        if self.plain.initial is None:
            first = {name: variable.initial for name, variable in self.plain.variables.items()}
            assert self.cif.initial(written)
            assert self.cif.initial_values == self.of(first)
        else:
            assert self.cif.initial(written) is holds(self.plain.initial, state)
            assert set(self.cif.initial_values.values()) == {None}


def states_of(choices: Choices, plain: Automaton) -> list[State]:
    """Some of them, reachable or not."""
    domains = {name: variable.type.domain for name, variable in plain.variables.items()}
    return [{name: choices.pick(domain) for name, domain in domains.items()} for _ in range(6)]


def plain_with_states(choices: Choices) -> tuple[Automaton | None, list[State]]:
    try:
        plain = read(json.dumps(document(choices)))
    except ModelError:
        return None, []
    return plain, states_of(choices, plain)


def station_with_states(choices: Choices) -> tuple[Automaton, list[State]]:
    plain = plain_of_station(any_station(choices))
    return plain, states_of(choices, plain)


@examples(200)
@given(made_by(plain_with_states))
def test_a_text_in_cif_says_what_its_automaton_does(given_: tuple[Automaton | None, list[State]]) -> None:
    plain, states = given_
    if plain is not None:
        translation = Translation(plain)
        for state in states:
            translation.compare(state)


@examples(80)
@given(made_by(station_with_states))
def test_a_text_in_cif_says_what_its_station_does(given_: tuple[Automaton, list[State]]) -> None:
    plain, states = given_
    translation = Translation(plain)
    assert translation.cif.events == {
        translation.events[event_of(n)]: t.controllable for n, t in plain_transitions(plain).items()
    }
    for state in states:
        translation.compare(state)


def test_the_figures_of_the_worked_example_come_from_its_text_alone(worked_example: Automaton) -> None:
    """State by state, as its synthesis defines a supervisor: between ticks 180 states, and 148 supervised."""
    cif = read_cif(cif_text(plain_of_station(worked_example)))
    first = tuple(value for value in cif.initial_values.values() if value is not None)
    taken: dict[Key, set[tuple[bool, Key]]] = {}
    pending = [first]
    while pending:
        if (key := pending.pop()) not in taken:
            state = dict(zip(cif.domains, key, strict=True))
            found = [(cif.events[e.event], after) for e in cif.edges if (after := e.after(state)) is not None]
            taken[key] = {(controllable, tuple(after.values())) for controllable, after in found}
            pending.extend(after for _, after in taken[key])
    assert between_ticks(cif, taken) == 180
    safe = {k for k in taken if all(invariant(dict(zip(cif.domains, k, strict=True))) for invariant in cif.invariants)}
    while (kept := kept_of(cif, taken, safe)) != safe:
        safe = kept
    reached, pending = set[Key](), [first]
    while pending:
        if (key := pending.pop()) not in reached:
            reached.add(key)
            pending.extend(after for _, after in taken[key] if after in safe)
    assert between_ticks(cif, reached) == 148


def kept_of(cif: Specification, taken: Taken, safe: set[Key]) -> set[Key]:
    """Of safe states, those that nothing uncontrollable leaves, and that can reach a marked one inside."""
    closed = {k for k in safe if all(controllable or after in safe for controllable, after in taken[k])}
    kept = {k for k in closed if cif.marked(dict(zip(cif.domains, k, strict=True)))}
    while more := {k for k in closed - kept if any(after in kept for _, after in taken[k])}:
        kept |= more
    return kept


def between_ticks(cif: Specification, keys: Iterable[Key]) -> int:
    position = list(cif.domains).index("phase")
    return sum(key[position] == "phase_stable" for key in keys)


def test_words_of_cif_and_signs_that_its_names_cannot_have() -> None:
    text = cif_text(
        read(
            json.dumps(
                {
                    "name": "übung",
                    "variables": {"location": ["on", "off"], "a.b": {"min": -2, "max": 1}, "a_b": "bool"},
                    "initial": "location == on and a.b == -1 and not a_b",
                    "transitions": [
                        {"event": "edge", "controllable": True, "guard": "a.b < 0", "set": {"a.b": "a.b + 1"}},
                        {"event": "1st", "controllable": False, "set": {"location": "off"}},
                    ],
                }
            )
        )
    )
    lines = [line.strip() for line in text.splitlines()]
    assert "enum location_values = location_on, location_off;" in lines
    assert "disc int[0..3] a_b = 1;" in lines
    assert "disc bool a_b_2 = false;" in lines
    assert "edge $edge when a_b < 2 and a_b <= 2 do a_b := a_b + 1;" in lines
    assert "edge n_1st do $location := location_off;" in lines
    assert "// a_b is 2 more than the value, which can be negative" in lines
    assert text.isascii()


CONDITIONS = {
    "is_open == (wanted == open)": "is_open <=> (wanted = wanted_open)",
    "is_open != (n < 1)": "not (is_open <=> (n < 1))",
    "wanted != found": (
        "not ((wanted = wanted_open and found = found_open) or (wanted = wanted_shut and found = found_shut))"
    ),
    "found in {lost, open}": "found = found_lost or found = found_open",
    "n - m <= 1 - n": "n + n <= m + 1",
    "is_open implies n + m > 3": "is_open => (n + m > 3)",
    "not (is_open and not n == m)": "not (is_open and not (n = m))",
}


@pytest.mark.parametrize(("condition", "text"), CONDITIONS.items())
def test_conditions(condition: str, text: str) -> None:
    variables = {
        "is_open": "bool",
        "wanted": ["open", "shut"],
        "found": ["lost", "open", "shut"],
        "n": {"min": 0, "max": 3},
        "m": {"min": 0, "max": 3},
    }
    transition = {"event": "e", "controllable": True, "guard": condition}
    plain = read(json.dumps({"name": "x", "variables": variables, "initial": "n == 0", "transitions": [transition]}))
    assert f"    edge e when {text};" in cif_text(plain).splitlines()
    translation = Translation(plain)
    for values in product(*(variable.type.domain for variable in plain.variables.values())):
        translation.compare(dict(zip(plain.variables, values, strict=True)))
