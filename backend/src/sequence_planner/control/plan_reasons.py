"""Why there is a plan, or none: sentences for the people at the station."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.vocabulary import PlanStatus
from sequence_planner.counting import counted
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import TRUE
from sequence_planner.planning.plan import PlanAnswer, Verdict


def why_new(
    automaton: Automaton, status: PlanStatus, wanted: frozenset[str], requested: frozenset[str], replacing: bool
) -> str:
    """Why a new plan is followed; `status` is that of the one before, which `requested` had been asked for."""
    new = wanted - requested
    if status is PlanStatus.BROKEN:
        return "re-planned: the station departed from the plan, which no longer reached its goals"
    if replacing and new:
        return f"re-planned: {_titles(automaton, new)} became active"
    if replacing:
        return "re-planned: a better way was found"
    return f"planned for {_titles(automaton, wanted)}"


def why_none(answer: PlanAnswer, blind: bool) -> str:
    """Why there is no plan. `blind`: there were measured values that nobody knew."""
    if answer.verdict is Verdict.NONE_AT_ALL:
        unknown = " while measured values are unknown" if blind else ""
        return f"no plan at all{unknown}, proven: nothing the station can do from here reaches any of the goals"
    if blind:
        return "no plan while measured values are unknown"
    none = f"no plan of up to {counted(answer.searched, 'tick')}"
    if answer.verdict is Verdict.LATE:
        known = f"{none}, and longer ones" if answer.searched > 0 else "a plan"
        return f"no answer in time: {known} may exist"
    return f"{none}: there may be a longer one"


def why_violated(automaton: Automaton, names: Iterable[str]) -> str:
    """That none of the operations can be planned, since their formulas were violated."""
    return f"no plan: {'; '.join(violation(automaton, name) for name in sorted(names))}"


def violation(automaton: Automaton, name: str) -> str:
    """That the formula of an operation was violated."""
    operation = automaton.operations[name]
    return f"`{print_expression(operation.local or TRUE)}` of {operation.title} was violated"


def _titles(automaton: Automaton, names: Iterable[str]) -> str:
    return ", ".join(automaton.operations[name].title for name in sorted(names))
