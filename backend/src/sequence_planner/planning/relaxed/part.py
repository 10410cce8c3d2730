"""The part of an automaton that is left when most variables are frozen: what writes the others, and no more."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State, VariableDeclaration, reads, target
from sequence_planner.automaton.transitions import Phase
from sequence_planner.expressions.syntax import TRUE, Assignment, Constant, Expression, variables
from sequence_planner.expressions.types import EnumerationType
from sequence_planner.immutable import replace
from sequence_planner.planning.relaxed.relevance import Relevance
from sequence_planner.planning.relaxed.usefulness import useful, written_by


def part_of(
    automaton: Automaton,
    supervisor: Supervisor,
    relevance: Relevance,
    state: State,
    loose: Set[str],
    asked: Iterable[Expression],
    serving: Iterable[str] | None = None,
) -> Automaton:
    """`automaton` without what would change another variable in `state` than those `loose`, and without the flags and
    variables that nothing of it, of the supervisor or of what is `asked` then reads.

    With `serving`, names of abilities and effects, also without what is of no use to these.
    """

    def kept(*actions: Assignment) -> bool:
        return all(target(action) in loose or _idle(action, state) for action in actions)

    writing = relevance.writing(loose)
    names = dict.fromkeys(move.name.rpartition(".")[0] for move in writing if move.phase is not Phase.SENSE)
    found = (automaton.abilities[name] for name in automaton.abilities if name in names)
    abilities = {each.name: each for each in found if kept(*each.start_actions, *each.finish_actions)}
    happening = {move.name for move in writing if move.phase is Phase.SENSE}
    effects = tuple(each for each in automaton.effects if each.name in happening and kept(*each.actions))

    part = replace(automaton, abilities=abilities, effects=effects)
    if serving is not None:
        part = useful(part, serving, asked)
    read = [*_read(part, supervisor), *(name for each in asked for name in variables(each))]
    if None in state.values():  # the flag that an ability is enabled is then more than its predicate
        read += (ability.flag("enabled") for ability in part.abilities.values())
    known = _with_flags(automaton, read)
    return replace(
        part,
        variables=_narrowed(part, state, known | loose),
        flags=tuple(flag for flag in automaton.flags if flag.name in known),
    )


def _read(part: Automaton, supervisor: Supervisor) -> Iterator[str]:
    """What its abilities and effects read, and what the supervisor reads of them."""
    yield from supervisor.safe.names
    for ability in part.abilities.values():
        for predicate in (ability.enabled, ability.start_guard, ability.finish_guard or TRUE):
            yield from variables(predicate)
        for action in (*ability.start_actions, *ability.finish_actions):
            yield from reads(action)
        if (guard := supervisor.guards.get(ability.name)) is not None:
            yield from guard.names
    for effect in part.effects:
        yield from variables(effect.guard)
        for action in effect.actions:
            yield from reads(action)


def _narrowed(part: Automaton, state: State, names: Set[str]) -> dict[str, VariableDeclaration]:
    """The variables `names` and all that are written.

    Those of enumerations are without the values that they do not have and that nothing in `part` gives them.
    """
    values = written_by(part)
    narrowed: dict[str, VariableDeclaration] = {}
    for name, variable in part.variables.items():
        if name in names or name in values:
            if isinstance(variable.type, EnumerationType):
                possible = tuple(v for v in variable.type.values if v == state[name] or v in values[name])
                variable = replace(variable, type=EnumerationType(possible))
            narrowed[name] = variable
    return narrowed


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
