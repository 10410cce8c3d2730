"""Traces held against the reference: each step must be one that can be taken, with exactly the outcome it shows."""

from __future__ import annotations

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.tick import (
    apply_effects,
    finish,
    record_activity,
    start,
    start_guard_holds,
    synchronise,
    writes,
)
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import TRUE
from sequence_planner.synthesis.traces import StepKind, Trace, TraceStep, forbidding


def replay(automaton: Automaton, trace: Trace) -> list[State]:
    """The states of `trace`, from an initial one on; raises AssertionError where it does not replay."""
    state = trace.initial
    assert state == synchronise(automaton, state)
    if automaton.initial is None:
        assert all(state[name] == variable.initial for name, variable in automaton.variables.items())
    else:
        assert holds(automaton.initial or TRUE, state)
    assert trace.forbidden_by == forbidding(automaton, state)
    states = [state]
    for each in trace.steps:
        after = taken(automaton, state, each)
        assert after == each.state
        assert each.changes == {n: after[n] for n in automaton.variables if after[n] != state[n]}
        assert each.forbidden_by == forbidding(automaton, after)
        states.append(after)
        state = after
    return states


def taken(automaton: Automaton, state: State, each: TraceStep) -> State:
    """The state after one step, on the reference."""
    match each.kind:
        case StepKind.TRANSITION:
            after = step(state, plain_transitions(automaton)[each.names[0]])
            assert after is not None
            return after
        case StepKind.START:
            ability = automaton.abilities[each.names[0]]
            assert start_guard_holds(ability, state)
            started = start(automaton, state, ability)
            assert started is not None
            return started
        case StepKind.ACTIVITY:
            active = {o.name for o in automaton.operations.values() if state.get(o.activity) is True}
            return record_activity(automaton, state, frozenset(active ^ {each.names[0]}))
        case StepKind.TICK:
            effects = {effect.name: effect for effect in automaton.effects}
            sensed = apply_effects(state, [effects[name] for name in each.names])
            assert sensed is not None
            finishing = finish(automaton, sensed)
            assert set(each.finished) <= set(finishing.finished)
            for name in set(finishing.finished) - set(each.finished):  # nobody would miss them
                assert not state[f"{name}.executing"]
                assert {**sensed, **(writes(automaton.abilities[name].finish_actions, sensed) or {})} == sensed
            return synchronise(automaton, finishing.state)
