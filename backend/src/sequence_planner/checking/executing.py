"""Finishes that rely on having seen their ability at work.

A device can be faster than its messages: then `executing` is never seen, and a finish guard that implies it never holds
(`docs/semantics.md`, "Tick"). That cannot happen when `executing` follows from the start, as it does when it reads
the command that the start gives and nothing that a device still has to do.
"""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.structure import Ability, Automaton
from sequence_planner.checking.satisfiability import Question, UndecidedError, can_be_asked
from sequence_planner.checking.warning import ModelWarning, families, place
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import Expression, conjunction, conjuncts, variables


def check_executing(automaton: Automaton) -> Iterator[ModelWarning]:
    """One warning for each written ability of which some instance relies on `executing`."""
    for family, names in families(automaton.abilities).items():
        for name in names:
            ability = automaton.abilities[name]
            if _needs_executing(automaton, ability) and (missing := _not_yet(automaton, ability)) is not None:
                message = (
                    f"`{family}` finishes only after it was seen executing, and right after its start "
                    f"`{print_expression(missing)}` may not hold yet: a device that is done before a message says that "
                    "it is at work is never seen to finish. Let the finish guard read the command and the result "
                    "instead of `executing`"
                )
                yield ModelWarning(place(automaton, f"{name}.finish", name), "relies-on-executing", message)
                break


def _needs_executing(automaton: Automaton, ability: Ability) -> bool:
    """Whether the finish guard implies that the ability was executing in the tick before."""
    guard, flag = ability.finish_guard, ability.flag("executing")
    if guard is None or flag not in variables(guard) or not can_be_asked(automaton, guard):
        return False
    question = Question(automaton)
    state = question.with_old_flags()
    finishes = question.reading.truth(guard, state).yes
    unseen = question.circuit.conjunction((finishes, state[flag].literal(False)))
    try:
        some, without = question.models(finishes, unseen)
    except UndecidedError:
        return False
    return some is not None and without is None


def _not_yet(automaton: Automaton, ability: Ability) -> Expression | None:
    """What of `executing` may be false right after a start, or None if it always holds then."""
    guard = conjunction(ability.enabled, ability.start_guard)
    values = [action.value for action in ability.start_actions]
    if not can_be_asked(automaton, guard, ability.executing, *values):
        return None
    question = Question(automaton)
    before = question.state()
    after = question.after(ability.start_actions, before)
    question.circuit.require(question.reading.truth(guard, before).yes)
    question.circuit.require(-question.reading.truth(ability.executing, after).yes)
    try:
        model = question.model()
    except UndecidedError:
        return None
    if model is None:
        return None
    seen = after.valuation(model)
    return next(part for part in conjuncts(ability.executing) if not evaluate(part, seen))
