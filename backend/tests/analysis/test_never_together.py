"""What is said never to be together is in no state that is reached; on decision diagrams it is all of that."""

from __future__ import annotations

import pytest
from hypothesis import given

from core.choices import Choices, made_by
from core.explicit import Explicit, Key
from core.random_expressions import actions
from core.random_stations import automaton as random_station
from sequence_planner.analysis.mutual_exclusion import MOST_BITS, NeverTogether, never_together
from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.tick import synchronise, writes
from sequence_planner.core.immutable import replace
from sequence_planner.language.syntax import Variable
from sequence_planner.language.types import Value
from sequence_planner.process.budget import Budget
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import SynthesisError, synthesise
from support.examples import examples
from support.places import BOLT_TIGHTENING, MODELS

PATIENCE = 60.0


def station(choices: Choices) -> Automaton:
    """A random one, in which something can be called off."""
    made = random_station(choices)
    types = {name: Variable(name, type_) for name, type_ in made.types.items()}
    written = [types[name] for kind in (Kind.OUTPUT, Kind.ESTIMATED) for name in made.names(kind)]
    everything = [types[name] for name in made.variables]
    off = {
        name: replace(ability, cancel_actions=actions(choices, written, everything, least=0))
        for name, ability in made.abilities.items()
    }
    return replace(made, abilities=off)


def reached(made: Automaton) -> frozenset[Key]:
    """Straight from the definition: without faults, restart abilities and calling off included."""
    explicit = Explicit(made)
    found, pending = {explicit.initial}, [explicit.initial]
    while pending:
        key = pending.pop()
        state = explicit.states[key]
        after = set(explicit.helpful[key])
        if key in explicit.safe:
            after |= {explicit.key(each) for each in ours(made, explicit, state)} & explicit.safe
        pending.extend(after - found)
        found |= after
    return frozenset(found)


def ours(made: Automaton, explicit: Explicit, state: State) -> list[State]:
    """What the station itself can make of a state."""
    started = [explicit.started(state, ability) for ability in made.abilities.values()]
    written = [writes(ability.cancel_actions, state) for ability in made.abilities.values()]
    called_off = [synchronise(made, {**state, **each}) for each in written if each is not None and within(made, each)]
    return [*(each for each in started if each is not None and within(made, each)), *called_off]


def within(made: Automaton, state: State) -> bool:
    return all(value in made.types[name].domain for name, value in state.items())


def pairs_of(made: Automaton, states: list[State]) -> set[tuple[str, Value | None, str, Value | None]]:
    """By looking at every state: values that occur, and not together."""
    estimates = made.names(Kind.ESTIMATED)
    others = (*made.names(Kind.MEASURED), *made.names(Kind.OUTPUT))
    together = {(e, s[e], o, s[o]) for s in states for e in estimates for o in others}
    believed = {(e, s[e]) for s in states for e in estimates}
    measured = {(o, s[o]) for s in states for o in others}
    return {(*one, *other) for one in believed for other in measured} - together


@given(made_by(station))
@examples(60)
def test_nothing_that_is_reached_is_said_to_be_never(made: Automaton) -> None:
    try:
        supervisor = synthesise(made)
    except SynthesisError:
        return
    explicit = Explicit(made)
    states = [explicit.states[key] for key in reached(made)]
    exact = never_together(made, supervisor, Budget.seconds(PATIENCE), MOST_BITS)
    coarse = never_together(made, supervisor, Budget.seconds(PATIENCE), most_bits=0)
    assert exact is not None
    assert coarse is not None
    assert exact.fits is not None
    names = exact.fits.names
    assert {tuple(state[name] for name in names) for state in states} == {
        tuple(member.values()) for member in exact.fits.members()
    }
    assert exact.pairs == pairs_of(made, states)
    assert coarse.fits is None
    assert coarse.pairs.isdisjoint((e, s[e], o, s[o]) for s in states for e in made.variables for o in made.variables)


@pytest.mark.parametrize("folder", ["bolt_tightening", "docking_agv"])
def test_both_ways_find_the_pairs_of_a_station(folder: str) -> None:
    made = prepare_station(MODELS / folder).automaton
    supervisor = synthesise(made)
    found = [never_together(made, supervisor, Budget.seconds(PATIENCE), bits) for bits in (MOST_BITS, 0)]
    exact, coarse = found
    assert isinstance(exact, NeverTogether)
    assert isinstance(coarse, NeverTogether)
    assert coarse.pairs
    assert coarse.pairs <= exact.pairs


def test_no_time_is_no_answer() -> None:
    made = prepare_station(BOLT_TIGHTENING).automaton
    assert never_together(made, synthesise(made), Budget.seconds(0.0), most_bits=0) is None
