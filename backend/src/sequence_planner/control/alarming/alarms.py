"""What wants a person's attention, and what people do about it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from pydantic import JsonValue

from sequence_planner.control.alarm_commands import (
    AcknowledgeAlarm,
    AlarmCommand,
    RestoreAlarm,
    ShelveAlarm,
    SuppressAlarm,
    UnshelveAlarm,
)
from sequence_planner.control.alarm_view import AlarmView
from sequence_planner.control.alarming.folding import Folding
from sequence_planner.control.alarming.following import Following
from sequence_planner.control.alarming.keeping import KIND, aside_to_keep
from sequence_planner.control.alarming.life import Aside, Life
from sequence_planner.control.alarming.lives import Lives
from sequence_planner.control.alarming.of_devices import DeviceAlarms
from sequence_planner.control.alarming.of_plans import PlanAlarms
from sequence_planner.control.alarming.of_station import StationAlarms
from sequence_planner.control.commander import Commander
from sequence_planner.control.execution import Execution
from sequence_planner.control.feeds import Feeds
from sequence_planner.control.known import Known
from sequence_planner.control.moment import Moment
from sequence_planner.control.network_watch import NetworkWatch
from sequence_planner.control.outside import Outside
from sequence_planner.control.standing_still import StandingStill
from sequence_planner.control.vocabulary import ServiceKind
from sequence_planner.control.who_can import Run, WhoCan, at_once

Tell = Callable[[str, Mapping[str, JsonValue]], None]
KEEP_EVERY = 86400.0  # seconds after which what is aside is told again, so that it is among what the journal keeps


class Alarms(StationAlarms):
    """The alarms of a station. `tell` hears what becomes of each, for the journal.

    `known` has those that were shelved or out of service before the controller was started. `run` is where it is found
    out who can do what.
    """

    def __init__(
        self,
        execution: Execution,
        outside: Outside,
        feeds: Feeds,
        network: NetworkWatch,
        commander: Commander,
        tell: Tell,
        known: Known | None = None,
        run: Run = at_once,
    ) -> None:
        known = known or Known()
        undone = known.deployment if known.deployment and known.deployment.why is not None else None
        super().__init__(execution, outside, known, undone)
        self.who_can = WhoCan(execution, run)
        self._devices = DeviceAlarms(execution, feeds, network, commander, self.who_can)
        self.still = StandingStill(execution, lambda: outside.certain)
        self._plans = PlanAlarms(execution, feeds, self.still, self.who_can)
        self._following = Following(execution.automaton, self._touched)
        self._folding = Folding()
        self._lives = Lives(self._told)
        self._tell = tell
        self._kept: dict[str, Aside] = {}
        self._kept_at = float("-inf")
        self._aside_before = known.aside

    def look(self, planner_trouble: str | None, moment: Moment) -> None:
        """Take note of what is there now; often enough that nothing comes and goes unseen."""
        self._resume(moment)
        unused = self._execution.conduct.out_of(ServiceKind.RESOURCE)
        self.who_can.look(self._devices.untold, moment.monotonic)
        of_devices = tuple(self._devices.causes(moment, unused))
        of_plans = self._plans.causes(planner_trouble, moment.monotonic, self._devices.untold)
        causes = (*of_devices, *of_plans, *self.causes())
        folded = self._folding.fold(self._following.trace(causes), self._lives.out_of_service, moment.monotonic)
        self._lives.look(folded.alarms, folded.folded, moment)
        self._keep(moment)

    def current(self, planner_trouble: str | None, moment: Moment) -> dict[str, AlarmView]:
        """All alarms now."""
        self.look(planner_trouble, moment)
        return self._lives.view()

    @property
    def untold(self) -> Collection[str]:
        """The resources whose silence is too young to be told."""
        return self._devices.untold

    def carry_out(self, command: AlarmCommand, moment: Moment) -> None:
        """Do what a person asks for. Raises `CommandRefused`; nothing has changed then."""
        key, by = command.alarm, command.actor.name
        match command:
            case AcknowledgeAlarm(since=since):
                self._lives.acknowledge(key, since, by)
            case ShelveAlarm(seconds=seconds, reason=why):
                until = Moment(moment.epoch + seconds, moment.monotonic + seconds)
                self._lives.shelve(key, by, why, until)
            case UnshelveAlarm():
                self._lives.unshelve(key)
            case SuppressAlarm(reason=why):
                self._lives.suppress(key, by, why)
            case RestoreAlarm():
                self._lives.restore(key)
        self._keep(moment)

    def _touched(self) -> frozenset[str]:
        """The variables for which the state is unsafe."""
        situation = self._outside.situation
        return frozenset() if situation is None or not situation.certain else self._outside.touched(situation)

    def _resume(self, moment: Moment) -> None:
        """What was aside before the start is so again."""
        before, self._aside_before = self._aside_before, {}
        for key, each in before.items():
            self._lives.put_aside(key, each.cause(key), each.aside(moment), moment)

    def _told(self, key: str, life: Life, event: str) -> None:
        view = life.view()
        self._tell("alarm", {"alarm": key, "event": event, **view.model_dump(mode="json")})

    def _keep(self, moment: Moment) -> None:
        """Tell what is aside when that has changed, and now and then."""
        kept = {key: life.aside for key, life in self._lives.aside.items() if life.aside is not None}
        old = moment.monotonic - self._kept_at > KEEP_EVERY
        if kept != self._kept or (old and kept):
            self._kept, self._kept_at = kept, moment.monotonic
            self._tell(KIND, aside_to_keep(self._lives.aside))
