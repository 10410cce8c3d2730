"""What to look at: through which variables an automaton is seen first, and through which ones then."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Set
from functools import cached_property

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.automaton.transitions import transitions
from sequence_planner.expressions.syntax import Expression

Names = frozenset[str]

# Values, of all variables together, that are better seen at once than little by little.
_FEW_VALUES = 80

# Variables up to which all are seen of which the supervisor speaks.
_FEW_SUPERVISED = 12


class Sight:
    """Of one automaton under one supervisor."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor

    def first(self, asked: Iterable[Expression]) -> Names:
        """What the questions `asked` read, with what the supervisor speaks of besides; where it matters, that decides.

        Where it says nothing, and there is little to see, all of it.
        """
        read = read_variables(self._automaton, asked)
        with_supervised = self._closed(read, self._supervised)
        if 0 < len(with_supervised - read) <= _FEW_SUPERVISED:
            return with_supervised
        return self._all_if_few(read)

    def further(self, kept: Names, needed: Names) -> Names:
        """More than `kept`: all that can matter if that is little, else of what is `needed` first the supervised."""
        everything = self._all_if_few(kept)
        return everything | needed if everything != kept else kept | (needed & self._supervised or needed)

    def _all_if_few(self, kept: Names) -> Names:
        cone = self._closed(kept, self._automaton.variables.keys())
        values = sum(len(self._automaton.variables[name].type.domain) for name in cone)
        return cone if values <= _FEW_VALUES else kept

    def _closed(self, names: Names, among: Set[str]) -> Names:
        """`names` with those `among` which decide how they are written, and those which decide these, and so on."""
        found = set(names)
        pending = list(names)
        while pending:
            new = (self._deciding[pending.pop()] & among) - found
            found |= new
            pending += new
        return frozenset(found)

    @cached_property
    def _supervised(self) -> Names:
        """What starts are kept from by the supervisor."""
        names = (guard.names for guard in self._supervisor.guards.values())
        return frozenset[str]().union(*names) & self._automaton.variables.keys()

    @cached_property
    def _deciding(self) -> dict[str, set[str]]:
        """For each variable those that whatever writes it reads, the supervisor included."""
        guards = {f"{name}.start": frozenset(guard.names) for name, guard in self._supervisor.guards.items()}
        deciding: dict[str, set[str]] = defaultdict(set)
        for transition in transitions(self._automaton):
            if not transition.fault:
                read = transition.reads | guards.get(transition.name, frozenset())
                for name in transition.writes:
                    deciding[name] |= read
        behind = {flag.name: read_variables(self._automaton, (flag.predicate,)) for flag in self._automaton.flags}
        for names in deciding.values():
            names.update(*(behind[name] for name in names & behind.keys()))
        return deciding
