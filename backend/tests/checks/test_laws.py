"""On random small stations: what the checks say, against all that the reference tick can reach."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from itertools import combinations, product

from hypothesis import assume, given

from core import random_stations
from core.choices import made_by
from sequence_planner.analysis.checks.guards import MOST_REPORTED, check_conflicts
from sequence_planner.analysis.checks.relaxed_reachability import Growth
from sequence_planner.analysis.checks.warning import parts
from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.tick import (
    apply_effects,
    effect_writes,
    finish,
    initial_state,
    start,
    start_guard_holds,
    synchronise,
)
from sequence_planner.automaton.transitions import Phase, transitions
from sequence_planner.language.evaluator import holds
from support.examples import examples

PAIR = re.compile(r"the finishes of `(\w+)` and `(\w+)` would write different values to `(\w+)`.* They (\w+) ")


def sensed(automaton: Automaton, state: State) -> Iterator[State]:
    """What finish guards may see after `state`."""
    enabled = [effect for effect in automaton.effects if effect_writes(effect, state) is not None]
    for size in range(len(enabled) + 1):
        for chosen in combinations(enabled, size):
            if (after := apply_effects(state, chosen)) is not None:
                yield after


def reached(automaton: Automaton) -> list[State]:
    """All states that are reached with no start of a restart ability and none that is forbidden on the way."""
    pending, found = [initial_state(automaton)], {}
    while pending:
        state = pending.pop()
        key = tuple(state.items())
        if key in found or any(holds(each.forbidden, state) for each in automaton.specifications.values()):
            continue
        found[key] = state
        pending += [synchronise(automaton, finish(automaton, each).state) for each in sensed(automaton, state)]
        for ability in automaton.abilities.values():
            if not ability.restart and start_guard_holds(ability, state):
                after = start(automaton, state, ability)
                assert after is not None
                pending.append(after)
        activities = automaton.names(Kind.ACTIVITY)
        for active in product((False, True), repeat=len(activities)):
            pending.append(synchronise(automaton, {**state, **dict(zip(activities, active, strict=True))}))
    return list(found.values())


@examples(150)
@given(made_by(random_stations.automaton))
def test_the_conflicts_reported_are_those_that_are_reached(automaton: Automaton) -> None:
    states = reached(automaton)
    assume(states)
    real: dict[str, set[frozenset[str]]] = defaultdict(set)
    for state in states:
        for each in sensed(automaton, state):
            for one, other, variable in finish(automaton, each).conflicts:
                real[variable].add(frozenset((one, other)))
    said: dict[str, set[frozenset[str]]] = defaultdict(set)
    for warning in check_conflicts(automaton):
        match = PAIR.search(warning.message)
        assert match is not None
        assert match[4] == "meet"  # they are so small that all states are looked at
        said[match[3]].add(frozenset((match[1], match[2])))
    assert all(said[variable] <= real[variable] for variable in said)
    if all(len(pairs) <= MOST_REPORTED for pairs in real.values()):
        assert set().union(*said.values()) == set().union(*real.values())


@examples(150)
@given(made_by(random_stations.automaton))
def test_what_comes_about_is_never_said_not_to(automaton: Automaton) -> None:
    growths = [Growth(automaton, any_measurement=True), Growth(automaton, any_measurement=False)]
    for state in reached(automaton):
        for part in parts(automaton):
            if not part.old_flags and holds(part.expression, state):
                assert all(growth.may(part.expression) for growth in growths)
        for each in sensed(automaton, state):
            for transition in transitions(automaton):
                if transition.phase is Phase.FINISH and holds(transition.guard, each):
                    assert all(growth.may(transition.guard) for growth in growths)
