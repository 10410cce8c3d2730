"""Meaning of a proof's clauses: what they say of a state in which goals have come so far."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import Literal, Proof
from sequence_planner.planning.sat.flag_dependencies import FollowingFlags


def asserted(state: State, goals: Goals) -> Mapping[str, Value | None]:
    """All that literals can speak of, for `goals` that have not been reached."""
    values = dict(state)
    for goal in goals:
        values |= {f"goal.{goal.name}.reached": False, f"goal.{goal.name}.at": goal.at}
    return values


def is_met(literal: Literal, values: Mapping[str, Value | None]) -> bool:
    """Return whether the literal is true of these values."""
    return (values[literal.name] == literal.value) is literal.equal


def satisfies(values: Mapping[str, Value | None], proof: Proof) -> bool:
    """Return whether the values satisfy the invariant of a proof."""
    clauses = all(any(is_met(literal, values) for literal in clause) for clause in proof.invariant)
    return clauses and (proof.conserved is None or proof.conserved.holds_in(values))


def one_of(automaton: Automaton, state: State, free: frozenset[str]) -> State:
    """One of the states like `state` in which the variables `free` have any values; flags follow what is free."""
    if not free:
        return state
    return synchronise(automaton, {**state, **{name: automaton.variables[name].type.domain[0] for name in free}})


def open_to(automaton: Automaton, free: frozenset[str]) -> frozenset[str]:
    """The variables `free`, and the flags that follow them."""
    return free | {flag.name for flag in FollowingFlags(automaton).flags(free)}
