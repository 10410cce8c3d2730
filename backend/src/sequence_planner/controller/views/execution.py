"""Views of how a station executes: its PackML state, what is carried out, forced, and out of service."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.controller.views.station import (
    AlarmView,
    CycleStopView,
    ForceView,
    LastOperatorPlanView,
    OperatorPlanView,
    PackML,
    ServiceView,
    StationStanding,
)
from sequence_planner.controller.views.wording import end_message, end_text, ended_text, title_text
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import CycleStop, ExecutionState
from sequence_planner.execution.vocabulary import Mode, PlanStatus, Production, ServiceKind
from sequence_planner.texts.message import as_it_was

_ENDING = {Mode.PAUSED: (PackML.HOLDING, PackML.HELD), Mode.HOLD: (PackML.STOPPING, PackML.STOPPED)}


def packml(execution: Executor) -> PackML:
    """The state of PackML that fits; `docs/control.md` says what it is made of."""
    if execution.production is not Production.STARTED:
        return PackML.IDLE
    running = execution.running()
    if execution.mode is Mode.AUTOMATIC:
        abilities, silent = execution.automaton.abilities, execution.conduct.silent
        works = any(abilities[name].resource not in silent for name in running)
        followed = execution.plan.status is PlanStatus.FOLLOWED and bool(execution.plan.order.goals)
        return PackML.EXECUTE if works or followed else PackML.SUSPENDED
    moves = bool(running) or execution.operator_plan is not None
    if execution.mode is Mode.RESTART:
        return PackML.CLEARING if moves else PackML.ABORTED
    during, after = _ENDING[execution.mode]
    return during if moves else after


_STANDING = {
    Mode.HOLD: StationStanding.HELD,
    Mode.RESTART: StationStanding.RESTART,
    Mode.PAUSED: StationStanding.PAUSED,
}


# What alarms are called that say of a device, or of what it does, that it fails; see `docs/alarms.md`.
_FAILURES = frozenset({"overdue", "still", "given-up"})


def failing(automaton: Automaton, alarms: Mapping[str, AlarmView], running: Collection[str]) -> list[str]:
    """Return what the resources are called that do not do what they should, as `alarms` say; people are none of them.

    Of the abilities that are late those that are `running`: what a person has called off has nothing to do.
    """
    found: set[str] = set()
    for key, alarm in alarms.items():
        kind, _, name = key.partition(":")
        ability = automaton.abilities.get(name)
        if alarm.ended is not None or kind not in _FAILURES:
            continue
        if ability is None:
            found.add(name)
        elif ability.human is None and name in running:
            found.add(ability.resource)
    return [title for name, title in automaton.resources.items() if name in found]


def goes_on(execution: Executor, outside: bool) -> bool:
    """Return whether anything starts by itself; nothing does certainly `outside` the safe states."""
    may = execution.production is Production.STARTED and execution.mode is Mode.AUTOMATIC
    return may and not execution.obstacles and not outside


def standing(execution: Executor, outside: bool, silent: Collection[str]) -> StationStanding:
    """Return how it stands, while these resources are `silent`."""
    if goes_on(execution, outside):
        return StationStanding.SILENT if silent else StationStanding.WORKING
    if execution.production is not Production.STARTED:
        return StationStanding.WAITING
    return _STANDING.get(execution.mode, StationStanding.STOPPED)


def operator_plan_view(execution: Executor) -> OperatorPlanView | None:
    """Return what is carried out now."""
    plan = execution.operator_plan
    if plan is None:
        return None
    return OperatorPlanView(
        kind=plan.kind,
        title=plan.title,
        title_message=title_text(plan.title),
        by=plan.by,
        why=plan.why,
        since=plan.taken.epoch,
        ends=end_text(plan.goal, plan.into_safe),
        ends_message=end_message(execution.automaton, plan.goal, plan.into_safe),
        into_safe=plan.into_safe,
        ability=plan.ability,
    )


def last_operator_plan_view(conduct: ExecutionState) -> LastOperatorPlanView | None:
    """Return how the last one has ended."""
    last = conduct.last_operator_plan
    if last is None:
        return None
    return LastOperatorPlanView(
        title=last.title,
        title_message=title_text(last.title),
        done=last.done,
        why=last.why,
        why_message=ended_text(last.why),
        ended=last.ended.epoch,
        ability=last.ability,
    )


def force_views(conduct: ExecutionState) -> dict[str, ForceView]:
    """Return what is forced."""
    return {
        name: ForceView(value=force.value, real=force.real, until=force.until.epoch, by=force.by, why=force.why)
        for name, force in conduct.forces.items()
    }


def cycle_stop_view(stop: CycleStop | None) -> CycleStopView | None:
    """Return who wished the station to pause when the product is done, and since when."""
    if stop is None:
        return None
    return CycleStopView(by=stop.by, since=stop.asked.epoch, why=stop.why, reached=stop.reached)


def service_views(automaton: Automaton, conduct: ExecutionState) -> list[ServiceView]:
    """Return what is out of service, since when."""
    return [
        ServiceView(
            of=each.of,
            name=each.name,
            title=_title(automaton, each.of, each.name),
            since=each.since.epoch,
            by=each.by,
            why=each.why,
            why_message=None if each.by is not None else as_it_was(each.why, "late."),
        )
        for each in sorted(conduct.service.values(), key=lambda each: (each.since.epoch, each.of, each.name))
    ]


def _title(automaton: Automaton, of: ServiceKind, name: str) -> str:
    if of is ServiceKind.RESOURCE:
        return automaton.resources[name]
    return (automaton.abilities if of is ServiceKind.ABILITY else automaton.operations)[name].title
