"""Abilities that take longer than they may: whether a run is overdue, and what is then done about it."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.automaton.structure import Ability, Automaton
from sequence_planner.control.conduct import Conduct, OutOfService
from sequence_planner.control.moment import Moment
from sequence_planner.control.start_order import StartOrder, Step
from sequence_planner.control.vocabulary import ServiceKind
from sequence_planner.immutable import replace


def overdue(step: Step, ability: Ability, monotonic: float) -> str | None:
    """What has not come in time of a run under way, as in `has not begun within 2 s`; None while it is in time."""
    if step.started is None or step.ended is not None:
        return None
    seconds = monotonic - step.started.monotonic
    react, finish = ability.timeouts.react, ability.timeouts.finish
    if finish is not None and seconds > finish:
        return f"has not finished within {finish:g} s"
    if react is not None and seconds > react and not step.reacted:
        return f"has not begun within {react:g} s"
    return None


def in_the_past(late: str) -> str:
    """The same of a run that is over, as in `did not begin within 2 s`."""
    return late.replace("has not begun", "did not begin").replace("has not finished", "did not finish")


def to_call_off(automaton: Automaton, order: StartOrder, now: Moment) -> dict[str, str]:
    """The abilities that are overdue and shall then be planned anew, each with what has not come in time."""
    late: dict[str, str] = {}
    for step in order.running:
        ability = automaton.abilities[step.ability]
        if ability.timeouts.replan and (what := overdue(step, ability, now.monotonic)) is not None:
            late[step.ability] = what
    return late


def after_another_try(
    conduct: Conduct, automaton: Automaton, late: Mapping[str, str], now: Moment
) -> tuple[Conduct, tuple[str, ...]]:
    """The conduct once these abilities were tried in vain once more, and those that are given up with it."""
    tried = {name: conduct.tried.get(name, 0) + 1 for name in late}
    given_up = tuple(name for name, times in tried.items() if times > automaton.abilities[name].timeouts.retries)
    gone = [
        OutOfService(ServiceKind.ABILITY, name, now, None, f"{late[name]}, tried {_times(tried[name])}")
        for name in given_up
    ]
    left = {name: times for name, times in {**conduct.tried, **tried}.items() if name not in given_up}
    return replace(conduct.without_service(gone), tried=left), given_up


def _times(number: int) -> str:
    return "once" if number == 1 else f"{number} times"
