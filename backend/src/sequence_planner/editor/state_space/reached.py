"""The states that a station can come to, exactly or overestimated, with those that are safe, forbidden and stuck."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Final

from oxidd.util import BooleanOperator

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import StateSet
from sequence_planner.editor.schemas.state_space import Extent
from sequence_planner.language.syntax import Expression, Variable
from sequence_planner.synthesis.approximation import composed
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.reachability import reachable
from sequence_planner.synthesis.supervisor import relevant, with_initial
from sequence_planner.synthesis.transition_relation import (
    MOST_BITS,
    NodeLimit,
    Plant,
    Reaction,
    TooMuchError,
    TransitionStep,
    orders,
    same,
    together,
)

MOST_EXACT: Final = 12_000_000  # nodes until the states are overestimated: some seconds
MOST_COMPOSED: Final = 80_000_000  # nodes for each order of the variables in which that is tried
_FAR_FEWER: Final = 0.75  # bits of what is asked about: only then it is worth it to leave out others
_AND = BooleanOperator.AND


@dataclass(frozen=True)
class Reached:
    """The states over the variables of `plant` that can be `reached` from those in which it may `begin`, with starts as
    far as the `extent` says for the states that are `safe`.

    Without `exact` there may be more than are reached, but none is missing.
    """

    plant: Plant
    begin: Function
    reached: Function
    safe: Function
    extent: Extent
    exact: bool

    @property
    def unsafe(self) -> Function:
        """The states from which it is no longer certain that what is forbidden can be prevented and rest be reached."""
        return self.plant.diagrams.valid & ~self.safe

    @property
    def out_of(self) -> Function:
        """The states in which starts are taken."""
        return self.plant.diagrams.valid if self.extent is Extent.ALL else self.safe

    @property
    def into(self) -> Function:
        """The states into which starts are followed."""
        return self.safe if self.extent is Extent.SUPERVISED else self.plant.diagrams.valid

    @property
    def has_all_variables(self) -> bool:
        """True if it is over all variables of the station."""
        return len(self.plant.diagrams.names) == len(self.plant.automaton.variables)

    def beginning(self, present: State) -> Reached | None:
        """Return it with a run that begins in a `present` state as well; None where that is not reached.

        Where some of its values are unknown, they are some with which it is reached.
        """
        now = self.plant.diagrams.states(present) & self.reached
        return replace(self, begin=self.plant.initial | now) if now.satisfiable() else None

    def cut(self, abilities: Iterable[str]) -> Function:
        """The safe states that are reached in which the start of one of the abilities would lead out of the safe."""
        plant, unsafe = self.plant, self.unsafe
        steps = [step for name in abilities for step in plant.starts.get(name, ())]
        return plant.diagrams.disjunction(step.before(unsafe) for step in steps) & self.safe & self.reached

    def stuck(self) -> Function:
        """The states that are reached in which no ability may start, and nothing but faults changes anything.

        It does not count that an operation becomes active.
        """
        plant = self.plant
        changing = plant.diagrams.disjunction(
            changed_by(plant, step) for step in plant.helpful if isinstance(step, Reaction)
        )
        return self.reached & ~changing & ~self._may_start()

    def _may_start(self) -> Function:
        plant = self.plant
        # Right behind the safe states nothing is started, though something could be: that is no deadlock.
        allowed = self.safe if self.extent is Extent.SUPERVISED else plant.diagrams.valid
        return plant.diagrams.disjunction(step.before(allowed) for step in plant.all_starts) & allowed


def changed_by(plant: Plant, reaction: Reaction) -> Function:
    """The states that a reaction can change."""
    diagrams = plant.diagrams
    return diagrams.disjunction(
        before_through(plant, reaction, ~same(diagrams, diagrams.values(name), diagrams.values_after(name)))
        for name in reaction.changed
    )


def before_through(plant: Plant, reaction: Reaction, steps: Function) -> Function:
    """The states from which a reaction leads as `steps` say of values now and afterwards."""
    diagrams = plant.diagrams
    for part in reaction.parts:
        bits = diagrams.cube(bit for each in part.decides for bit in diagrams.bits_after[each])
        steps = steps.apply_exists(_AND, part.relation, bits)
    return steps & diagrams.valid


def reached_states(
    automaton: Automaton, safe: StateSet, chosen: Sequence[str], extent: Extent, present: State | None = None
) -> Reached | None:
    """Return what is reached from the initial states, and from the `present` one where that is none of these.

    It is over all variables, or where that would take too long over those that bear on the `chosen` ones and on what is
    safe. What takes too long even so is overestimated; None where that does, too. An overestimate would have far too
    much behind the safe states: at the edge it is then one of what the supervisor allows.
    """
    everything = tuple(automaton.variables)
    bearing = _bearing(automaton, chosen)
    tried = [everything]
    if _bits(automaton, bearing) <= _FAR_FEWER * _bits(automaton, everything):
        tried.append(bearing)
    tried = [names for names in tried if _bits(automaton, names) <= MOST_BITS]
    for names in tried:
        with suppress(TooMuchError):
            limit = NodeLimit(MOST_EXACT)
            return _reached(Plant(automaton, names), safe, present, limit, extent, exact=True)
    if extent is Extent.EDGE:
        extent = Extent.SUPERVISED
    for names in tried:
        for order in orders(automaton, names):
            with suppress(TooMuchError):
                plant, limit = Plant(automaton, names, order), NodeLimit(MOST_COMPOSED)
                return _reached(plant, safe, present, limit, extent, exact=False)
    return None


def _bits(automaton: Automaton, names: Iterable[str]) -> int:
    return sum((len(automaton.variables[name].type.domain) - 1).bit_length() for name in names)


def _bearing(automaton: Automaton, chosen: Sequence[str]) -> tuple[str, ...]:
    """The variables that bear on the chosen ones and on what is safe, in order of declaration."""
    asked: list[Expression] = [Variable(name, automaton.variables[name].type) for name in chosen]
    names = {*relevant(automaton), *with_initial(automaton, asked)}
    return tuple(name for name in automaton.variables if name in names)


def _reached(
    plant: Plant, safe_states: StateSet, present: State | None, limit: NodeLimit, extent: Extent, *, exact: bool
) -> Reached:
    diagrams = plant.diagrams
    safe = diagrams.imported(safe_states) & diagrams.valid
    begin = plant.initial if present is None else plant.initial | diagrams.states(present)
    uncontrollable, starts = limit.limited(plant.uncontrollable), limit.limited(plant.all_starts)
    if exact:
        reached = _closed(plant, begin, uncontrollable, starts, safe, extent)
    else:
        # Within the safe states nothing leads out of them; from outside, it is not told apart who leads where.
        within = safe if extent is Extent.SUPERVISED and begin & safe == begin else diagrams.valid
        reached = composed(diagrams, begin, [*uncontrollable, *starts], together(plant.automaton), within)
    return Reached(plant, begin, reached, safe, extent, exact)


def _closed(
    plant: Plant,
    begin: Function,
    uncontrollable: list[TransitionStep],
    starts: list[TransitionStep],
    safe: Function,
    extent: Extent,
) -> Function:
    """Return all that steps lead to, with starts as far as the extent says."""
    if extent is Extent.ALL:
        return reachable(plant.diagrams, begin, [*uncontrollable, *starts])
    reached, before = begin, None
    while reached != before:
        before = reached
        # From outside the safe states nothing is started; inside, all is closed at once.
        reached = reachable(plant.diagrams, reached, uncontrollable)
        reached |= reachable(plant.diagrams, reached & safe, [*uncontrollable, *starts], safe)
        if extent is Extent.EDGE:
            reached |= plant.diagrams.disjunction(step.after(reached & safe) for step in starts)
    return reached
