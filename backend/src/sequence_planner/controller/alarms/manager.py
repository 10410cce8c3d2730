"""Alarm manager: all alarms of a station, chattering alarms, flood suppression and operator actions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Protocol, runtime_checkable

from pydantic import JsonValue

from sequence_planner.controller.alarms.alarm import KIND, Alarm, Suppression, aside_to_keep
from sequence_planner.controller.alarms.consequences import ConsequenceGraph
from sequence_planner.controller.alarms.kinds import Cause
from sequence_planner.controller.alarms.registry import AlarmRegistry, Folding
from sequence_planner.controller.commands.alarms import (
    AcknowledgeAlarm,
    RestoreAlarm,
    ShelveAlarm,
    SuppressAlarm,
    UnshelveAlarm,
)
from sequence_planner.controller.commands.command import handles
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.station import AlarmGroup, AlarmState, AlarmView, Priority
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor

# What wants a person's attention, and what people do about it.

KEEP_EVERY = 86400.0  # seconds after which what is aside is told again, so that it is among what the journal keeps


_LASTS = (AlarmState.UNACKNOWLEDGED, AlarmState.ACKNOWLEDGED)  # those that are not over, nor set aside
_URGENT = (Priority.HIGH, Priority.MEDIUM)
_NOT_NAMED = (AlarmGroup.PEOPLE, AlarmGroup.COMMUNICATION)


def named_alarm(alarms: Mapping[str, AlarmView]) -> str | None:
    """Return the key of the alarm to name where help is needed and one alone has room: the most urgent one, as the
    pages order them.

    What people have a problem with is between them and the operators; of what is not heard it is told which devices
    that are, and no topics.
    """
    told = {
        key: (_URGENT.index(alarm.priority), _LASTS.index(alarm.state), -alarm.since)
        for key, alarm in alarms.items()
        if alarm.state in _LASTS and alarm.priority in _URGENT and alarm.group not in _NOT_NAMED
    }
    return min(told, key=lambda key: told[key], default=None)


class TellEvent(Protocol):
    """Whoever writes it down."""

    def __call__(self, kind: str, content: Mapping[str, JsonValue], *, lasts: bool = False) -> None:
        """Write down what has become of an alarm; what `lasts` is known again after a start."""


@runtime_checkable
class RaisesAlarms(Protocol):
    """A feature that has alarms."""

    def causes(self, moment: Timestamp) -> Iterable[Cause]:
        """The causes of alarms that there are now."""


class AlarmManager:
    """The alarms of a station. `tell` hears what becomes of each, for the journal; `expect` is called when somebody may
    soon ask for advice.

    `known` has those that were shelved or out of service before the controller was started.
    """

    def __init__(
        self,
        execution: Executor,
        outside: SafeStateMonitor,
        tell: TellEvent,
        known: RestoredState | None = None,
        expect: Callable[[], None] = lambda: None,
    ) -> None:
        self._outside = outside
        self._sources: Sequence[RaisesAlarms] = ()
        self._following = ConsequenceGraph(execution.automaton, self._touched)
        self._folding = Folding()
        self._lives = AlarmRegistry(self._told)
        self.shown: Mapping[str, AlarmView] = {}
        """The alarms as they were shown last."""
        self._tell = tell
        self._expect = expect
        self._kept: dict[str, Suppression] = {}
        self._kept_at = float("-inf")
        self._aside_before = {} if known is None else known.aside

    def look_at(self, features: Iterable[object]) -> None:
        """Look at those that have alarms, in this order."""
        self._sources = [feature for feature in features if isinstance(feature, RaisesAlarms)]

    def look(self, moment: Timestamp) -> None:
        """Take note of what is there now; often enough that nothing comes and goes unseen."""
        self._resume(moment)
        causes = [cause for source in self._sources for cause in source.causes(moment)]
        folded = self._folding.fold(self._following.trace(causes), self._lives.out_of_service, moment.monotonic)
        self._lives.observe(folded.alarms, folded.folded, moment)
        self._keep(moment)

    def current(self, moment: Timestamp) -> dict[str, AlarmView]:
        """All alarms now."""
        self.look(moment)
        self.shown = self._lives.view()
        return self.shown

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        alarms = self.current(moment)
        return {"alarms": alarms, "named_alarm": named_alarm(alarms)}

    @handles(AcknowledgeAlarm)
    def acknowledge(self, command: AcknowledgeAlarm, moment: Timestamp) -> None:
        """A person has seen the alarm."""
        self._lives.acknowledge(command.alarm, command.since, command.actor.name)
        self._keep(moment)

    @handles(ShelveAlarm)
    def shelve(self, command: ShelveAlarm, moment: Timestamp) -> None:
        """A person does not want to be told of the alarm for some time."""
        until = Timestamp(moment.epoch + command.seconds, moment.monotonic + command.seconds)
        self._lives.shelve(command.alarm, command.actor.name, command.reason, until)
        self._keep(moment)

    @handles(UnshelveAlarm)
    def unshelve(self, command: UnshelveAlarm, moment: Timestamp) -> None:
        """The alarm is told again."""
        self._lives.unshelve(command.alarm)
        self._keep(moment)

    @handles(SuppressAlarm)
    def suppress(self, command: SuppressAlarm, moment: Timestamp) -> None:
        """The alarm is out of service."""
        self._lives.suppress(command.alarm, command.actor.name, command.reason)
        self._keep(moment)

    @handles(RestoreAlarm)
    def restore(self, command: RestoreAlarm, moment: Timestamp) -> None:
        """The alarm is in service again."""
        self._lives.put_back(command.alarm)
        self._keep(moment)

    def _touched(self) -> frozenset[str]:
        """The variables for which the state is unsafe."""
        situation = self._outside.situation
        return frozenset() if situation is None or not situation.certain else self._outside.touched(situation)

    def _resume(self, moment: Timestamp) -> None:
        """Put aside again what was aside before the start."""
        before, self._aside_before = self._aside_before, {}
        for key, each in before.items():
            self._lives.put_aside(key, each.cause(key), each.aside(moment), moment)

    def _told(self, key: str, life: Alarm, event: str) -> None:
        view = life.view()
        if event == "came" and view.priority is not Priority.LOW:
            self._expect()
        self._tell("alarm", {"alarm": key, "event": event, **view.model_dump(mode="json")})

    def _keep(self, moment: Timestamp) -> None:
        """Tell what is aside when that has changed, and now and then."""
        kept = {key: life.aside for key, life in self._lives.aside.items() if life.aside is not None}
        old = moment.monotonic - self._kept_at > KEEP_EVERY
        if kept != self._kept or (old and kept):
            self._kept, self._kept_at = kept, moment.monotonic
            self._tell(KIND, aside_to_keep(self._lives.aside), lasts=True)
