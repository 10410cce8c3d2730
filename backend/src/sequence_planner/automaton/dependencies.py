"""Variable dependencies: the cone of influence of a query, and the evaluation order of flags."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Flag, Kind, reads, target
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.language.syntax import Assignment, Constant, Expression, Variable, variables
from sequence_planner.language.types import Value

# What people do themselves, and what is noted of it then.


def tasks_for(automaton: Automaton) -> Mapping[tuple[str, Value], Ability]:
    """Return for each value that an estimate gets once a person has done a task the ability that has them do it."""
    found: dict[tuple[str, Value], Ability] = {}
    for ability in automaton.abilities.values():
        if ability.human is not None and not ability.restart:
            for action in ability.finish_actions:
                name = target(action)
                if automaton.variables[name].kind is Kind.ESTIMATED and isinstance(action.value, Constant):
                    found.setdefault((name, action.value.value), ability)
    return found


# The variables that matter to a question: those its predicates read, and all that decides how these are written.


def read_variables(automaton: Automaton, expressions: Iterable[Expression]) -> frozenset[str]:
    """The variables that `expressions` read, with each flag replaced by what its predicate reads."""
    pending = [name for expression in expressions for name in variables(expression)]
    found = set(pending)
    if found <= automaton.variables.keys():
        return frozenset(found)
    found.clear()
    seen: set[str] = set()
    while pending:
        name = pending.pop()
        if name in seen:
            continue
        seen.add(name)
        if name in automaton.variables:
            found.add(name)
        else:
            pending.extend(variables(automaton.flag_predicates[name]))
    return frozenset(found)


def cone_of_influence(automaton: Automaton, questions: Iterable[Expression]) -> tuple[str, ...]:
    """The variables that can influence `questions` without restart abilities, in order of declaration.

    The automaton restricted to them answers the questions as the whole does: whatever writes one of them depends on
    them alone, and so does whether two effects, or two finishes, are compatible.
    """
    counted = [transition for transition in transitions(automaton) if not transition.restart]
    phases = {phase: [t for t in counted if t.phase is phase] for phase in Phase}
    relevant = set(read_variables(automaton, questions))
    while True:
        before = len(relevant)
        for phase, members in phases.items():
            inside = [transition for transition in members if not transition.writes.isdisjoint(relevant)]
            for transition in inside:
                relevant |= read_variables(automaton, (transition.guard,))
                for action in transition.actions:
                    if target(action) in relevant:
                        relevant |= _read_by(automaton, action)
            if automaton.one_at_a_time:
                continue  # no two are ever taken together
            if phase is Phase.SENSE:
                # Without an effect from outside the one inside can still happen, so only these can stand in its way.
                relevant |= _disputed(automaton, _sharing(inside, inside), relevant)
            elif phase is Phase.FINISH:
                # A finish is refused by any other that it conflicts with, also by one that writes nothing relevant.
                relevant |= _disputed(automaton, _sharing(inside, members), relevant)
        if len(relevant) == before:
            return tuple(name for name in automaton.variables if name in relevant)


def _read_by(automaton: Automaton, action: Assignment) -> frozenset[str]:
    condition = () if action.condition is None else (action.condition,)
    return read_variables(automaton, (action.value, *condition))


def _sharing(some: Iterable[Transition], others: Iterable[Transition]) -> Iterator[tuple[Transition, Transition]]:
    """The pairs of one of `some` and one of `others` that write common variables."""
    writers: dict[str, list[Transition]] = defaultdict(list)
    for other in others:
        for name in other.writes:
            writers[name].append(other)
    return ((one, other) for one in some for name in one.writes for other in writers[name])


def _disputed(
    automaton: Automaton, pairs: Iterable[tuple[Transition, Transition]], relevant: set[str]
) -> frozenset[str]:
    """Further variables over which two transitions of one phase could conflict; conflicts decide what is applied."""
    found: set[str] = set()
    for one, other in pairs:
        if one is other:
            continue
        writes_first = {target(action): action for action in one.actions}
        writes_second = {target(action): action for action in other.actions}
        shared = [n for n in writes_first if n in writes_second]
        if any(n in relevant and _always_differ(writes_first[n], writes_second[n]) for n in shared):
            continue  # never applied together, which the relevant variables already show
        for name in shared:
            if name not in relevant and not _always_equal(writes_first[name], writes_second[name]):
                found |= {name, *reads(writes_first[name]), *reads(writes_second[name])} & set(automaton.variables)
    return frozenset(found)


def _possible(action: Assignment) -> frozenset[Value]:
    if isinstance(action.value, Constant):
        return frozenset({action.value.value})
    if isinstance(action.value, Variable):
        return frozenset(action.value.type.domain)
    assert isinstance(action.target, Variable)
    return frozenset(action.target.type.domain)


def _always_differ(one: Assignment, other: Assignment) -> bool:
    unconditional = one.condition is None and other.condition is None
    return unconditional and not _possible(one) & _possible(other)


def _always_equal(one: Assignment, other: Assignment) -> bool:
    return one.value == other.value and isinstance(one.value, Constant | Variable)


# What depends on what: the order of flags.


def ordered_flags(flags: Sequence[Flag]) -> tuple[tuple[Flag, ...], tuple[str, ...]]:
    """The flags in an order in which none reads a later one, and a circle of names if there is no such order."""
    by_name = {flag.name: flag for flag in flags}
    graph = {flag.name: [read for read in variables(flag.predicate) if read in by_name] for flag in flags}
    try:
        order = tuple(TopologicalSorter(graph).static_order())
    except CycleError as error:
        return tuple(flags), tuple(error.args[1])
    return tuple(by_name[name] for name in order), ()


def reactions(automaton: Automaton, ability: str) -> list[Effect]:
    """The effects that are written with an ability."""
    effects = {effect.name: effect for effect in automaton.effects}
    return [effects[name] for name in automaton.reactions.get(ability, ())]


def looked_at(ability: Ability, name: str) -> Iterator[Expression]:
    """Yield what the ability looks at when it writes the variable."""
    starts = [action for action in ability.start_actions if target(action) == name]
    finishes = [action for action in ability.finish_actions if target(action) == name]
    if starts:
        yield from (ability.enabled, ability.start_guard)
    if finishes and ability.finish_guard is not None:
        yield ability.finish_guard
    for action in (*starts, *finishes):
        yield action.value
        if action.condition is not None:
            yield action.condition


# Changes that every device makes along with something else, so that nobody has to be told of them too: a variable that
# remembers where a robot has been last becomes what the pose becomes.


def is_along(automaton: Automaton, name: str, others: Collection[str]) -> bool:
    """Return whether nothing gives the variable a value but together with one of the others, which can change alone."""
    return any(_comes_with(automaton, name, other) for other in others)


def _comes_with(automaton: Automaton, name: str, other: str) -> bool:
    writes = [{target(action): action.value for action in effect.actions} for effect in automaton.effects]
    both = [each for each in writes if name in each]
    alone = any(other in each and name not in each for each in writes)
    return name != other and alone and bool(both) and all(each.get(other) == each[name] for each in both)
