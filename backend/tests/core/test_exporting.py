"""What is exported means what the model does: station and plain automaton, plain automaton and CIF."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import replace
from math import prod
from typing import Any

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton, Effect, Kind, Specification, VariableDeclaration
from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.automaton.plain.steps import plain_transitions
from sequence_planner.automaton.transitions import Transition
from sequence_planner.export.efa import (
    different,
    dotted,
    efa_document,
    efa_text,
    names_in_document,
    plain_of_station,
    remarks,
    word,
)
from sequence_planner.language.syntax import TRUE, Variable, conjuncts
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange
from sequence_planner.model.efa_document import read_plain
from sequence_planner.model.source import ModelError
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.supervisor import Supervision
from sequence_planner.synthesis.transition_relation import Plant
from support.automata import Does, automaton
from support.examples import examples

from .choices import Choices, made_by
from .explicit import Explicit, Key
from .explicit_plain import ExplicitPlain
from .random_devices import device_station
from .random_expressions import actions, guard, rare
from .random_plain import document
from .random_stations import automaton as random_automaton

OFF = (BOOLEAN, False)
POSES = EnumerationType(("home", "bench"))


def read(text: str) -> Automaton:
    return plain_automaton(read_plain(text, "example.efa.json"))


def any_station(choices: Choices) -> Automaton:
    return device_station(choices) if choices.chance(2) else random_automaton(choices)


def contending(choices: Choices) -> Automaton:
    """A random station with two more measured variables, and effects that contend for all of them."""
    station = random_automaton(choices)
    more = {name: VariableDeclaration(name, BOOLEAN, Kind.MEASURED, False, None) for name in ("mx", "my")}
    declared = {**station.variables, **more}
    seen = [Variable(n, v.type) for n, v in declared.items() if v.kind in (Kind.MEASURED, Kind.OUTPUT)]
    measured = [variable for variable in seen if declared[variable.name].kind is Kind.MEASURED]
    effects = [
        Effect(f"e{i}", "station", "executing", guard(choices, seen), actions(choices, measured, seen, least=1))
        for i in range(choices.number(3, 5))
    ]
    forbidden = Specification("more", "more", rare(choices, [Variable(n, v.type) for n, v in declared.items()]))
    return replace(station, variables=declared, effects=tuple(effects), specifications={"more": forbidden})


def without_faults(station: Automaton) -> Automaton:
    return replace(station, effects=tuple(replace(effect, fault=False) for effect in station.effects))


class Sides:
    """A station, and what is read back of its document: their states between ticks, compared."""

    def __init__(self, station: Automaton) -> None:
        plain = plain_of_station(station)
        self.written = read(efa_text(plain))
        self.station = Supervision(Plant(station, tuple(station.variables)))
        self.plain = Supervision(Plant(self.written, tuple(self.written.variables)))
        names = names_in_document(plain)
        self._names = {name: names[name] for name in station.variables}
        idle = {names[n]: v.initial for n, v in plain.variables.items() if n not in station.variables}
        self._stable = self.plain.plant.diagrams.states({**dict.fromkeys(self.written.variables), **idle})

    def of_station(self, states: Function) -> set[Key]:
        return _members(self.station, states, self._names)

    def of_plain(self, states: Function) -> set[Key]:
        """With helper variables as they are between ticks."""
        return _members(self.plain, states & self._stable, self._names.values())


def _members(supervision: Supervision, states: Function, names: Iterable[str]) -> set[Key]:
    diagrams = supervision.plant.diagrams
    order = list(names)
    members = diagrams.exported(states, diagrams.names).members()
    return {tuple(member[name] for name in order) for member in members}


@examples(50)
@given(made_by(any_station))
def test_between_ticks_the_same_states_are_safe_and_reachable(station: Automaton) -> None:
    compare(without_faults(station))


@examples(25)
@given(made_by(contending))
def test_effects_that_contend_for_variables_happen_together_as_in_a_tick(station: Automaton) -> None:
    compare(station)


def compare(station: Automaton) -> None:
    sides = Sides(station)
    assert sides.of_plain(sides.plain.safe) == sides.of_station(sides.station.safe)
    for supervised in (False, True):
        reached = sides.plain.reachable(supervised)
        assert sides.of_plain(reached) == sides.of_station(sides.station.reachable(supervised))
    assert sides.plain.possible == sides.station.possible


@examples(30)
@given(made_by(any_station))
def test_what_is_safe_in_spite_of_faults_is_safe_there(station: Automaton) -> None:
    """Without states of rest they make no difference, and with them this is said."""
    sides = Sides(station)
    there, here = sides.of_plain(sides.plain.safe), sides.of_station(sides.station.safe)
    assert here <= there
    assert here == there or any("faults" in remark for remark in remarks(station))


@examples(30)
@given(made_by(any_station))
def test_the_definitions_of_both_agree(station: Automaton) -> None:
    """Of small ones: sets of states and the tick on one side, transitions as they are written on the other."""
    station = without_faults(station)
    plain = plain_of_station(station)
    if prod(len(variable.type.domain) for variable in plain.variables.values()) > 1500:
        return
    explicit, there = Explicit(station), ExplicitPlain(complete(efa_document(plain)))
    idle = tuple(v.initial for name, v in plain.variables.items() if name not in station.variables)
    count = len(station.variables)
    assert {key[:count] for key in there.safe if key[count:] == idle} == explicit.safe
    for supervised in (False, True):
        reached = there.distances(there.initial, supervised)
        assert {key[:count] for key in reached if key[count:] == idle} == explicit.reachable(supervised)


def complete(written: dict[str, Any]) -> dict[str, Any]:
    """The document with all that it leaves out; conditions are texts."""

    def text(condition: bool | str) -> str:
        return condition if isinstance(condition, str) else str(condition).lower()

    return {
        **written,
        "transitions": [{"set": {}, **t, "guard": text(t.get("guard", True))} for t in written["transitions"]],
        "forbidden": [text(each) for each in written.get("forbidden", ())],
        "initial": text(written["initial"]),
        "marked": text(written.get("marked", True)),
        "invariant": "true",
    }


def test_the_figures_of_the_worked_example(worked_example: Automaton) -> None:
    sides = Sides(worked_example)
    assert len(sides.of_plain(sides.plain.reachable(supervised=False))) == 180
    assert len(sides.of_plain(sides.plain.reachable(supervised=True))) == 148
    assert sides.of_plain(sides.plain.safe) == sides.of_station(sides.station.safe)


def test_few_helper_variables_are_needed(worked_example: Automaton) -> None:
    """The devices of the example react one after another, and only two flags must be known afterwards."""
    plain = plain_of_station(worked_example)
    assert set(plain.variables) - set(worked_example.variables) == {
        "phase",
        "nutrunner.run_nut.executing.before",
        "operator.place_bolt.executing.before",
    }
    assert plain.variables["phase"].type.domain == ("stable", "sense_1", "sense_2", "sense_3", "finish_1", "finish_2")


def test_events_are_named_after_abilities_and_effects(worked_example: Automaton) -> None:
    transitions = plain_transitions(plain_of_station(worked_example))
    of_kind = {kind: {event_of(n) for n, t in transitions.items() if t.controllable is kind} for kind in (True, False)}
    assert of_kind[True] == set(worked_example.abilities)
    effects = {effect.name for effect in worked_example.effects}
    assert of_kind[False] == effects | {"tick", "pass", "nutrunner.run_nut.finish", "operator.place_bolt.finish"}


def test_effects_that_dispute_a_variable_are_not_both_taken() -> None:
    """The last one writes two variables, and each of the first two disputes one of them with it."""
    station = automaton(
        {},
        measured={"a": OFF, "b": OFF, "left": OFF, "right": OFF},
        effects={
            "one": ("true", ("a := true", "left := true")),
            "two": ("true", ("b := true", "right := true")),
            "both": ("true", ("a := false", "b := false")),
        },
    )
    plain = plain_of_station(station)
    assert any(name.endswith(".taken") for name in plain.variables)
    sides = Sides(station)
    reached = sides.plain.reachable(supervised=False)
    assert sides.of_plain(reached) == sides.of_station(sides.station.reachable(supervised=False))


def test_names_that_a_document_cannot_have() -> None:
    station = automaton(
        {"go": Does(start=("target := bench",))},
        output={"target": (POSES, "home")},
        estimated={
            "part[left, front]": OFF,
            "part_left_front": OFF,
            "home": OFF,
            "side": (EnumerationType(("front", "side")), "front"),
        },
    )
    plain = plain_of_station(station)
    assert names_in_document(plain) == {
        "target": "target",
        "part[left, front]": "part_left_front",
        "part_left_front": "part_left_front_2",
        "home": "home",
        "side": "side_2",
    }
    assert list(read(efa_text(plain)).variables) == list(names_in_document(plain).values())


def test_what_a_plain_automaton_does_not_say() -> None:
    station = automaton(
        {"go": Does(start=("target := bench",)), "back": Does(start=("target := home",), restart=True)},
        measured={"there": OFF},
        output={"target": (POSES, "home")},
        effects={"slips": ("there", ("there := false",))},
        faults=("slips",),
        rest="not there",
    )
    assert remarks(station) == (
        "faults count as a way back to rest there, which a station's supervisor never relies on: slips",
        "restart abilities are left out: back",
    )
    assert list(plain_of_station(station).abilities) == ["go"]
    assert remarks(replace(station, rest=None))[0].startswith("restart abilities")


@examples(120)
@given(made_by(document))
def test_a_plain_automaton_is_written_as_what_it_is(written: dict[str, Any]) -> None:
    try:
        meant = read(json.dumps(written))
    except ModelError:
        return
    again = read(efa_text(meant))
    assert replace(again, specifications=meant.specifications, initial=meant.initial) == meant
    assert conjuncts(again.initial or TRUE) == conjuncts(meant.initial or TRUE)
    assert [s.forbidden for s in again.specifications.values()] == [s.forbidden for s in meant.specifications.values()]
    assert efa_document(again) == efa_document(meant)


def test_names() -> None:
    assert [word(name) for name in ("a", "bolts[left]", "move(p, q).start", "1st", "_x_")] == [
        "a",
        "bolts_left",
        "move_p_q_start",
        "n_1st",
        "_x_",
    ]
    assert [dotted(name) for name in ("a.b", "move(p, q).start", "not.x")] == ["a.b", "move_p_q.start", "not_.x"]
    assert different(("a.b", "a_b", "c"), word, ("c",)) == {"a.b": "a_b", "a_b": "a_b_2", "c": "c_2"}


@pytest.mark.parametrize("type_", [IntegerRange(0, 2), BOOLEAN])
def test_nothing_to_react_to_needs_no_phase(type_: IntegerRange) -> None:
    station = automaton({"go": Does(start=(), when="true")}, output={"x": (type_, type_.domain[0])})
    assert list(plain_of_station(station).variables) == ["x"]


def test_transitions_keep_their_order(worked_example: Automaton) -> None:
    plain = plain_of_station(worked_example)
    written = read(efa_text(plain))
    taken: list[Transition] = list(plain_transitions(written).values())
    assert [t.name for t in taken] == [t.name for t in plain_transitions(plain).values()]
