"""Reachability queries of the model checks, and unreachability proofs over few variables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import prod

from sequence_planner.analysis.checks.relaxed_reachability import every_move
from sequence_planner.automaton.automaton import Ability, Automaton, Kind, State, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import StateSet
from sequence_planner.automaton.tick import synchronise
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import FALSE, TRUE, Assignment, Expression, conjunction
from sequence_planner.language.types import Value
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.reachability import Tracer, reachable, reaching
from sequence_planner.synthesis.supervisor import with_initial
from sequence_planner.synthesis.traces import Trace
from sequence_planner.synthesis.transition_relation import (
    MOST_BITS,
    NodeLimit,
    Plant,
    Reaction,
    TooMuchError,
    TransitionStep,
)

# A proof that a state cannot be reached, over a few variables, with everything else unknown.
#
# Measured values and all variables left out may be anything, so whatever the station reaches the abstraction reaches
# (existential abstraction: Clarke, Grumberg and Long 1994). Conditions are read with three truth values; what is not
# false for certain may be true.

MOST_STATES = 2_000
MOST_TOGETHER = 6  # finishes in one tick


def cannot_be(automaton: Automaton, predicates: Sequence[Expression]) -> bool:
    """Return whether it is certain that all `predicates` together are never seen by a finish guard in a reachable
    state.

    They are read like finish guards: over new measured values, and flags of the tick before.
    """
    own = Kind.OUTPUT, Kind.ESTIMATED
    names = [n for n in read_variables(automaton, predicates) if automaton.variables[n].kind in own]
    if prod(len(automaton.variables[name].type.domain) for name in names) > MOST_STATES:
        return False
    moves = [move for move in every_move(automaton) if move.phase is not Phase.SENSE and move.writes & set(names)]
    unknown = dict.fromkeys(automaton.types)
    pending = [{name: automaton.variables[name].initial for name in names}]
    reached = {tuple(pending[0].values())}
    while pending:
        values = pending.pop()
        state = synchronise(automaton, {**unknown, **values})
        if _forbidden(automaton, state):
            continue
        if all(_may(predicate, state) for predicate in predicates):
            return False
        enabled = [move for move in moves if _may(move.guard, state)]
        finishing = [move for move in enabled if move.phase is Phase.FINISH]
        if len(finishing) > MOST_TOGETHER:
            return False
        groups = [[move] for move in enabled if move.phase is Phase.START] + list(_subsets(finishing))
        for after in (each for group in groups for each in _outcomes(automaton, group, state, values)):
            if (key := tuple(after.values())) not in reached:
                reached.add(key)
                pending.append(after)
    return True


def _may(predicate: Expression, state: State) -> bool:
    return evaluate(predicate, state) is not False


def _forbidden(automaton: Automaton, state: State) -> bool:
    """Return whether a specification forbids the state for certain: the supervisor then keeps the station out of it."""
    return any(evaluate(each.forbidden, state) is True for each in automaton.specifications.values())


def _subsets(moves: Sequence[Transition]) -> Iterator[list[Transition]]:
    for chosen in product((False, True), repeat=len(moves)):
        if any(chosen):
            yield [move for move, taken in zip(moves, chosen, strict=True) if taken]


def _outcomes(
    automaton: Automaton, moves: Iterable[Transition], state: State, before: Mapping[str, Value]
) -> Iterator[dict[str, Value]]:
    """All values that `moves`, taken at once in `state`, could leave behind."""
    possible: dict[str, set[Value]] = {name: {value} for name, value in before.items()}
    written: dict[str, set[Value]] = {}
    for action in (action for move in moves for action in move.actions if target(action) in before):
        name, condition = target(action), True if action.condition is None else evaluate(action.condition, state)
        if condition is not False:
            values = _written(automaton, action, state)
            written[name] = written.get(name, set()) | values | (set() if condition else possible[name])
    possible |= written
    for choice in product(*possible.values()):
        yield dict(zip(possible, choice, strict=True))


def _written(automaton: Automaton, action: Assignment, state: State) -> set[Value]:
    value = evaluate(action.value, state)
    return set(automaton.variables[target(action)].type.domain) if value is None else {value}


# What a station can reach with its supervisor and without it, over all variables that a question is about.


@dataclass(frozen=True)
class Questions:
    """The questions asked of an automaton, whose supervisor keeps to the states that are `safe`."""

    automaton: Automaton
    expressions: Sequence[Expression]
    safe: StateSet

    @property
    def bearing(self) -> frozenset[str]:
        """The variables that an inquiry is over."""
        return frozenset(with_initial(self.automaton, [*_given(self.automaton), *self.expressions]))


class ReachabilityQuery:
    """An automaton over what can influence what is `asked` of it, and what is safe.

    All initial states must be safe. Raises `TooMuchError` when answers take more than `effort`. An `order` of these
    variables can be given.
    """

    def __init__(self, asked: Questions, effort: NodeLimit, order: Sequence[str] = ()) -> None:
        self._order = order
        self._questions = [*_given(asked.automaton), *asked.expressions]
        self.effort = effort
        self._reached: dict[tuple[bool, bool], Function] = {}
        self.plant = self._plant(asked.automaton)
        self.diagrams = self.plant.diagrams
        self.safe = self.diagrams.imported(asked.safe) & self.diagrams.valid

    def _plant(self, automaton: Automaton) -> Plant:
        names = with_initial(automaton, self._questions)
        if bits(automaton, names) > MOST_BITS:
            raise TooMuchError
        return Plant(automaton, names, self._order if set(self._order) == set(names) else None)

    def reached(
        self, target: Function, *, supervised: bool = True, faults: bool = True, goal: Expression | None = None
    ) -> Function:
        """Those states of `target` that are reached with or without the supervisor, and counting on faults or not.

        A plan for `goal` may show that some of them are.
        """
        if not faults and self.plant.helpful is self.plant.uncontrollable:
            faults = True
        if (supervised, faults) not in self._reached:
            uncontrollable = self.plant.uncontrollable if faults else self.plant.helpful
            steps = self.limited(self.plant, uncontrollable)
            within = self.safe if supervised else None
            self._reached[supervised, faults] = reachable(self.diagrams, self.plant.initial, steps, within)
        return target & self._reached[supervised, faults]

    def way(self, target: Function, *, supervised: bool = True, faults: bool = True) -> Trace | None:
        """The shortest run to some of `target`; None if there is none, or it takes too long to find."""
        return Tracer(self.plant, faults=faults, within=self.safe if supervised else None).shortest(target)

    def stuck(self, active: Function, goal: Function) -> Function:
        """Reached states of `active` from which `goal` cannot be brought about; all of them, or at least some."""
        return self.reached(active) & ~self._completing(goal, self.safe)

    def leads(self, states: Function, goal: Function) -> bool | None:
        """Return whether `goal` can be reached from `states` without faults, the supervisor not asked; None if
        unknown.
        """
        steps = self.limited(self.plant, self.plant.helpful)
        return (states & reaching(self.diagrams, goal, steps)).satisfiable()

    def limited(self, plant: Plant, uncontrollable: Iterable[TransitionStep]) -> list[TransitionStep]:
        """These steps and all starts, which raise `TooMuchError` when all effort is spent."""
        return self.effort.limited([*uncontrollable, *plant.all_starts])

    def _completing(self, goal: Function, within: Function) -> Function:
        """The states of `within` in which `goal` holds, or can be brought about so that a tick sees it."""
        steps = self.limited(self.plant, self.plant.helpful)
        return reaching(self.diagrams, self.seen(goal, within), steps, within) | (goal & within)

    def seen(self, goal: Function, within: Function) -> Function:
        """The states of `within` in which a tick can begin that sees `goal`; without ticks, in which it holds."""
        ticks = [step for step in self.plant.helpful if isinstance(step, Reaction)]
        if self.plant.automaton.one_at_a_time or not ticks:  # nothing changes in a tick
            return goal & within
        return self.diagrams.disjunction(tick.before(goal & within) for tick in ticks) & within

    def may_start(self, ability: Ability) -> Function:
        """The states in which what is written lets it start."""
        return self.plant.where(conjunction(ability.enabled, ability.start_guard))

    def allowed(self, ability: Ability) -> Function:
        """The safe states in which it may start under the supervisor."""
        if ability.name not in self.plant.starts:
            return self.may_start(ability) & self.safe
        steps = self.plant.starts[ability.name]
        return self.diagrams.disjunction(step.before(self.safe) for step in steps) & self.safe

    def forbidden(self) -> dict[str, Function]:
        """Return what each specification forbids."""
        return {each.name: self.plant.where(each.forbidden) for each in self.plant.automaton.specifications.values()}

    def broken_unasked(self, states: Function) -> list[str]:
        """The specifications that can be broken from `states` on without any start."""
        steps = self.effort.limited(self.plant.uncontrollable)
        reached = reachable(self.diagrams, states, steps)
        return [name for name, where in self.forbidden().items() if (where & reached).satisfiable()]

    def unbroken_unasked(self, states: Function) -> bool:
        """Return whether from some of `states` on no specification can be broken without any start."""
        broken = self.diagrams.disjunction(self.forbidden().values())
        return (states & ~reaching(self.diagrams, broken, self.effort.limited(self.plant.uncontrollable))).satisfiable()

    @cached_property
    def ever(self) -> tuple[Plant, Function]:
        """All that may be reached by any means, on a plant of its own."""
        automaton = _with_every_move(self.plant.automaton)
        plant = self._plant(automaton)
        return plant, self._closed(plant)

    def _closed(self, plant: Plant) -> Function:
        """Return what is reached in `plant`, with all that can happen in it."""
        return reachable(plant.diagrams, plant.initial, self.limited(plant, plant.uncontrollable))

    def may_ever(self, predicate: Expression) -> bool:
        """Return whether it holds in any state that may be reached: also restarted, called off, or with a new
        product.
        """
        plant, reached = self.ever
        return (plant.where(predicate) & reached).satisfiable()


def bits(automaton: Automaton, names: Iterable[str]) -> int:
    """Return how many bits there are in the values of `names`."""
    return sum((len(automaton.variables[name].type.domain) - 1).bit_length() for name in names)


def _given(automaton: Automaton) -> list[Expression]:
    """Return what every inquiry is about: what is safe."""
    rest = TRUE if automaton.rest is None else automaton.rest
    return [*(each.forbidden for each in automaton.specifications.values()), rest]


def _with_every_move(automaton: Automaton) -> Automaton:
    """`automaton` in which abilities for restarts are like others, and so is all else that changes variables."""
    known = {each.name for each in transitions(automaton)}
    others = {each.name: _ability(each) for each in every_move(automaton) if each.name not in known}
    abilities = {name: replace(ability, restart=False) for name, ability in automaton.abilities.items()}
    return replace(automaton, abilities={**abilities, **others})


def _ability(move: Transition) -> Ability:
    return Ability(move.name, "", move.name, TRUE, move.guard, move.actions, FALSE, FALSE, None, ())
