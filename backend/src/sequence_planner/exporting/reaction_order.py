"""What effects that are taken one after another must know of the state before the tick.

All effects of a tick read the state before it. One that reads what another writes can be taken before that one; only
where two would each have to come first, a copy is kept of what they read.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass

from sequence_planner.automaton.structure import target
from sequence_planner.automaton.transitions import Transition
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.replacing import Replacements, replaced
from sequence_planner.expressions.simplification import simplify
from sequence_planner.expressions.syntax import Constant, Expression, conjuncts, occurrences, variables
from sequence_planner.expressions.types import Value

Allowed = Mapping[str, Set[Value]]


@dataclass(frozen=True)
class ReactionOrder:
    """`copies` are variables whose value before the tick is kept; `locks` has for each effect variables that must not
    have been written before it; `contended` are those that several effects can write.
    """

    copies: frozenset[str]
    locks: Mapping[str, frozenset[str]]
    contended: frozenset[str]

    @property
    def marked(self) -> frozenset[str]:
        """The variables of which it must be known whether an effect of this tick has written them."""
        return self.contended.union(*self.locks.values())


def reaction_order(effects: Sequence[Transition], flags: Replacements) -> ReactionOrder:
    """What `effects` need, whose `flags` are replaced by their predicates."""
    read = {e.name: _read(e, flags) for e in effects}
    allowed = {e.name: allowed_values(replaced(e.guard, flags)) for e in effects}
    writers: dict[str, list[Transition]] = {}
    for effect in effects:
        for name in effect.writes:
            writers.setdefault(name, []).append(effect)
    later: dict[str, set[str]] = {effect.name: set() for effect in effects}
    for effect in effects:
        for name in read[effect.name] & writers.keys():
            later[effect.name] |= {
                other.name
                for other in writers[name]
                if other is not effect and not _exclude(allowed[effect.name], allowed[other.name])
            }
    copies = _copies(later, read, {effect.name: effect.writes for effect in effects})
    locks: dict[str, frozenset[str]] = {}
    for effect in effects:
        needed = _read_by_actions(effect, flags)
        for name in read[effect.name] & writers.keys():
            if any(_may_enable(other, name, allowed[effect.name]) for other in writers[name]):
                needed |= {name}
        locks[effect.name] = (needed & writers.keys()) - copies
    return ReactionOrder(copies, locks, frozenset(name for name, several in writers.items() if len(several) > 1))


def allowed_values(guard: Expression) -> dict[str, Set[Value]]:
    """The values of variables outside which some part of `guard` fails."""
    allowed: dict[str, Set[Value]] = {}
    for part in conjuncts(simplify(guard)):
        concerned = {variable.name: variable.type for variable in occurrences(part)}
        if len(concerned) == 1:
            ((name, type_),) = concerned.items()
            values = {value for value in type_.domain if holds(part, {name: value})}
            allowed[name] = allowed.get(name, values) & values
    return allowed


def writes_outside(transition: Transition, name: str, allowed: Allowed) -> bool:
    """Whether it always writes a constant to the variable that is none of the `allowed` values."""
    return name in allowed and any(
        target(action) == name
        and action.condition is None
        and isinstance(action.value, Constant)
        and action.value.value not in allowed[name]
        for action in transition.actions
    )


def _may_enable(transition: Transition, name: str, allowed: Allowed) -> bool:
    return not writes_outside(transition, name, allowed)


def _exclude(one: Allowed, other: Allowed) -> bool:
    """Whether no state satisfies both guards, as far as their parts over single variables tell."""
    return any(values.isdisjoint(other[name]) for name, values in one.items() if name in other)


def _copies(
    later: Mapping[str, Set[str]], read: Mapping[str, Set[str]], written: Mapping[str, Set[str]]
) -> frozenset[str]:
    """What is read and written within circles of effects, each of which would have to come before the next."""
    above = {name: _reached(name, later) for name in later}
    return frozenset(
        variable
        for name, others in later.items()
        for other in others
        if name in above[other]
        for variable in read[name] & written[other]
    )


def _reached(name: str, later: Mapping[str, Set[str]]) -> set[str]:
    found: set[str] = set()
    pending = [name]
    while pending:
        new = later[pending.pop()] - found
        found |= new
        pending.extend(new)
    return found


def _read(effect: Transition, flags: Replacements) -> frozenset[str]:
    return frozenset(variables(replaced(effect.guard, flags))) | _read_by_actions(effect, flags)


def _read_by_actions(effect: Transition, flags: Replacements) -> frozenset[str]:
    return _variables(
        replaced(part, flags) for a in effect.actions for part in (a.value, a.condition) if part is not None
    )


def _variables(expressions: Iterable[Expression]) -> frozenset[str]:
    return frozenset(name for expression in expressions for name in variables(expression))
