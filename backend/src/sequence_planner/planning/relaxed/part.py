"""The part of an automaton that is left when most variables are frozen: what writes the others, and no more."""

from __future__ import annotations

from collections.abc import Iterable, Set
from dataclasses import replace

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State, reads, target
from sequence_planner.automaton.transitions import Phase
from sequence_planner.expressions.syntax import Assignment, Constant, Expression, variables
from sequence_planner.planning.relaxed.relevance import Relevance

_FLAGS = ("enabled", "executing", "finished")


def part_of(
    automaton: Automaton,
    supervisor: Supervisor,
    relevance: Relevance,
    state: State,
    loose: Set[str],
    asked: Iterable[Expression],
) -> Automaton:
    """`automaton` without what would change another variable in `state` than those `loose`, and without the flags and
    variables that nothing of it, of the supervisor or of what is `asked` then reads.
    """

    def kept(*actions: Assignment) -> bool:
        return all(target(action) in loose or _idle(action, state) for action in actions)

    writing = relevance.writing(loose)
    names = dict.fromkeys(move.name.rpartition(".")[0] for move in writing if move.phase is not Phase.SENSE)
    found = (automaton.abilities[name] for name in automaton.abilities if name in names)
    abilities = {each.name: each for each in found if kept(*each.start_actions, *each.finish_actions)}
    happening = {move.name for move in writing if move.phase is Phase.SENSE}
    effects = tuple(each for each in automaton.effects if each.name in happening and kept(*each.actions))

    read = {name for expression in asked for name in variables(expression)} | set(supervisor.safe.names)
    for ability in abilities.values():
        predicates = (ability.enabled, ability.start_guard, ability.finish_guard)
        read.update(name for each in predicates if each is not None for name in variables(each))
        read.update(name for each in (*ability.start_actions, *ability.finish_actions) for name in reads(each))
        read.update(ability.flag(which) for which in _FLAGS)
        read.update(() if (guard := supervisor.guards.get(ability.name)) is None else guard.names)
    for effect in effects:
        read.update((*variables(effect.guard), *(name for each in effect.actions for name in reads(each))))
    known = _with_flags(automaton, read) | loose
    return replace(
        automaton,
        variables={name: automaton.variables[name] for name in automaton.variables if name in known},
        abilities=abilities,
        effects=effects,
        flags=tuple(flag for flag in automaton.flags if flag.name in known),
    )


def _with_flags(automaton: Automaton, names: Iterable[str]) -> set[str]:
    """With all that flags among `names` depend on."""
    predicates, found, pending = automaton.flag_predicates, set[str](), list(names)
    while pending:
        name = pending.pop()
        if name not in found:
            found.add(name)
            if name in predicates:
                pending.extend(variables(predicates[name]))
    return found


def _idle(action: Assignment, state: State) -> bool:
    """Whether the action leaves the variable as it is in `state`; what is unknown stays so."""
    value = state[target(action)]
    return value is None or action.value == Constant(value)
