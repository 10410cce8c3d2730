"""What a station can reach with its supervisor and without it, over all variables that a question is about."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cached_property

from sequence_planner.automaton.state_set import StateSet
from sequence_planner.automaton.structure import Ability, Automaton
from sequence_planner.automaton.transitions import Transition, transitions
from sequence_planner.checking.growth import every_move
from sequence_planner.expressions.syntax import FALSE, TRUE, Expression, conjunction
from sequence_planner.synthesis.diagrams import Function
from sequence_planner.synthesis.effort import MOST_BITS, Effort, TooMuchError
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.reaction import Reaction
from sequence_planner.synthesis.saturation import reachable, reaching
from sequence_planner.synthesis.steps import Step
from sequence_planner.synthesis.supervision import with_initial


class Inquiry:
    """An automaton over what can influence `questions` and `safe`, the states that its supervisor keeps to.

    All initial states must be safe. Raises `TooMuchError` when answers take more than `effort`.
    """

    def __init__(self, automaton: Automaton, questions: Iterable[Expression], safe: StateSet, effort: Effort) -> None:
        self._questions = [*_given(automaton), *questions]
        self._effort = effort
        self.plant = self._plant(automaton)
        self.diagrams = self.plant.diagrams
        self.safe = self.diagrams.imported(safe) & self.diagrams.valid

    def _plant(self, automaton: Automaton) -> Plant:
        names = with_initial(automaton, self._questions)
        if bits(automaton, names) > MOST_BITS:
            raise TooMuchError
        return Plant(automaton, names)

    @cached_property
    def supervised(self) -> Function:
        """What is reached under the supervisor."""
        return self._reachable(self.plant.uncontrollable, self.safe)

    @cached_property
    def unsupervised(self) -> Function:
        """What is reached without it."""
        return self._reachable(self.plant.uncontrollable)

    @cached_property
    def supervised_without_faults(self) -> Function:
        """What can be counted on to be reached under the supervisor."""
        if self.plant.helpful is self.plant.uncontrollable:
            return self.supervised
        return self._reachable(self.plant.helpful, self.safe)

    @cached_property
    def unsupervised_without_faults(self) -> Function:
        """What could be counted on to be reached without it."""
        if self.plant.helpful is self.plant.uncontrollable:
            return self.unsupervised
        return self._reachable(self.plant.helpful)

    def _reachable(self, uncontrollable: list[Step], within: Function | None = None) -> Function:
        return reachable(self.diagrams, self.plant.initial, self._limited(self.plant, uncontrollable), within)

    def _limited(self, plant: Plant, uncontrollable: Iterable[Step]) -> list[Step]:
        starts = [step for steps in plant.starts.values() for step in steps]
        return self._effort.limited([*uncontrollable, *starts])

    def reaching(self, goal: Function, within: Function | None = None) -> Function:
        """From where `goal`, all of it in `within`, can be reached there without faults."""
        return reaching(self.diagrams, goal, self._limited(self.plant, self.plant.helpful), within)

    def completing(self, goal: Function) -> Function:
        """The safe states in which `goal` holds, or from which it can be brought about so that a tick sees it."""
        if self.plant.automaton.one_at_a_time:
            return self.reaching(goal & self.safe, self.safe)
        ticks = [step for step in self.plant.helpful if isinstance(step, Reaction)]
        if not ticks:  # in which nothing changes
            return self.reaching(goal & self.safe, self.safe)
        seen = self.diagrams.disjunction(tick.before(goal & self.safe) for tick in ticks) & self.safe
        return self.reaching(seen, self.safe) | (goal & self.safe)

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
        """What each specification forbids."""
        return {each.name: self.plant.where(each.forbidden) for each in self.plant.automaton.specifications.values()}

    def broken_unasked(self, states: Function) -> list[str]:
        """The specifications that can be broken from `states` on without any start."""
        steps = self._effort.limited(self.plant.uncontrollable)
        reached = reachable(self.diagrams, states, steps)
        return [name for name, where in self.forbidden().items() if (where & reached).satisfiable()]

    def unbroken_unasked(self, states: Function) -> bool:
        """Whether from some of `states` on no specification can be broken without any start."""
        broken = self.diagrams.disjunction(self.forbidden().values())
        return (
            states & ~reaching(self.diagrams, broken, self._effort.limited(self.plant.uncontrollable))
        ).satisfiable()

    @cached_property
    def ever(self) -> tuple[Plant, Function]:
        """All that may be reached by any means, on a plant of its own."""
        automaton = _with_every_move(self.plant.automaton)
        plant = self._plant(automaton)
        return plant, reachable(plant.diagrams, plant.initial, self._limited(plant, plant.uncontrollable))

    def may_ever(self, predicate: Expression) -> bool:
        """Whether it holds in any state that may be reached: also restarted, called off, or with a new product."""
        plant, reached = self.ever
        return (plant.where(predicate) & reached).satisfiable()


def bits(automaton: Automaton, names: Iterable[str]) -> int:
    """How many bits there are in the values of `names`."""
    return sum((len(automaton.variables[name].type.domain) - 1).bit_length() for name in names)


def bearing_on(automaton: Automaton, questions: Iterable[Expression]) -> frozenset[str]:
    """The variables that an inquiry about `questions` is over."""
    return frozenset(with_initial(automaton, [*_given(automaton), *questions]))


def _given(automaton: Automaton) -> list[Expression]:
    """What every inquiry is about: what is safe."""
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
