"""Time limits of running abilities, and how they are cancelled."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sequence_planner.automaton.automaton import Ability, Automaton, State
from sequence_planner.automaton.tick import Writes, conflicts_of, writes
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.plan_tracker import PlanCursor, PlannedStart
from sequence_planner.execution.state import ExecutionState, OutOfService
from sequence_planner.execution.vocabulary import ServiceKind
from sequence_planner.texts.message import Message, message

# Calling running abilities off, by the `cancel` actions that they declare.


def cancelled(automaton: Automaton, state: State, names: Iterable[str]) -> tuple[tuple[str, ...], Writes]:
    """Return which of the abilities can be called off, and what that writes; all at once, on the state before.

    Those that declare no cancel actions cannot. Of two that would write different values the one declared first is.
    """
    wanted = set(names)
    candidates: dict[str, Writes] = {}
    for ability in automaton.abilities.values():
        if ability.name in wanted and ability.cancel_actions:
            written = writes(ability.cancel_actions, state)
            if written is not None:
                candidates[ability.name] = written
    refused = {other for _, other, _ in conflicts_of(candidates)}
    called_off = tuple(name for name in candidates if name not in refused)
    together: Writes = {}
    for name in called_off:
        together |= candidates[name]
    return called_off, together


# Abilities that take longer than they may: whether a run is overdue, and what is then done about it.


@dataclass(frozen=True)
class Late:
    """That a run has not `begun`, or has not finished, within so many seconds."""

    begun: bool
    within: float

    def message(self) -> Message:
        """Say it, as in `has not begun within 2 s`."""
        return message("late.finished" if self.begun else "late.begun", seconds=self.within)


def overdue(step: PlannedStart, ability: Ability, monotonic: float) -> Late | None:
    """Say what has not come in time of a run under way; None while it is in time."""
    if step.started is None or step.ended is not None:
        return None
    seconds = monotonic - step.started.monotonic
    react, finish = ability.timeouts.react, ability.timeouts.finish
    if finish is not None and seconds > finish:
        return Late(begun=True, within=finish)
    if react is not None and seconds > react and not step.reacted:
        return Late(begun=False, within=react)
    return None


def in_the_past(late: str) -> str:
    """What was said of a run once it is over, as in `did not begin within 2 s`."""
    return late.replace("has not begun", "did not begin").replace("has not finished", "did not finish")


def to_call_off(automaton: Automaton, order: PlanCursor, now: Timestamp) -> dict[str, str]:
    """The abilities that are overdue and shall then be planned anew, each with what has not come in time."""
    late: dict[str, str] = {}
    for step in order.running:
        ability = automaton.abilities[step.ability]
        if ability.timeouts.replan and (what := overdue(step, ability, now.monotonic)) is not None:
            late[step.ability] = what.message()
    return late


def after_another_try(
    conduct: ExecutionState, automaton: Automaton, late: Mapping[str, str], now: Timestamp
) -> tuple[ExecutionState, tuple[str, ...]]:
    """The conduct once these abilities were tried in vain once more, and those that are given up with it."""
    tried = {name: conduct.tried.get(name, 0) + 1 for name in late}
    given_up = tuple(name for name, times in tried.items() if times > automaton.abilities[name].timeouts.retries)
    gone = [OutOfService(ServiceKind.ABILITY, name, now, None, _tried(late[name], tried[name])) for name in given_up]
    left = {name: times for name, times in {**conduct.tried, **tried}.items() if name not in given_up}
    return replace(conduct.without_service(gone), tried=left), given_up


def _tried(late: str, times: int) -> Message:
    return message("late.tried-once", late=late) if times == 1 else message("late.tried", late=late, times=times)
