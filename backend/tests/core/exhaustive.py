"""Whether goals can be reached at all, by visiting every state that runs on the reference tick lead to."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import product

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import supervised_start, synchronise
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.problem import Circumstances

from .breadth_first import may_start, permitted
from .explicit import outcomes


def can_reach(
    automaton: Automaton, supervisor: Supervisor, states: Iterable[State], goals: Goals, circumstances: Circumstances
) -> bool:
    """Whether a run of one tick or more leads from one of `states` to all `goals`."""
    helpful = [e for e in automaton.effects if not e.fault and e.resource not in circumstances.offline]
    pending = [(state, goals) for state in states]
    seen = {_key(*node) for node in pending}
    while pending:
        before, wanted = pending.pop()
        for after in outcomes(automaton, before, helpful):
            left = settled(wanted, after)
            if left is None or not permitted(after, circumstances):
                continue
            if not left:
                return True
            for end in _ends(automaton, supervisor, before, after, left, circumstances):
                if _key(*end) not in seen:
                    seen.add(_key(*end))
                    pending.append(end)
    return False


def alike(automaton: Automaton, state: State, free: Iterable[str]) -> Iterator[State]:
    """The states like `state`, none of whose values is unknown, with any values of the variables `free`."""
    names = list(free)
    for values in product(*(automaton.variables[name].type.domain for name in names)):
        yield synchronise(automaton, {**state, **dict(zip(names, values, strict=True))})


def _ends(
    automaton: Automaton,
    supervisor: Supervisor,
    published: State,
    state: State,
    goals: Goals,
    circumstances: Circumstances,
) -> Iterator[tuple[State, Goals]]:
    """Every way in which the tick can end after step 3 has led to `state`."""
    abilities = [ability for ability in automaton.abilities.values() if may_start(ability, circumstances)]
    pending = [(state, goals, frozenset[str]())]
    seen = {(_key(state, goals), frozenset[str]())}
    while pending:
        current, wanted, taken = pending.pop()
        yield current, wanted
        for ability in abilities:
            after = supervised_start(automaton, supervisor, published, current, ability)
            left = None if after is None else moved(wanted, after)
            if after is None or left is None or ability.name in taken or not permitted(after, circumstances):
                continue
            now = taken | {ability.name}
            if (_key(after, left), now) not in seen:
                seen.add((_key(after, left), now))
                pending.append((after, left, now))


def _key(state: State, goals: Goals) -> object:
    return (tuple(state.values()), goals)
