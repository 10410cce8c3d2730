"""The reaction of a tick, steps 1 to 3, as a sequence of steps that each take one transition or none.

All effects read the state before the tick, all finishes the sensed state with the flags of the tick before. Taken one
after another, a later one would read what an earlier one wrote; what it must still know is kept in helper variables:
copies of variables, notes of flags, and marks of effects that later ones must agree with. The order is one that needs
few of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, combinations

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Automaton, Kind
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.exporting.together import can_dispute, one_suffices
from sequence_planner.expressions.syntax import Expression


@dataclass(frozen=True)
class Step:
    """Effects of which one is taken or none, or a finish, which is taken exactly where its guard holds.

    A finish is refused by those of `opponents` that hold with it and would write differently.
    """

    members: tuple[Transition, ...]
    opponents: tuple[Transition, ...] = ()

    @property
    def finishes(self) -> bool:
        """Whether it is a finish."""
        return self.members[0].phase is Phase.FINISH

    @cached_property
    def writes(self) -> frozenset[str]:
        """The variables that it may write."""
        return frozenset(chain.from_iterable(member.writes for member in self.members))

    @cached_property
    def reads(self) -> frozenset[str]:
        """The variables and flags that its guards and actions read."""
        return frozenset(chain.from_iterable(each.reads for each in (*self.members, *self.opponents)))


@dataclass(frozen=True)
class Reaction:
    """The steps in order, and what is kept of the state before the tick while they are taken."""

    steps: tuple[Step, ...]
    copies: tuple[str, ...]  # variables
    notes: tuple[str, ...]  # flags that finishes read
    marks: tuple[str, ...]  # effects


def reaction(automaton: Automaton) -> Reaction:
    """The reaction of a station's tick. Finishes that do nothing are left out."""
    effects = _ordered(automaton, _effect_steps(automaton))
    finishes = _ordered(automaton, _finish_steps(automaton))
    steps = (*effects, *finishes)
    copies = _copies(automaton, steps)
    return Reaction(
        steps,
        tuple(name for name in automaton.variables if name in copies),
        _notes(automaton, steps, copies),
        tuple(
            effect.name
            for index, step in enumerate(effects)
            for effect in step.members
            if any(can_dispute(effect, later) for after in effects[index + 1 :] for later in after.members)
        ),
    )


def _effect_steps(automaton: Automaton) -> list[Step]:
    """Effects that write common variables share a step where no two of them do more together than one does alone."""
    steps: list[list[Transition]] = []
    for group in _related([t for t in transitions(automaton) if t.phase is Phase.SENSE and t.writes]):
        first = len(steps)
        for effect in group:
            for members in steps[first:]:
                if all(one_suffices(effect, member) for member in members):
                    members.append(effect)
                    break
            else:
                steps.append([effect])
    return [Step(tuple(members)) for members in steps]


def _related(effects: Sequence[Transition]) -> list[list[Transition]]:
    """Effects that write common variables, also by way of others, are in one group."""
    groups: list[list[Transition]] = []
    for effect in effects:
        joined = [group for group in groups if any(member.writes & effect.writes for member in group)]
        groups = [group for group in groups if group not in joined]
        groups.append([*chain.from_iterable(joined), effect])
    return groups


def _finish_steps(automaton: Automaton) -> list[Step]:
    finishes = [t for t in transitions(automaton) if t.phase is Phase.FINISH and t.actions]
    opponents: dict[str, list[Transition]] = {finish.name: [] for finish in finishes}
    for one, other in combinations(finishes, 2):
        if can_dispute(one, other):
            opponents[one.name].append(other)
            opponents[other.name].append(one)
    return [Step((finish,), tuple(opponents[finish.name])) for finish in finishes]


def _ordered(automaton: Automaton, steps: Sequence[Step]) -> list[Step]:
    """Steps that write what many others read come late."""
    left, ordered = list(steps), list[Step]()
    while left:
        first = min(left, key=lambda step: len(_read_by(automaton, [o for o in left if o is not step]) & step.writes))
        left.remove(first)
        ordered.append(first)
    return ordered


def _read_by(automaton: Automaton, steps: Sequence[Step]) -> frozenset[str]:
    """What steps read of the state before the tick, apart from the flags that finishes do."""
    found = set[str]()
    for step in steps:
        found |= step.reads & automaton.variables.keys() if step.finishes else _inlined(automaton, step)
        if step.finishes:
            found -= set(automaton.names(Kind.MEASURED))
    return frozenset(found)


def _inlined(automaton: Automaton, step: Step) -> frozenset[str]:
    expressions: list[Expression] = []
    for member in step.members:
        expressions.append(member.guard)
        expressions.extend(action.value for action in member.actions)
        expressions.extend(action.condition for action in member.actions if action.condition is not None)
    return read_variables(automaton, expressions)


def _copies(automaton: Automaton, steps: Sequence[Step]) -> frozenset[str]:
    """Variables that a step reads as they were before the tick, and an earlier step writes."""
    written, found = set[str](), set[str]()
    for step in steps:
        found |= _read_by(automaton, [step]) & written
        written |= step.writes
    return frozenset(found)


def _notes(automaton: Automaton, steps: Sequence[Step], copies: frozenset[str]) -> tuple[str, ...]:
    """Flags that a finish reads, and that a variable that no copy is kept of would no longer tell."""
    written, found = set[str](), set[str]()
    for step in steps:
        if step.finishes:
            for name in step.reads - automaton.variables.keys():
                flag = automaton.flag_predicates[name]
                if read_variables(automaton, (flag,)) & written - copies:
                    found.add(name)
        written |= step.writes
    return tuple(flag.name for flag in automaton.flags if flag.name in found)
