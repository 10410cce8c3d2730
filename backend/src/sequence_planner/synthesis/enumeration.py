"""The supervisor by explicit enumeration of all states of the variables that matter.

The safe set is the greatest set without forbidden states that the environment cannot leave, and from each state of
which a state of rest can be reached inside it, without faults and without restart abilities.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import prod

import numpy as np

from sequence_planner.automaton.cone import cone_of_influence, read_variables
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, target
from sequence_planner.expressions.printing import print_value
from sequence_planner.expressions.syntax import TRUE, Expression, conjunction, conjuncts, variables
from sequence_planner.synthesis.plant import Indices, Plant, Steps
from sequence_planner.synthesis.vectorised import Mask

MOST_STATES = 4_000_000


class SynthesisError(Exception):
    """There is no supervisor, or it cannot be computed this way; the text says why and what to do."""


class TooManyStatesError(SynthesisError):
    """There may be a supervisor, but there are too many states to enumerate."""


@dataclass(frozen=True)
class Enumeration:
    """All states with their steps, and what follows from them. `initial` has at least one state."""

    plant: Plant
    forbidden: Mask
    safe: Mask
    uncontrollable: Steps
    starts: dict[str, Steps]
    initial: Indices

    def reachable(self, supervised: bool) -> Mask:
        """The states that the station can reach from its initial states, with or without its supervisor."""
        steps = [self.uncontrollable]
        for start in self.starts.values():
            allowed = self.safe[start.source] & self.safe[start.target] if supervised else slice(None)
            steps.append(Steps(start.source[allowed], start.target[allowed]))
        reached: Mask = np.zeros(self.plant.size, dtype=np.bool_)
        reached[self.initial] = True
        return _closure(reached, steps, forward=True)


def synthesise(automaton: Automaton) -> Supervisor:
    """The maximally permissive supervisor of `automaton`. Raises `SynthesisError` if there is none."""
    found = enumerate_states(automaton)
    plant = found.plant
    if not found.safe[found.initial].all():
        raise SynthesisError(_why_unsatisfiable(automaton, found))
    safe = StateSet(plant.names, plant.domains, found.safe.reshape(plant.shape))
    guards: dict[str, StateSet] = {}
    for name, start in found.starts.items():
        allowed = np.ones(plant.size, dtype=np.bool_)
        allowed[start.source] = found.safe[start.target]
        care = np.zeros(plant.size, dtype=np.bool_)
        care[start.source] = found.safe[start.source]
        guard = StateSet(plant.names, plant.domains, allowed.reshape(plant.shape)).reduced(care.reshape(plant.shape))
        if not guard.table.all():
            guards[name] = guard
    return Supervisor(safe, guards)


def enumerate_states(automaton: Automaton) -> Enumeration:
    """Enumerate the states of the variables that matter to the specifications and to rest, and solve for the safe set.

    Raises `TooManyStatesError` when there are more than `MOST_STATES`.
    """
    rest = automaton.rest if automaton.rest is not None else TRUE
    forbidden_predicates = [specification.forbidden for specification in automaton.specifications.values()]
    names = _relevant(automaton, [*forbidden_predicates, rest])
    states = prod(len(automaton.variables[name].type.domain) for name in names)
    if states > MOST_STATES:
        raise TooManyStatesError(
            f"the specifications depend on {len(names)} variables with {states} states together; explicit "
            f"enumeration ends at {MOST_STATES}: let fewer or smaller variables bear on the specifications"
        )
    plant = Plant(automaton, names)
    forbidden: Mask = np.zeros(plant.size, dtype=np.bool_)
    for predicate in forbidden_predicates:
        forbidden |= plant.where(predicate)
    starts = {ability.name: plant.starts(ability) for ability in _startable(automaton, names)}
    uncontrollable = plant.uncontrollable(faults=True)
    helpful = uncontrollable
    if any(effect.fault for effect in automaton.effects):
        helpful = plant.uncontrollable(faults=False)
    safe = _greatest_safe(forbidden, plant.where(rest), uncontrollable, helpful, list(starts.values()))
    return Enumeration(plant, forbidden, safe, uncontrollable, starts, _initial(automaton, plant))


def _relevant(automaton: Automaton, questions: list[Expression]) -> tuple[str, ...]:
    """The variables that can influence `questions`, and those that several initial states relate them to."""
    names = cone_of_influence(automaton, questions)
    for part in conjuncts(automaton.initial or TRUE):
        read = frozenset(variables(part))
        if not read <= set(names) and not read.isdisjoint(names):
            return _relevant(automaton, [*questions, part])
    return names


def _initial(automaton: Automaton, plant: Plant) -> Indices:
    """The initial states. What is said of variables outside the plant says nothing about those inside."""
    if automaton.initial is None:
        return np.array([plant.index({name: automaton.variables[name].initial for name in plant.names})])
    inside = [part for part in conjuncts(automaton.initial) if set(variables(part)) <= set(plant.names)]
    return np.flatnonzero(plant.where(conjunction(*inside))).astype(np.int64)


def reachable_states(automaton: Automaton, names: Sequence[str]) -> tuple[Plant, Mask]:
    """All states over `names`, a cone of influence, and which of them the station may reach under its supervisor.

    Of the supervisor no more is used than that it keeps the station out of what specifications over `names` forbid.
    Any operation may be active at any time, as nothing here decides that.
    """
    plant = Plant(automaton, names)
    allowed: Mask = np.ones(plant.size, dtype=np.bool_)
    for specification in automaton.specifications.values():
        if read_variables(automaton, (specification.forbidden,)) <= set(names):
            allowed &= ~plant.where(specification.forbidden)
    steps = [plant.uncontrollable(faults=True), *map(plant.starts, _startable(automaton, names))]
    steps = [_inside(each, allowed) for each in steps]
    reached: Mask = np.zeros(plant.size, dtype=np.bool_)
    reached[_initial(automaton, plant)] = True
    return plant, _closure(reached, steps, forward=True)


def _startable(automaton: Automaton, names: Sequence[str]) -> list[Ability]:
    """The abilities whose start writes some of the variables `names`, a cone of influence."""
    return [
        ability
        for ability in automaton.abilities.values()
        if not ability.restart
        and any(target(action) in names for action in ability.start_actions)
        and read_variables(automaton, (ability.enabled, ability.start_guard)) <= set(names)
    ]


def _greatest_safe(forbidden: Mask, rest: Mask, uncontrollable: Steps, helpful: Steps, starts: Sequence[Steps]) -> Mask:
    safe = ~forbidden
    while True:
        outside = _closure(~safe, [uncontrollable], forward=False)
        inside = ~outside
        within = [_inside(steps, inside) for steps in (helpful, *starts)]
        after = _closure(rest & inside, within, forward=False)
        if (after == safe).all():
            return safe
        safe = after


def _inside(steps: Steps, states: Mask) -> Steps:
    kept = states[steps.source] & states[steps.target]
    return Steps(steps.source[kept], steps.target[kept])


def _closure(states: Mask, steps: Sequence[Steps], forward: bool) -> Mask:
    """`states` and all that can be reached from them, or that can reach them."""
    source = np.concatenate([s.source for s in steps])
    target = np.concatenate([s.target for s in steps])
    if not forward:
        source, target = target, source
    closed = states.copy()
    while True:
        new = target[closed[source] & ~closed[target]]
        if not len(new):
            return closed
        closed[new] = True


def _why_unsatisfiable(automaton: Automaton, found: Enumeration) -> str:
    """The shortest way into trouble that no start could prevent, in the model's names."""
    unsafe = found.initial[~found.safe[found.initial]]
    trace = _shortest(found.plant.size, unsafe, found.uncontrollable, found.forbidden)
    if trace is None:
        if automaton.one_at_a_time:
            begin = ", ".join(f"{n} = {print_value(v)}" for n, v in found.plant.state(int(unsafe[0])).items())
            return (
                "the forbidden states cannot be avoided together with reaching a marked state: none can be reached "
                f"safely from the initial state with {begin}. Check `marked`, `forbidden` and what is uncontrollable"
            )
        return (
            "the specifications cannot be met together with reaching rest: from the initial state no state described "
            "by `rest` in station.yaml can be reached safely. Check `rest`, the effects and the forbidden states"
        )
    broken = [
        specification.name
        for specification in automaton.specifications.values()
        if found.plant.where(specification.forbidden)[trace[-1]]
    ]
    steps = [found.plant.state(index) for index in trace]
    unit = "step" if automaton.one_at_a_time else "tick"
    lines = [f"specification {', '.join(broken)} cannot be met: no start could prevent this from the initial state on"]
    for number, (before, after) in enumerate(pairwise(steps), start=1):
        changes = ", ".join(f"{n} := {print_value(v)}" for n, v in after.items() if before[n] != v)
        lines.append(f"  {unit} {number}: {changes}")
    lines.append("  violated with " + ", ".join(f"{n} = {print_value(v)}" for n, v in steps[-1].items()))
    return "\n".join(lines)


def _shortest(size: int, starts: Indices, steps: Steps, goal: Mask) -> list[int] | None:
    parent = np.full(size, -1, dtype=np.int64)
    parent[starts] = starts
    frontier = starts
    while len(frontier):
        if goal[frontier].any():
            path = [int(frontier[goal[frontier]][0])]
            while parent[path[-1]] != path[-1]:
                path.append(int(parent[path[-1]]))
            return path[::-1]
        leaving = np.isin(steps.source, frontier) & (parent[steps.target] < 0)
        parent[steps.target[leaving]] = steps.source[leaving]
        frontier = np.unique(steps.target[leaving])
    return None
