"""What a station can reach with its supervisor and without it, over all variables that a question is about."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
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
from sequence_planner.synthesis.shortest import Tracer
from sequence_planner.synthesis.steps import Step
from sequence_planner.synthesis.supervision import with_initial
from sequence_planner.synthesis.traces import Trace


@dataclass(frozen=True)
class Questions:
    """What is asked of an automaton, whose supervisor keeps to the states that are `safe`."""

    automaton: Automaton
    expressions: Sequence[Expression]
    safe: StateSet

    @property
    def bearing(self) -> frozenset[str]:
        """The variables that an inquiry is over."""
        return frozenset(with_initial(self.automaton, [*_given(self.automaton), *self.expressions]))


class Inquiry:
    """An automaton over what can influence what is `asked` of it, and what is safe.

    All initial states must be safe. Raises `TooMuchError` when answers take more than `effort`. An `order` of these
    variables can be given.
    """

    def __init__(self, asked: Questions, effort: Effort, order: Sequence[str] = ()) -> None:
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

    def reached(self, target: Function, *, supervised: bool = True, faults: bool = True) -> Function:
        """Those states of `target` that are reached with or without the supervisor, and counting on faults or not."""
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
        """Whether `goal` can be reached from `states` without faults, the supervisor not asked; None if unknown."""
        steps = self.limited(self.plant, self.plant.helpful)
        return (states & reaching(self.diagrams, goal, steps)).satisfiable()

    def limited(self, plant: Plant, uncontrollable: Iterable[Step]) -> list[Step]:
        """These steps and all starts, which raise `TooMuchError` when all effort is spent."""
        starts = [step for steps in plant.starts.values() for step in steps]
        return self.effort.limited([*uncontrollable, *starts])

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
        """What each specification forbids."""
        return {each.name: self.plant.where(each.forbidden) for each in self.plant.automaton.specifications.values()}

    def broken_unasked(self, states: Function) -> list[str]:
        """The specifications that can be broken from `states` on without any start."""
        steps = self.effort.limited(self.plant.uncontrollable)
        reached = reachable(self.diagrams, states, steps)
        return [name for name, where in self.forbidden().items() if (where & reached).satisfiable()]

    def unbroken_unasked(self, states: Function) -> bool:
        """Whether from some of `states` on no specification can be broken without any start."""
        broken = self.diagrams.disjunction(self.forbidden().values())
        return (states & ~reaching(self.diagrams, broken, self.effort.limited(self.plant.uncontrollable))).satisfiable()

    @cached_property
    def ever(self) -> tuple[Plant, Function]:
        """All that may be reached by any means, on a plant of its own."""
        automaton = _with_every_move(self.plant.automaton)
        plant = self._plant(automaton)
        return plant, self._closed(plant)

    def _closed(self, plant: Plant) -> Function:
        """What is reached in `plant`, with all that can happen in it."""
        return reachable(plant.diagrams, plant.initial, self.limited(plant, plant.uncontrollable))

    def may_ever(self, predicate: Expression) -> bool:
        """Whether it holds in any state that may be reached: also restarted, called off, or with a new product."""
        plant, reached = self.ever
        return (plant.where(predicate) & reached).satisfiable()


def bits(automaton: Automaton, names: Iterable[str]) -> int:
    """How many bits there are in the values of `names`."""
    return sum((len(automaton.variables[name].type.domain) - 1).bit_length() for name in names)


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
