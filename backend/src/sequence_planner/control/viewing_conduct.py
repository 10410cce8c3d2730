"""What is shown of how a station executes: its PackML state, what is carried out, forced, and out of service."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.alarm_view import AlarmView
from sequence_planner.control.conduct import Conduct
from sequence_planner.control.execution import Execution
from sequence_planner.control.offer_showing import end_text
from sequence_planner.control.outside import Outside
from sequence_planner.control.restart_view import ErrandView, ForceView, LastErrandView, ServiceView
from sequence_planner.control.view import PackML, StationStanding
from sequence_planner.control.vocabulary import Mode, PlanStatus, Production, ServiceKind

_ENDING = {Mode.PAUSED: (PackML.HOLDING, PackML.HELD), Mode.HOLD: (PackML.STOPPING, PackML.STOPPED)}


def packml(execution: Execution) -> PackML:
    """The state of PackML that fits; `docs/control.md` says what it is made of."""
    if execution.production is not Production.STARTED:
        return PackML.IDLE
    moves = bool(execution.running())
    if execution.mode is Mode.AUTOMATIC:
        followed = execution.plan.status is PlanStatus.FOLLOWED and bool(execution.plan.order.goals)
        return PackML.EXECUTE if moves or followed else PackML.SUSPENDED
    moves = moves or execution.errand is not None
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


def failing(automaton: Automaton, alarms: Mapping[str, AlarmView]) -> list[str]:
    """What the resources are called that do not do what they should, as `alarms` say; people are none of them."""
    found: set[str] = set()
    for key, alarm in alarms.items():
        kind, _, name = key.partition(":")
        ability = automaton.abilities.get(name)
        if alarm.ended is not None or kind not in _FAILURES:
            continue
        if ability is None:
            found.add(name)
        elif ability.human is None:
            found.add(ability.resource)
    return [title for name, title in automaton.resources.items() if name in found]


def standing(execution: Execution, outside: Outside, silent: Collection[str]) -> StationStanding:
    """Whether anything starts by itself, while these resources are `silent`."""
    situation = outside.situation
    if execution.production is not Production.STARTED:
        return StationStanding.WAITING
    if execution.mode is not Mode.AUTOMATIC:
        return _STANDING[execution.mode]
    if execution.obstacles or (situation is not None and situation.certain):
        return StationStanding.STOPPED
    return StationStanding.SILENT if silent else StationStanding.WORKING


def errand_view(execution: Execution) -> ErrandView | None:
    """What is carried out now."""
    errand = execution.errand
    if errand is None:
        return None
    return ErrandView(
        kind=errand.kind,
        title=errand.title,
        by=errand.by,
        why=errand.why,
        since=errand.taken.epoch,
        ends=end_text(errand.goal, errand.into_safe),
        into_safe=errand.into_safe,
        ability=errand.ability,
    )


def last_errand_view(conduct: Conduct) -> LastErrandView | None:
    """How the last one has ended."""
    last = conduct.last_errand
    if last is None:
        return None
    return LastErrandView(title=last.title, done=last.done, why=last.why, ended=last.ended.epoch, ability=last.ability)


def force_views(conduct: Conduct) -> dict[str, ForceView]:
    """What is forced."""
    return {
        name: ForceView(value=force.value, real=force.real, until=force.until.epoch, by=force.by, why=force.why)
        for name, force in conduct.forces.items()
    }


def service_views(automaton: Automaton, conduct: Conduct) -> list[ServiceView]:
    """What is out of service, since when."""
    return [
        ServiceView(
            of=each.of,
            name=each.name,
            title=_title(automaton, each.of, each.name),
            since=each.since.epoch,
            by=each.by,
            why=each.why,
        )
        for each in sorted(conduct.service.values(), key=lambda each: (each.since.epoch, each.of, each.name))
    ]


def _title(automaton: Automaton, of: ServiceKind, name: str) -> str:
    if of is ServiceKind.RESOURCE:
        return automaton.resources[name]
    return (automaton.abilities if of is ServiceKind.ABILITY else automaton.operations)[name].title
