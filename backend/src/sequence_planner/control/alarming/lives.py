"""All alarms of a station, each with its life: what comes and goes, and what people do about it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from sequence_planner.control.alarm_view import AlarmView, Priority
from sequence_planner.control.alarming.cause import Cause, urgency
from sequence_planner.control.alarming.chattering import Arrivals
from sequence_planner.control.alarming.life import Aside, Life
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.moment import Moment

Tell = Callable[[str, Life, str], None]  # key, life, what has become of it


class Lives:
    """Every alarm by its key. `told` hears of each change in the life of one."""

    def __init__(self, told: Tell) -> None:
        self._lives: dict[str, Life] = {}
        self._arrivals = Arrivals()
        self._told = told

    def put_aside(self, key: str, cause: Cause, aside: Aside, moment: Moment) -> None:
        """An alarm was aside before the controller was started, and still is."""
        self._lives[key] = Life(cause, moment.epoch, acknowledged=True, count=0, away=moment, ended=moment.epoch)
        self._lives[key].aside = aside

    @property
    def out_of_service(self) -> frozenset[str]:
        """The alarms that are out of service."""
        return frozenset(
            key for key, life in self._lives.items() if life.aside is not None and life.aside.until is None
        )

    @property
    def aside(self) -> dict[str, Life]:
        """Those that are shelved or out of service."""
        return {key: life for key, life in self._lives.items() if life.aside is not None}

    def view(self) -> dict[str, AlarmView]:
        """Those that are shown, as they are shown."""
        return {key: life.view() for key, life in self._lives.items() if life.shown}

    def look(self, causes: Mapping[str, Cause], folded: Collection[str], moment: Moment) -> None:
        """Take note of which causes are there now, and which of them are `folded` into alarms of others."""
        for key, cause in causes.items():
            life = self._lives.get(key)
            if life is None:
                self._come(key, cause, moment)
            else:
                self._last(key, life, cause, moment)
        for key, life in list(self._lives.items()):
            if key not in causes and key in folded:
                self._join(key, life)
            elif key not in causes:
                self._go(key, life, moment)
            self._end_shelving(key, life, moment)
        self._arrivals.forget(moment.monotonic)

    def acknowledge(self, key: str, since: float, by: str) -> None:
        """A person has seen the alarm that came then."""
        life = self._find(key)
        if life.aside is not None:
            detail = f"It is {life.state}, so nobody has to acknowledge it."
            raise _refused("alarm-aside", "The alarm is put aside", detail)
        if life.since != since:
            raise _refused("alarm-came-again", "The alarm has come again", "Look at it, then acknowledge this one.")
        if not life.acknowledged:
            life.acknowledge(by)
            self._tell(key, life, "acknowledged")
            self._drop_if_over(key, life)

    def shelve(self, key: str, by: str, why: str, until: Moment) -> None:
        """A person does not want to be told of it until then."""
        life = self._find(key)
        if life.aside is not None and life.aside.until is None:
            raise _refused("alarm-aside", "The alarm is put aside", "It is out of service: an engineer can restore it.")
        self._put_aside(key, life, Aside(by, why, until), "shelved")

    def suppress(self, key: str, by: str, why: str) -> None:
        """An engineer takes it out of service."""
        self._put_aside(key, self._find(key), Aside(by, why, None), "taken out of service")

    def unshelve(self, key: str) -> None:
        """It is told again."""
        life = self._find(key)
        if life.aside is None or life.aside.until is None:
            raise _refused(
                "alarm-not-shelved", "The alarm is not shelved", f"It is {life.state}: nothing has to be done."
            )
        self._take_back(key, life, "unshelved")

    def restore(self, key: str) -> None:
        """What is out of service is told again."""
        life = self._find(key)
        if life.aside is None or life.aside.until is not None:
            raise _refused(
                "alarm-in-service", "The alarm is in service", f"It is {life.state}: nothing has to be done."
            )
        self._take_back(key, life, "put back in service")

    def _find(self, key: str) -> Life:
        life = self._lives.get(key)
        if life is None or not life.shown:
            raise _refused("alarm-gone", "The alarm is gone", "Look at the alarms that there are now.")
        return life

    def _put_aside(self, key: str, life: Life, aside: Aside, event: str) -> None:
        if life.cause.priority is Priority.HIGH:
            detail = "One of high priority can be acknowledged, but is told as long as its cause lasts."
            raise _refused("alarm-too-urgent", "The alarm is too urgent to be put aside", detail)
        life.aside, life.worst = aside, life.cause.priority
        self._tell(key, life, event)

    def _take_back(self, key: str, life: Life, event: str) -> None:
        life.aside = None
        life.must_be_seen()
        if life.ended is not None:
            del self._lives[key]
        self._tell(key, life, event)

    def _come(self, key: str, cause: Cause, moment: Moment) -> None:
        self._arrivals.note(key, moment.monotonic)
        life = self._lives[key] = Life(cause, moment.epoch)
        life.must_be_seen()
        self._tell(key, life, "came")

    def _last(self, key: str, life: Life, cause: Cause, moment: Moment) -> None:
        """The cause of an alarm is there, still or again; perhaps it has become more urgent."""
        is_worse = urgency(cause.priority) > urgency(life.worst)
        was_part, life.part, life.cause = life.part, False, cause
        if life.away is not None:
            self._arrivals.note(key, moment.monotonic)
            life.come(moment.epoch, lasts=life.ended is None)
            self._tell(key, life, "came again")
        if is_worse:
            if cause.priority is Priority.HIGH:
                life.aside = None
            life.must_be_seen()
            self._tell(key, life, "became more urgent")
        elif was_part:
            self._tell(key, life, "stands by itself")

    def _join(self, key: str, life: Life) -> None:
        """It is told as a part of another, and is afterwards what it was."""
        if not life.part:
            life.part = True
            self._tell(key, life, "became part of another")

    def _go(self, key: str, life: Life, moment: Moment) -> None:
        """The cause of an alarm is away; that counts when it has been for long enough."""
        # As a part it was told with another alarm, and that is what a person takes note of.
        life.acknowledged, life.part = life.acknowledged or life.part, False
        if life.ended is None:
            life.away = life.away or moment
            if moment.monotonic - life.away.monotonic < self._arrivals.quiet(key):
                return
            life.ended = life.away.epoch
            self._tell(key, life, "ended" if life.over else "returned")
        self._drop_if_over(key, life)

    def _drop_if_over(self, key: str, life: Life) -> None:
        if life.over:
            del self._lives[key]

    def _end_shelving(self, key: str, life: Life, moment: Moment) -> None:
        until = None if life.aside is None else life.aside.until
        if until is not None and moment.monotonic >= until.monotonic:
            self._take_back(key, life, "is shelved no longer")

    def _tell(self, key: str, life: Life, event: str) -> None:
        self._told(key, life, event)


def _refused(slug: str, title: str, detail: str) -> CommandRefused:
    return CommandRefused(slug, title, detail)
