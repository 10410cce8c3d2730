"""The things a station can ever bring about: a reading of the relaxation that leaves nothing out."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace

from sequence_planner.analysis.checks.warning import ModelCondition
from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.tick import initial_state
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.language.syntax import TRUE, Expression
from sequence_planner.planning.heuristic.relaxation import Relaxation


class Growth:
    """All that can become true from the initial state, by every start, finish, effect, cancellation and new product.

    With `any_measurement` messages may say anything; otherwise only effects change what is measured, faults included.
    Operations may be active or not.
    """

    def __init__(self, automaton: Automaton, any_measurement: bool) -> None:
        self.any_measurement = any_measurement
        self._automaton = automaton
        self._moves = list(every_move(automaton))
        self._first = {name: {value} for name, value in initial_state(automaton).items()}
        free = (Kind.ACTIVITY, Kind.MEASURED) if any_measurement else (Kind.ACTIVITY,)
        for name in (name for kind in free for name in automaton.names(kind)):
            self._first[name] = set(automaton.variables[name].type.domain)
        self._relaxation = Relaxation(automaton, self._first, self._moves)

    def may(self, predicate: Expression) -> bool:
        """Return whether `predicate` may ever hold."""
        return self._relaxation.may(predicate)

    def roots(self, stuck: Sequence[ModelCondition], dead: Collection[str]) -> list[ModelCondition]:
        """Those of `stuck`, which never hold, that do not only follow from another part that never holds.

        `dead` are the names of parts of which that has been said. Of a circle of parts that wait for each other, all
        are roots.
        """
        if not stuck:
            return []
        keys = {name.partition(":")[0] for name in dead}
        revived = self._with_done(lambda move: bool(keys & {move.name, f"{move.name.removesuffix('.start')}.enabled"}))
        left = [part for part in stuck if not revived.may(part.expression)]
        everything = self._with_done(lambda move: not self.may(move.guard))
        return [part for part in left if not everything.may(part.expression)] or left

    def _with_done(self, done: Callable[[Transition], bool]) -> Relaxation:
        """The relaxation in which some moves are made whatever their guards say."""
        moves = [replace(move, guard=TRUE) if done(move) else move for move in self._moves]
        return Relaxation(self._automaton, self._first, moves)


def every_move(automaton: Automaton) -> Iterator[Transition]:
    """All that changes variables: transitions, and what is done when a run is called off or a new product comes."""
    yield from transitions(automaton)
    for ability in automaton.abilities.values():
        if ability.cancel_actions:
            yield Transition(f"{ability.name}.cancel", Phase.START, TRUE, ability.cancel_actions)
    for master in automaton.work_masters.values():
        if master.brings:
            yield Transition(master.name, Phase.START, TRUE, master.brings)
