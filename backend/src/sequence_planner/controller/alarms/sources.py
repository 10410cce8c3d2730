"""What others know of which alarms tell, brought to the alarms at each look."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from pydantic import JsonValue

from sequence_planner.controller.alarms.alarm import KIND as ASIDE
from sequence_planner.controller.alarms.alarm import aside_again
from sequence_planner.controller.alarms.manager import AlarmManager
from sequence_planner.controller.features.records import Records
from sequence_planner.controller.features.tasks import TaskHandler
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.ticks import Ticker
from sequence_planner.controller.recovery.consistency import ConsistencyMonitor
from sequence_planner.controller.recovery.manual import ByHand
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.recovery.who_can import in_thread
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.station import AlarmView, Priority
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor


@dataclass(frozen=True)
class AlarmSources:
    """Those who know, and the alarms; `trouble` says what is wrong with the planner."""

    alarms: AlarmManager
    records: Records
    ticker: Ticker
    tasks: TaskHandler
    consistency: ConsistencyMonitor
    by_hand: ByHand
    trouble: Callable[[], str | None]

    def update(self, moment: Timestamp) -> None:
        """Take note of what there is now; often enough that nothing comes and goes unseen."""
        alarms, tasks = self.alarms, self.tasks
        alarms.restless = self.ticker.restless
        alarms.unjournalled, alarms.kept = self.records.trouble, self.records.beside
        alarms.undecided = self.consistency.told(alarms.untold)
        alarms.questions = self.consistency.questions
        alarms.problems = {id_: (tasks.open[id_].ability, each) for id_, each in tasks.problems.items()}
        alarms.moved = self.by_hand.notices(moment.monotonic)
        alarms.look(self.trouble(), moment)

    def current(self, moment: Timestamp) -> dict[str, AlarmView]:
        """All alarms now."""
        return self.alarms.current(self.trouble(), moment)


def build_alarms(
    execution: Executor,
    outside: SafeStateMonitor,
    devices: Devices,
    records: Records,
    failures: dict[str, str],
    known: RestoredState,
    expect: Callable[[], None],
) -> AlarmManager:
    """Build the alarms, which the journal has too; `expect` is called when somebody may soon ask for advice."""

    def keep_note(kind: str, content: Mapping[str, JsonValue]) -> None:
        if kind == "alarm" and content["event"] == "came" and content["priority"] != Priority.LOW:
            expect()
        records.add_note(kind, content, lasts=kind == ASIDE)

    alarms = AlarmManager(
        execution, outside, devices.feeds, devices.network, devices.commander, keep_note, known, in_thread
    )
    alarms.failures = failures
    records.recorder.know(ASIDE, aside_again(known.aside))
    return alarms
