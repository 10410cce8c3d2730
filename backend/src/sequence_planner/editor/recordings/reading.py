"""What a recording says of a station: its messages through the pipelines of a draft, as a controller hears them.

Time is that of the recording. What no message has said so far is as the model begins, which is not what a controller
takes it for: that of a station that runs knows nothing before it has heard something. Recorded commands are read as the
devices behind them read them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass
from typing import Final, NamedTuple

from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.io.inputs import Inputs, InputTopic
from sequence_planner.core.immutable import Immutable
from sequence_planner.editor.recordings.bag import NS, Bag, RecordedMessage, RecordedTopic
from sequence_planner.editor.recordings.files import RecordingError
from sequence_planner.editor.schemas.what_if import RecordedOtherwise, RecordedStanding, RecordingEnd
from sequence_planner.language.types import Value
from sequence_planner.process.budget import Budget
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.types.errors import MalformedMessageError
from sequence_planner.simulation.devices import CommandReader, NotUnderstoodError
from sequence_planner.station import ReadyStation
from sequence_planner.texts.message import message

MOST_MOMENTS: Final = 20_000
LOOKED_EVERY: Final = 64  # messages, after which it is looked whether there is time for more
MOST_AT_ONCE: Final = 100  # times that a stage has something to do at one moment; then it waits for the next message
AFTER: Final = 1e-6  # seconds after a deadline at which it has passed for certain, however floats are rounded


class SaidValue(NamedTuple):
    """The value of a variable at a moment, none where it is unknown, and whence it has it."""

    value: Value | None
    standing: RecordedStanding


class RecordedMoment(NamedTuple):
    """A moment, so many seconds after the recording began, at which variables have become others."""

    at: float
    changes: Mapping[str, tuple[SaidValue, SaidValue]]


class OtherTopic(Immutable):
    """A topic of the draft that was recorded as something else."""

    topic: RecordedTopic
    wanted: str
    difference: RecordedOtherwise


class RecordedTrouble(Immutable):
    """What made no sense in so many messages of a topic, and when for the first time."""

    topic: str
    text: str
    count: int
    first: float


@dataclass(frozen=True)
class RecordingReading:
    """All that a recording says with one draft; times are in seconds after it began, which is in seconds since the
    epoch.

    It was read until a moment, to its end unless it is `incomplete`.
    """

    began: float
    seconds: float
    until: float
    incomplete: RecordingEnd | None
    messages: int
    counts: Mapping[str, int]
    heard: tuple[RecordedTopic, ...]
    missing: tuple[str, ...]
    otherwise: tuple[OtherTopic, ...]
    others: tuple[RecordedTopic, ...]
    troubles: tuple[RecordedTrouble, ...]
    beginning: Mapping[str, SaidValue]
    moments: tuple[RecordedMoment, ...]

    def said_by(self, seconds: float) -> dict[str, SaidValue]:
        """Return what all messages until a moment say, and since when. Raises `RecordingError` for one that was not
        read.
        """
        if not 0 <= seconds <= self.until:
            raise RecordingError(message("recording.not-in-it", at=f"{seconds:g}", end=f"{self.until:g}"))
        said = dict(self.beginning)
        for moment in self.moments:
            if moment.at > seconds:
                break
            said.update((name, after) for name, (_, after) in moment.changes.items())
        return said

    def last_known(self, seconds: float) -> dict[str, tuple[Value, float]]:
        """Return the value that each variable had last by a moment while it was recorded, and since when."""
        known: dict[str, tuple[Value, float]] = {}
        for moment in self.moments:
            if moment.at > seconds:
                break
            for name, (_, after) in moment.changes.items():
                if after.standing is RecordedStanding.RECORDED and after.value is not None:
                    known[name] = after.value, moment.at
        return known


def read_recording(
    bag: Bag, station: ReadyStation, budget: Budget, most_moments: int = MOST_MOMENTS
) -> RecordingReading:
    """Read a recording with the pipelines of a station, as far as there is time for. Raises `RecordingError`."""
    choice = _chosen(bag, station)
    ear = _Ear(station, budget, most_moments)
    try:
        end = _seconds(bag.end, bag)
        with closing(bag.messages_of(choice.heard)) as heard:
            is_whole = all(ear.listen(each, _seconds(each.at, bag)) for each in heard) and ear.let_pass(end)
        incomplete = None if is_whole else RecordingEnd.TIME if budget.spent else RecordingEnd.MOMENTS
        until = end if is_whole else max(0.0, ear.now - AFTER) if ear.is_cut else ear.now
        moments = [each for each in ear.moments if each.at <= until]
        return RecordingReading(
            began=bag.begin / NS,
            seconds=end,
            until=until,
            incomplete=incomplete,
            messages=sum(ear.counts.values()),
            counts=ear.counts,
            heard=choice.heard,
            missing=choice.missing,
            otherwise=choice.otherwise,
            others=choice.others,
            troubles=tuple(ear.troubles()),
            beginning=ear.beginning,
            moments=tuple(moments),
        )
    finally:
        ear.close()


def _seconds(at: int, bag: Bag) -> float:
    return (at - bag.begin) / NS


class _Choice(NamedTuple):
    """The topics of a recording by what the draft has to do with them, and those of the draft that it lacks."""

    heard: tuple[RecordedTopic, ...]
    otherwise: tuple[OtherTopic, ...]
    others: tuple[RecordedTopic, ...]
    missing: tuple[str, ...]


def _chosen(bag: Bag, station: ReadyStation) -> _Choice:
    """Raises `RecordingError` where no topic of the draft is in the recording: it is one of another station."""
    incoming = station.pipelines.incoming
    types = {name: each.topic.type_name for name, each in incoming.items()}
    types |= {name: each.topic.type_name for name, each in station.pipelines.outgoing.items()}
    heard: dict[str, RecordedTopic] = {}
    otherwise: dict[str, OtherTopic] = {}
    for topic in bag.topics:
        if (wanted := types.get(topic.name)) is None:
            continue
        difference = _difference(topic, wanted, station)
        if difference is None:
            heard[topic.name] = topic
        else:
            otherwise[topic.name] = OtherTopic(topic, wanted, difference)
    if not heard and not otherwise:
        names = [each.name for each in bag.topics]
        if not incoming:
            raise RecordingError(message("recording.nothing-incoming"))
        raise RecordingError(message("recording.other-station", recorded=names, wanted=list(types)))
    return _Choice(
        tuple(heard.values()),
        tuple(each for name, each in otherwise.items() if name not in heard),
        tuple(each for each in bag.topics if each.name not in types),
        tuple(name for name in incoming if name not in heard and name not in otherwise),
    )


def _difference(topic: RecordedTopic, wanted: str, station: ReadyStation) -> RecordedOtherwise | None:
    if topic.type_name != wanted:
        return RecordedOtherwise.TYPE
    if topic.encoding != "cdr":
        return RecordedOtherwise.ENCODING
    if topic.type_hash is not None and topic.type_hash != station.registry.type_hash(wanted):
        return RecordedOtherwise.DEFINITION
    return None


class _Ear:
    """Hears messages as a controller does, and notes when measured variables become others, as long as the budget lasts
    and these are not too many.
    """

    def __init__(self, station: ReadyStation, budget: Budget, most_moments: int) -> None:
        pipelines, automaton = station.pipelines, station.automaton
        self._station = station
        self._budget, self._most_moments = budget, most_moments
        self._inputs = Inputs(pipelines, station.registry, automaton.initial_valuation, patient=True)
        self._running = self._inputs.running
        self._spoken = dict.fromkeys(pipelines.sources, False)
        measured = automaton.names(Kind.MEASURED)
        self._feeds = {name: feed for name, feed in pipelines.feeds.items() if name in measured}
        self.beginning = {
            name: SaidValue(automaton.initial_valuation.get(name), RecordedStanding.NOT_RECORDED) for name in measured
        }
        self._commands = _readers(station)
        self.beginning |= {
            name: SaidValue(automaton.initial_valuation.get(name), RecordedStanding.NOT_RECORDED)
            for names, _ in self._commands.values()
            for name in names
        }
        self._said = dict(self.beginning)
        self._reports = self._inputs.reports
        self._commanded: dict[str, bytes] = {}  # the last message of each topic
        self._timed = {name: each for name, each in self._inputs.topics.items() if each.pipeline.deadline is not None}
        self._expired: set[str] = set()
        self._looked = 0
        self.is_cut = False
        self.now = 0.0
        self.moments: list[RecordedMoment] = []
        self.counts: dict[str, int] = {}

    def listen(self, each: RecordedMessage, at: float) -> bool:
        """Hear a message, where what is due before it can happen; whether it could."""
        if not self._goes_on() or not self.let_pass(at):
            self.is_cut = at <= self.now  # within a moment
            return False
        self.counts[each.topic] = self.counts.get(each.topic, 0) + 1
        if each.topic not in self._inputs.topics:
            self._take_command(each, at)
            return True
        feed = self._inputs.topics[each.topic]
        says_the_same = _repeats(feed, each, at) and self._running.repeats[each.topic]
        self._inputs.take([Sample(each.topic, each.data, at, trouble=each.trouble)])
        self._expired.discard(each.topic)
        if not says_the_same:
            self._spoken[each.topic] = True
            self._inputs.wake(at)
            self._note(at)
        return True

    def _take_command(self, each: RecordedMessage, at: float) -> None:
        """Note what a message of an outgoing topic commands; one that makes no sense commands nothing new."""
        if each.topic not in self._commands or self._commanded.get(each.topic) == each.data:
            return
        self._commanded[each.topic] = each.data
        names, reader = self._commands[each.topic]
        type_name = self._station.pipelines.outgoing[each.topic].topic.type_name
        try:
            values, troubles = reader.read(self._station.registry.decode(type_name, each.data))
        except MalformedMessageError as error:
            values, troubles = {}, [str(error)]
        if trouble := each.trouble or "; ".join(troubles):
            self._reports.note(each.topic, trouble, at)
        known = {name: value for name in names if (value := values.get(name)) is not None}
        self._become({name: SaidValue(value, RecordedStanding.RECORDED) for name, value in known.items()}, at)

    def let_pass(self, until: float) -> bool:
        """Let time pass until a moment; whether it could. All that is due before happens."""
        at_once = 0
        while (due := self._due(at_once < MOST_AT_ONCE)) is not None and due < until:
            if not self._goes_on():
                return False
            at_once = at_once + 1 if due <= self.now else 0
            self.now = max(self.now, due)
            self._expired |= {name for name, each in self._timed.items() if not each.fresh(self.now)}
            self._inputs.wake(self.now)
            self._note(self.now)
        self.now = max(self.now, until)
        return True

    def troubles(self) -> Iterator[RecordedTrouble]:
        """Yield what made no sense."""
        for topic, cause in self._inputs.reports.every_report():
            yield RecordedTrouble(topic, cause.text, cause.count, cause.first)

    def close(self) -> None:
        """End what stages have started beside."""
        self._running.close()

    def _goes_on(self) -> bool:
        self._looked += 1
        if len(self.moments) >= self._most_moments:
            return False
        return self._looked % LOOKED_EVERY != 0 or not self._budget.spent

    def _due(self, of_stages: bool) -> float | None:
        """Return when time alone makes the next difference: to deadlines, and in stages."""
        ends = (
            each.last + (each.pipeline.deadline or 0.0) + AFTER
            for name, each in self._timed.items()
            if each.last is not None and name not in self._expired
        )
        stages = self._inputs.due if of_stages else None
        return min((each for each in (*ends, stages) if each is not None), default=None)

    def _note(self, at: float) -> None:
        """Note which variables are others now."""
        values = self._inputs.measured(at)
        fresh = {name: each.fresh(at) for name, each in self._sources()}
        became: dict[str, SaidValue] = {}
        standings: dict[str, RecordedStanding] = {}
        for name, feed in self._feeds.items():
            standing = standings.get(feed)
            if standing is None:
                standing = standings[feed] = self._standing(feed, fresh)
            if standing is RecordedStanding.NOT_RECORDED:
                continue
            became[name] = SaidValue(values.get(name), standing)
        self._become(became, at)

    def _become(self, became: Mapping[str, SaidValue], at: float) -> None:
        """Note what is otherwise now."""
        changes = {name: (self._said[name], said) for name, said in became.items() if said != self._said[name]}
        self._said.update(became)
        if changes and self.moments and self.moments[-1].at == at:
            changes = _together(self.moments.pop().changes, changes)
        if changes:
            self.moments.append(RecordedMoment(at, changes))

    def _sources(self) -> Iterable[tuple[str, InputTopic]]:
        return (*self._inputs.topics.items(), *self._inputs.answers.items())

    def _standing(self, feed: str, fresh: Mapping[str, bool]) -> RecordedStanding:
        if not self._running.is_fresh(feed, self._spoken):
            return RecordedStanding.NOT_RECORDED
        return RecordedStanding.RECORDED if self._running.is_fresh(feed, fresh) else RecordedStanding.STALE


def _readers(station: ReadyStation) -> dict[str, tuple[tuple[str, ...], CommandReader]]:
    """Return who reads the commands of each topic, with the outputs that they say; none where they cannot be read."""
    outputs, found = station.automaton.outputs, {}
    for name, pipeline in station.pipelines.outgoing.items():
        try:
            reader = CommandReader(pipeline, station.automaton)
        except NotUnderstoodError:
            continue
        if names := tuple(sorted(reader.variables & outputs)):
            found[name] = names, reader
    return found


def _repeats(feed: InputTopic, each: RecordedMessage, at: float) -> bool:
    """Return whether a message says what the one before has said, which still counts."""
    return feed.data is not None and feed.data == each.data and not each.trouble and feed.fresh(at)


def _together(
    earlier: Mapping[str, tuple[SaidValue, SaidValue]], later: Mapping[str, tuple[SaidValue, SaidValue]]
) -> dict[str, tuple[SaidValue, SaidValue]]:
    """Return what all changes of a moment come to."""
    merged = dict(earlier)
    for name, (before, after) in later.items():
        merged[name] = (merged[name][0] if name in merged else before), after
    return {name: (before, after) for name, (before, after) in merged.items() if before != after}
