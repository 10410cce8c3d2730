"""What follows from a correction, found out without making it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Protocol

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Ability, Automaton, Kind, State, target
from sequence_planner.automaton.tick import record_activity, supervised_start, update_operations
from sequence_planner.control.belief import Beliefs
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.correction_view import CorrectedView, CorrectionPreview
from sequence_planner.control.doubting import Doubting
from sequence_planner.control.execution import Execution
from sequence_planner.control.offer_showing import plan_preview
from sequence_planner.control.value_text import value_text
from sequence_planner.control.way_back_view import SpecificationView
from sequence_planner.expressions.syntax import Expression
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import replace
from sequence_planner.planning.plan import Contract, Goal, PlanAnswer, PlanRequest, Verdict, goal_of
from sequence_planner.planning.way_back import violated

PLANNED_WITHIN = 1.5  # seconds
WAITING = 2.0  # seconds beyond that: the adviser may be at something else
MOST_RELATED = 12

_WHY_NONE = {
    Verdict.NONE_UP_TO: "No plan was found in as many ticks as are looked at.",
    Verdict.NONE_AT_ALL: "There is no plan at all from there.",
    Verdict.LATE: "No plan was found in the time there is; one may exist.",
}


class PlansOnRequest(Protocol):
    """Whoever plans what people ask for."""

    async def answer(self, request: PlanRequest, deadline: float) -> PlanAnswer:
        """What is found within so many seconds. Raises `CommandRefused`."""
        ...


class Previewing:
    """Looks at what `execution` would be like."""

    def __init__(self, execution: Execution, adviser: PlansOnRequest, beliefs: Beliefs, doubting: Doubting) -> None:
        self._execution = execution
        self._adviser = adviser
        self._beliefs = beliefs
        self._doubting = doubting

    async def preview(self, values: Mapping[str, Value], obstacle: str | None) -> CorrectionPreview:
        """All of it. Without a planner it says why there is no plan, and the rest all the same."""
        execution, automaton, revision = self._execution, self._execution.automaton, self._execution.revision
        now, then = execution.state, execution.corrected(values)
        active = update_operations(automaton, then, execution.active) - execution.conduct.idle_operations(automaton)
        before, after = self._startable(now), self._startable(then)
        wrong_now, wrong_then = (self._doubting.contradictions(state).because for state in (now, then))
        changes = [self._changed(name, value) for name, value in values.items()]
        preview = CorrectionPreview(
            revision=revision,
            changes=changes,
            safe=execution.supervisor.safe.includes(then),
            safe_now=execution.safe,
            violates=[_specification(automaton, name) for name in violated(automaton, then)],
            startable=[name for name in after if name not in before],
            no_longer_startable=[name for name in before if name not in after],
            activated=sorted(active - execution.active),
            completed=sorted(execution.active - active),
            contradictions_gone=[text for text in wrong_now if text not in wrong_then],
            contradictions_new=[text for text in wrong_then if text not in wrong_now],
            plan=None,
            goals=[],
            left_out=[],
            reason="",
            obstacle=obstacle,
        )
        goals = self._goals(active)
        if not goals:
            return preview.model_copy(update={"reason": "No operation would be active, so there is nothing to plan."})
        state = record_activity(automaton, then, active)
        return preview.model_copy(update=await self._planned(state, goals))

    async def _planned(self, state: State, goals: tuple[Goal, ...]) -> dict[str, object]:
        circumstances = replace(self._execution.circumstances, restart=False)
        request = PlanRequest(
            state, goals, deadline=PLANNED_WITHIN, contract=Contract.FAST, circumstances=circumstances
        )
        try:
            answer = await self._adviser.answer(request, PLANNED_WITHIN + WAITING)
        except CommandRefused as refused:
            return {"reason": f"{refused.title}: {refused.detail}"}
        if answer.plan is None:
            return {"reason": _WHY_NONE[answer.verdict], "left_out": list(answer.left_out)}
        preview = plan_preview(self._execution.automaton, answer.plan)
        return {"plan": preview, "goals": list(answer.goals), "left_out": list(answer.left_out)}

    def _goals(self, active: frozenset[str]) -> tuple[Goal, ...]:
        """What would be pursued: what is, as far as it has come, and what becomes active."""
        pursued, operations = self._execution.pursued.goals, self._execution.automaton.operations
        return tuple(pursued.get(name) or goal_of(operations[name]) for name in sorted(active))

    def _startable(self, state: State) -> list[str]:
        """The abilities whose guards and the supervisor would allow their start there, whatever the mode."""
        execution, automaton = self._execution, self._execution.automaton
        return [
            ability.name
            for ability in automaton.abilities.values()
            if not execution.circumstances.bars(ability)
            and supervised_start(automaton, execution.supervisor, execution.published, state, ability) is not None
        ]

    def _changed(self, name: str, value: Value) -> CorrectedView:
        now = self._execution.state[name]
        assert now is not None
        return CorrectedView(
            name=name, now=now, then=value, belief=self._beliefs.of(name), related=list(self._related(name))
        )

    def _related(self, name: str) -> Iterator[str]:
        """What is measured that abilities look at before they write the estimate."""
        automaton, state = self._execution.automaton, self._execution.state
        guards = [guard for ability in automaton.abilities.values() for guard in _guards(ability, name)]
        read = read_variables(automaton, guards)
        for measured in [each for each in automaton.names(Kind.MEASURED) if each in read][:MOST_RELATED]:
            value = state[measured]
            yield f"{measured} is unknown" if value is None else value_text(automaton, measured, value)


def _guards(ability: Ability, name: str) -> Iterator[Expression]:
    """What the ability looks at when it writes the variable."""
    starts = [action for action in ability.start_actions if target(action) == name]
    finishes = [action for action in ability.finish_actions if target(action) == name]
    if starts:
        yield from (ability.enabled, ability.start_guard)
    if finishes and ability.finish_guard is not None:
        yield ability.finish_guard
    for action in (*starts, *finishes):
        yield action.value
        if action.condition is not None:
            yield action.condition


def _specification(automaton: Automaton, name: str) -> SpecificationView:
    return SpecificationView(name=name, title=automaton.specifications[name].title)
