"""Life of all alarms of a station: alarms that come and go, one alarm for one cause, and what people do about them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace

from sequence_planner.controller.alarms.alarm import Alarm, Suppression, most_urgent, needs_acknowledgement, urgency
from sequence_planner.controller.alarms.kinds import Cause
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.views.station import AlarmView, Priority
from sequence_planner.core.clock import Timestamp
from sequence_planner.texts.message import Message, message

# Alarms that come and go: one that does so often is one alarm that lasts.

OFTEN = 3  # times that an alarm comes ..
WITHIN = 60.0  # .. in so many seconds: then it comes and goes
QUIET = 15.0  # seconds for which the cause of such an alarm must be away before it counts as gone


class Arrivals:
    """The times at which alarms have come, as long as these matter; also of those that are gone by now. On the
    monotonic clock.
    """

    def __init__(self) -> None:
        self._times: dict[str, deque[float]] = {}

    def note(self, key: str, monotonic: float) -> None:
        """The cause of an alarm has come."""
        self._times.setdefault(key, deque(maxlen=OFTEN)).append(monotonic)

    def quiet(self, key: str) -> float:
        """For how many seconds its cause must be away, so that the alarm counts as gone."""
        times = self._times.get(key)
        often = times is not None and len(times) == OFTEN and times[-1] - times[0] <= WITHIN
        return QUIET if often else 0.0

    def forget(self, monotonic: float) -> None:
        """Drop what is too old to matter."""
        old = [key for key, times in self._times.items() if monotonic - times[-1] > WITHIN + QUIET]
        for key in old:
            del self._times[key]


# Flood protection: one cause, one alarm. What follows from a cause is a part of its alarm.
#
# What follows can outlast its cause for a moment: when a network comes back, its devices speak one after the other. So
# an alarm lasts until nothing of what followed is left, but not much longer than its cause.

LINGERS = 10.0  # seconds that an alarm lasts longer than its cause at most, for what followed from it


@dataclass(frozen=True)
class Folded:
    """`alarms` by key, each with all its parts; `folded` are the keys of those that are parts."""

    alarms: Mapping[str, Cause]
    folded: frozenset[str]


class Folding:
    """Remembers which alarms had parts, and since when their causes are over."""

    def __init__(self) -> None:
        self._had_parts: dict[str, Cause] = {}
        self._over: dict[str, float] = {}
        self._part_of: dict[str, str] = {}

    def fold(self, causes: Iterable[Cause], alone: Collection[str], monotonic: float) -> Folded:
        """Return what is an alarm now. To those that stand `alone` nothing is added."""
        present = {cause.key: cause for cause in causes}
        lingering = self._lingering(present, monotonic)
        present = {key: self._as_before(cause, lingering) for key, cause in present.items()}
        bearing = {key: cause for key, cause in {**present, **lingering}.items() if key not in alone}
        parts: dict[str, list[Cause]] = {}
        folded: set[str] = set()
        for key, cause in present.items():
            top = _top(cause, bearing)
            # Of causes that follow from one another one is told.
            if top != key and top not in folded and key not in parts:
                parts.setdefault(top, []).append(cause)
                folded.add(key)
        self._part_of = {cause.key: top for top, every in parts.items() for cause in every}
        alarms = {key: _with(cause, parts.get(key, ())) for key, cause in present.items() if key not in folded}
        over = {key: _with(_over(cause, parts[key]), parts[key]) for key, cause in lingering.items() if key in parts}
        told = {**alarms, **over}
        # What followed, and is over before the alarm is, is told once it is over too.
        self._had_parts = {key: replace(bearing[key], past_parts=told[key].past_parts) for key in parts}
        return Folded(told, frozenset(folded))

    def _as_before(self, cause: Cause, lingering: Collection[str]) -> Cause:
        """The cause, which still follows from what is over: of that nobody says any more what follows from it."""
        before = self._part_of.get(cause.key)
        return cause if before is None or before not in lingering else replace(cause, follows=(*cause.follows, before))

    def _lingering(self, present: Mapping[str, Cause], monotonic: float) -> dict[str, Cause]:
        gone = {key: cause for key, cause in self._had_parts.items() if key not in present}
        self._over = {key: self._over.get(key, monotonic) for key in gone}
        return {key: cause for key, cause in gone.items() if monotonic - self._over[key] < LINGERS}


def _top(cause: Cause, bearing: Mapping[str, Cause]) -> str:
    """The key of the cause from which this one follows in the end; its own where it follows from none that is there."""
    seen = {cause.key}
    while (above := next((key for key in cause.follows if key in bearing and key not in seen), None)) is not None:
        seen.add(above)
        cause = bearing[above]
    return cause.key


def _with(cause: Cause, parts: Iterable[Cause]) -> Cause:
    """The alarm with what follows from its cause. It is as urgent as the most urgent of it."""
    every = list(parts)
    texts = [text for part in every for text in (part.parts or (part.text,))]
    past = [text for part in every for text in (part.past_parts or (part.past,))]
    return replace(
        cause,
        priority=most_urgent(cause.priority, *(part.priority for part in every)),
        parts=_once((*cause.parts, *texts)),
        past_parts=_once((*cause.past_parts, *past)),
    )


def _once(messages: Iterable[Message]) -> tuple[Message, ...]:
    return tuple({str(each): each for each in messages}.values())


def _over(cause: Cause, left: Iterable[Cause]) -> Cause:
    """The cause as it is told when it is over and what followed is not: what is `left` says what comes of it."""
    worst = max(left, key=lambda part: urgency(part.priority))
    return replace(
        cause,
        priority=worst.priority,
        text=message("over", past=cause.past),
        consequence=worst.consequence,
        action=worst.action,
        parts=(),
    )


# All alarms of a station, each with its life: what comes and goes, and what people do about it.

Tell = Callable[[str, Alarm, str], None]  # key, life, what has become of it


class AlarmRegistry:
    """Every alarm by its key. `told` hears of each change in the life of one."""

    def __init__(self, told: Tell) -> None:
        self._lives: dict[str, Alarm] = {}
        self._arrivals = Arrivals()
        self._told = told

    def put_aside(self, key: str, cause: Cause, aside: Suppression, moment: Timestamp) -> None:
        """An alarm was aside before the controller was started, and still is."""
        self._lives[key] = Alarm(cause, moment.epoch, acknowledged=True, count=0, away=moment, ended=moment.epoch)
        self._lives[key].aside = aside

    @property
    def out_of_service(self) -> frozenset[str]:
        """The alarms that are out of service."""
        return frozenset(
            key for key, life in self._lives.items() if life.aside is not None and life.aside.until is None
        )

    @property
    def aside(self) -> dict[str, Alarm]:
        """Those that are shelved or out of service."""
        return {key: life for key, life in self._lives.items() if life.aside is not None}

    def view(self) -> dict[str, AlarmView]:
        """Those that are shown, as they are shown."""
        return {key: life.view() for key, life in self._lives.items() if life.shown}

    def observe(self, causes: Mapping[str, Cause], folded: Collection[str], moment: Timestamp) -> None:
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
        """A person has seen the alarm that came then; of a notice that nobody has to, somebody has looked at it."""
        life = self._find(key)
        if life.aside is not None:
            state = message(f"alarm-state.{life.state}")
            raise CommandRefused("alarm-set-aside", message("refused.alarm-set-aside.state", state=state))
        if life.since != since:
            raise CommandRefused("alarm-recurred", message("refused.alarm-recurred.look"))
        if life.by is None:
            life.acknowledge(by)
            self._tell(key, life, "acknowledged")
            self._drop_if_over(key, life)

    def shelve(self, key: str, by: str, why: str, until: Timestamp) -> None:
        """A person does not want to be told of it until then."""
        life = self._find(key)
        if life.aside is not None and life.aside.until is None:
            raise CommandRefused("alarm-set-aside", message("refused.alarm-set-aside.out-of-service"))
        self._put_aside(key, life, Suppression(by, why, until), "shelved")

    def suppress(self, key: str, by: str, why: str) -> None:
        """An engineer takes it out of service."""
        self._put_aside(key, self._find(key), Suppression(by, why, None), "taken out of service")

    def unshelve(self, key: str) -> None:
        """It is told again."""
        life = self._find(key)
        if life.aside is None or life.aside.until is None:
            state = message(f"alarm-state.{life.state}")
            raise CommandRefused("alarm-not-shelved", message("refused.alarm-not-shelved.state", state=state))
        self._take_back(key, life, "unshelved")

    def put_back(self, key: str) -> None:
        """Tell again what is out of service."""
        life = self._find(key)
        if life.aside is None or life.aside.until is not None:
            state = message(f"alarm-state.{life.state}")
            raise CommandRefused("alarm-in-service", message("refused.alarm-in-service.state", state=state))
        self._take_back(key, life, "put back in service")

    def _find(self, key: str) -> Alarm:
        life = self._lives.get(key)
        if life is None or not life.shown:
            raise CommandRefused("alarm-gone", message("refused.alarm-gone.look"))
        return life

    def _put_aside(self, key: str, life: Alarm, aside: Suppression, event: str) -> None:
        if life.cause.priority is Priority.HIGH:
            raise CommandRefused("alarm-too-urgent", message("refused.alarm-too-urgent.high"))
        life.aside, life.worst = aside, life.cause.priority
        self._tell(key, life, event)

    def _take_back(self, key: str, life: Alarm, event: str) -> None:
        life.aside = None
        life.must_be_seen()
        if life.ended is not None:
            del self._lives[key]
        self._tell(key, life, event)

    def _come(self, key: str, cause: Cause, moment: Timestamp) -> None:
        self._arrivals.note(key, moment.monotonic)
        life = self._lives[key] = Alarm(cause, moment.epoch)
        life.must_be_seen()
        self._tell(key, life, "came")

    def _last(self, key: str, life: Alarm, cause: Cause, moment: Timestamp) -> None:
        """The cause of an alarm is there, still or again; perhaps it has become more urgent."""
        is_worse = urgency(cause.priority) > urgency(life.worst)
        if cause.phase != life.cause.phase:
            life.since = moment.epoch
        if not needs_acknowledgement(cause) and cause.text != life.cause.text:
            life.by = None  # nobody has looked at what it tells now
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

    def _join(self, key: str, life: Alarm) -> None:
        """It is told as a part of another, and is afterwards what it was."""
        if not life.part:
            life.part = True
            self._tell(key, life, "became part of another")

    def _go(self, key: str, life: Alarm, moment: Timestamp) -> None:
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

    def _drop_if_over(self, key: str, life: Alarm) -> None:
        if life.over:
            del self._lives[key]

    def _end_shelving(self, key: str, life: Alarm, moment: Timestamp) -> None:
        until = None if life.aside is None else life.aside.until
        if until is not None and moment.monotonic >= until.monotonic:
            self._take_back(key, life, "is shelved no longer")

    def _tell(self, key: str, life: Alarm, event: str) -> None:
        self._told(key, life, event)
