"""What has to come before what in a run, so that the rest of it may come in another order, or at once.

An event waits for those that have written what it relies on, and for those that relied on what it overwrites; all else
in the run is left open (Bäckström 1998).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from sequence_planner.automaton.structure import Ability, Automaton, Effect, State, reads, target
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import And, Assignment, Expression, Implies, Not, Or, Variable, variables
from sequence_planner.immutable import Immutable


class Event(Immutable):
    """An effect, or with `start` a start, and the numbers of the events that it waits for."""

    name: str
    start: bool
    after: frozenset[int]


class CausalOrder:
    """The events of a run of one automaton, noted one after the other."""

    def __init__(self, automaton: Automaton) -> None:
        self.events: list[Event] = []
        self._predicates = automaton.flag_predicates
        self._writer: dict[str, int] = {}  # the last one of each variable
        self._readers: dict[str, list[int]] = defaultdict(list)  # since then

    def happens(self, effect: Effect, before: State) -> None:
        """Note an effect, with the state at the end of the tick before."""
        relied = set(self.relied_on(effect.guard, before))
        self._note(effect.name, False, relied, effect.actions, ())

    def starts(self, ability: Ability, before: State) -> None:
        """Note a start, with the state before it. What its finish writes counts as written from then on."""
        relied = set(self.relied_on(ability.enabled, before)).union(self.relied_on(ability.start_guard, before))
        self._note(ability.name, True, relied, ability.start_actions, ability.finish_actions)

    def relied_on(self, predicate: Expression, state: State) -> Iterator[str]:
        """Variables whose values in `state` alone give `predicate` its value there."""
        match predicate:
            case And(operands) | Or(operands):
                decisive = isinstance(predicate, Or)  # the truth value that one operand alone can give to the whole
                for part in next(([part] for part in operands if evaluate(part, state) is decisive), operands):
                    yield from self.relied_on(part, state)
            case Not(operand):
                yield from self.relied_on(operand, state)
            case Implies(left, right):
                yield from self.relied_on(Or((Not(left), right)), state)
            case Variable(name) if name in self._predicates:
                yield from self.relied_on(self._predicates[name], state)
            case _:
                for name in variables(predicate):
                    if name in self._predicates:
                        yield from self.relied_on(self._predicates[name], state)
                    else:
                        yield name

    def _note(
        self, name: str, start: bool, relied: set[str], now: Iterable[Assignment], later: Iterable[Assignment]
    ) -> None:
        number = len(self.events)
        relied.update(read for action in now for read in reads(action) if read not in self._predicates)
        written = set(map(target, (*now, *later)))
        after = {self._writer[each] for each in relied | written if each in self._writer}
        after.update(reader for each in written for reader in self._readers[each])
        self.events.append(Event(name, start, frozenset(after)))
        for each in relied:
            self._readers[each].append(number)
        for each in written:
            self._writer[each] = number
            self._readers[each] = []
