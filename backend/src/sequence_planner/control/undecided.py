"""Outputs that came back from the journal and would make their devices react as soon as they are published.

While it was away the station does not know what has become of its devices, so an output that would move one as things
are now is for a person to decide.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Automaton, Effect, State, target
from sequence_planner.control.conduct import Conduct
from sequence_planner.control.execution import Execution
from sequence_planner.control.outside import leaves
from sequence_planner.control.restart_view import UndecidedOutputView
from sequence_planner.control.value_text import value_text
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.types import Value


class Undecided:
    """Looks at `execution`."""

    def __init__(self, execution: Execution) -> None:
        self._execution = execution
        self._readers = _readers(execution.automaton)
        self._seen: tuple[State, Conduct] | None = None
        self._views: dict[str, UndecidedOutputView] = {}

    def views(self) -> dict[str, UndecidedOutputView]:
        """The outputs on which a person must decide now, each with what its device would do.

        To force one for a while is no decision: what it will be afterwards is looked at.
        """
        state, conduct = self._execution.state, self._execution.conduct
        if self._seen is None or self._seen[0] is not state or self._seen[1] is not conduct:
            self._seen = state, conduct
            forced = {name: conduct.forces[name].real for name in conduct.forces.keys() & conduct.returned}
            real = {name: value for name, value in forced.items() if value is not None}
            self._views = dict(self._look(self._execution.corrected(real) if real else state, real, conduct.returned))
        return self._views

    def told(self, untold: Collection[str]) -> list[str]:
        """Those of them for which somebody is called.

        What rests only on resources whose silence is too young to be told may be over as soon as they are heard.
        """
        return [name for name in self.views() if not self._may_pass(name, untold)]

    def _may_pass(self, name: str, untold: Collection[str]) -> bool:
        """Whether nothing reacts for certain, and what is unknown is of resources in `untold`."""
        automaton, state = self._execution.automaton, self._execution.state
        for effect in self._readers.get(name, ()):
            if _reaction(automaton, effect, state) is not None:
                read = read_variables(automaton, (effect.guard, *(each.value for each in effect.actions)))
                unknown = [each for each in read if state[each] is None]
                if not unknown or any(automaton.variables[each].resource not in untold for each in unknown):
                    return False
        return True

    def _look(
        self, state: State, real: Mapping[str, Value], returned: frozenset[str]
    ) -> Iterator[tuple[str, UndecidedOutputView]]:
        automaton = self._execution.automaton
        for name in sorted(returned):
            value = state[name]
            assert value is not None
            if reacts := self._reactions(name, state):
                others = (other for other in automaton.types[name].domain if other != value)
                quiet = [v for v in others if not self._reactions(name, self._execution.corrected({**real, name: v}))]
                yield name, UndecidedOutputView(value=value, reacts=reacts, quiet=quiet, unsafe=self._unsafe(name))

    def _unsafe(self, name: str) -> list[Value]:
        """The values that would lead out of the safe states while all else is as it is."""
        execution = self._execution
        safe, state = execution.supervisor.safe, execution.state
        domain = execution.automaton.types[name].domain
        return [value for value in domain if leaves(safe, state, execution.corrected({name: value}))]

    def _reactions(self, name: str, state: State) -> list[str]:
        found = (_reaction(self._execution.automaton, effect, state) for effect in self._readers.get(name, ()))
        return list(dict.fromkeys(text for text in found if text is not None))


def _readers(automaton: Automaton) -> Mapping[str, list[Effect]]:
    """By output the effects that read it; nobody counts on faults."""
    readers: dict[str, list[Effect]] = {}
    for effect in automaton.effects:
        conditions = (action.condition for action in effect.actions if action.condition is not None)
        read = read_variables(automaton, (effect.guard, *conditions, *(action.value for action in effect.actions)))
        for name in sorted(read & automaton.outputs) if not effect.fault else ():
            readers.setdefault(name, []).append(effect)
    return readers


def _reaction(automaton: Automaton, effect: Effect, state: State) -> str | None:
    """What the effect would change; None where it certainly would change nothing."""
    guard = evaluate(effect.guard, state)
    if guard is False:
        return None
    changes: dict[str, Value | None] = {}
    for action in effect.actions:
        applies = True if action.condition is None else evaluate(action.condition, state)
        value, now = evaluate(action.value, state), state[target(action)]
        if applies is not False and (value is None or now is None or value != now):
            changes[target(action)] = value if applies else None
    if not changes:
        return None
    if guard is None:
        unknown = sorted(n for n in read_variables(automaton, (effect.guard,)) if state[n] is None)
        return f"{effect.resource} may react: {' and '.join(unknown)} unknown"
    said = (f"{n} changes" if v is None else value_text(automaton, n, v) for n, v in changes.items())
    return f"{effect.resource} reacts: {' and '.join(said)}"
