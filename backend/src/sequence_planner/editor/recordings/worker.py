"""Answers what recordings say, in a process that keeps the draft and what it has read last."""

from __future__ import annotations

import resource
from bisect import bisect_right
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Final

from sequence_planner.editor.processes import encoded
from sequence_planner.editor.recordings.bag import Bag, RecordedTopic
from sequence_planner.editor.recordings.files import RecordingError, lay_out
from sequence_planner.editor.recordings.reading import RecordedMoment, RecordingReading, read_recording
from sequence_planner.editor.schemas.what_if import (
    MissingTopicView,
    OtherTopicView,
    RecordedChangeView,
    RecordedMomentView,
    RecordedStateView,
    RecordedTopicView,
    RecordedTrafficView,
    RecordedTroubleView,
    RecordedVariableView,
    transferred,
)
from sequence_planner.editor.usable import KeptDraft, UnusableModelError, station_of
from sequence_planner.process.budget import Budget
from sequence_planner.process.memory_limit import memory_limit
from sequence_planner.station import ReadyStation
from sequence_planner.texts.message import Message, message

READ_WITHIN: Final = 40.0  # seconds of work; what was read by then is told
MOST_SHOWN: Final = 2000  # moments at once
MOST_OTHERS: Final = 200  # topics that the draft has no use for
_GB: Final = 1 << 30

# Of a recording: its id, what it is called, its bytes, and the folder in which it is laid out.
Kept = tuple[str, str, int, Path]
RecordingQuestion = tuple[Mapping[str, str | None], str, tuple[object, ...]]


class RecordingService:
    """Reads recordings with a draft that it keeps in `folder`."""

    def __init__(self, folder: Path) -> None:
        self._draft = KeptDraft(folder, station_of)
        self._news: dict[str, str | None] = {}  # of the draft, that no answer has needed so far
        self._read: tuple[ReadyStation, str, RecordingReading] | None = None

    def found_for(self, question: RecordingQuestion) -> RecordedTrafficView | RecordedStateView | None:
        """Return what a question asks for. Raises `RecordingError`."""
        changed, name, asked = question
        self._news |= changed
        return _ANSWERS[name](self, *asked)

    def lay_out(self, source: Path, name: str, folder: Path, most: int) -> None:
        """Lay out a recording that has come."""
        lay_out(source, name, folder, most)

    def overview(self, number: int, stages: Path, kept: Kept, since: float) -> RecordedTrafficView:
        """Return what a recording has for the draft, with its moments after one."""
        meant = self._meant(stages)
        if isinstance(meant, UnusableModelError):
            return unread_view(number, kept, meant.why)
        return recording_view(number, kept, meant, self._reading(meant, kept), since)

    def recorded_state(self, number: int, stages: Path, kept: Kept, at: float) -> RecordedStateView:
        """Return the state of the draft at a moment of a recording."""
        meant = self._meant(stages)
        if isinstance(meant, UnusableModelError):
            return RecordedStateView(id=kept[0], number=number, at=at, obstacle=meant.why, values={}, variables=[])
        return state_view(number, kept[0], meant, self._reading(meant, kept), at)

    def _meant(self, stages: Path) -> ReadyStation | UnusableModelError:
        news, self._news = self._news, {}
        return self._draft.meant(news, stages)

    def _reading(self, station: ReadyStation, kept: Kept) -> RecordingReading:
        id, name, _, folder = kept
        if self._read is None or self._read[0] is not station or self._read[1] != id:
            self._read = None  # there is room for one
            try:
                with Bag(folder) as bag:
                    self._read = station, id, read_recording(bag, station, Budget.seconds(READ_WITHIN))
            except MemoryError:
                raise RecordingError(message("recording.memory", file=name)) from None
        return self._read[2]


_ANSWERS: Mapping[str, Callable[..., RecordedTrafficView | RecordedStateView | None]] = {
    each.__name__: each
    for each in (RecordingService.lay_out, RecordingService.overview, RecordingService.recorded_state)
}


def unread_view(number: int, kept: Kept, why: Message) -> RecordedTrafficView:
    """A recording that cannot be read, as the draft cannot be used."""
    id, name, size, _ = kept
    return RecordedTrafficView(
        id=id,
        number=number,
        name=name,
        bytes=size,
        obstacle=why,
        began=0.0,
        seconds=0.0,
        until=0.0,
        incomplete=None,
        messages=0,
        passed_over=0,
        topics=[],
        missing=[],
        otherwise=[],
        others=[],
        troubles=[],
        moments=[],
        earlier=0,
        later=0,
    )


def recording_view(
    number: int, kept: Kept, station: ReadyStation, read: RecordingReading, since: float
) -> RecordedTrafficView:
    """A recording as it was read, with the moments after one."""
    id, name, size, _ = kept
    incoming = station.pipelines.incoming
    fed = partial(_fed, station)
    first = bisect_right(read.moments, since, key=lambda each: each.at)
    shown = read.moments[first : first + MOST_SHOWN]

    def _lacking(topic: str) -> MissingTopicView:
        return MissingTopicView(name=topic, type=incoming[topic].topic.type_name, variables=fed(topic))

    def _was_heard(topic: RecordedTopic) -> RecordedTopicView:
        count = read.counts.get(topic.name, 0)
        return RecordedTopicView(name=topic.name, type=topic.type_name, messages=count, variables=fed(topic.name))

    return RecordedTrafficView(
        id=id,
        number=number,
        name=name,
        bytes=size,
        obstacle=None,
        began=read.began,
        seconds=read.seconds,
        until=read.until,
        incomplete=read.incomplete,
        messages=read.messages,
        passed_over=sum(each.messages for each in read.others),
        topics=[_was_heard(each) for each in read.heard],
        missing=[_lacking(each) for each in read.missing],
        otherwise=[
            OtherTopicView(
                name=each.topic.name,
                type=each.wanted,
                recorded=each.topic.type_name,
                difference=each.difference,
                messages=each.topic.messages,
                variables=fed(each.topic.name),
            )
            for each in read.otherwise
        ],
        others=[each.name for each in read.others[:MOST_OTHERS]],
        troubles=[
            RecordedTroubleView(topic=each.topic, text=each.text, count=each.count, first=each.first)
            for each in read.troubles
        ],
        moments=[_moment(each) for each in shown],
        earlier=first,
        later=len(read.moments) - first - len(shown),
    )


def state_view(number: int, id: str, station: ReadyStation, read: RecordingReading, at: float) -> RecordedStateView:
    """The state of a station at a moment of what was read. Raises `RecordingError` for one that was not."""
    said, known = read.said_by(at), read.last_known(at)
    feeds, pipelines = station.pipelines.feeds, station.pipelines
    variables = []
    for name, each in said.items():
        last, since = known.get(name, (None, None))
        commanded = name in station.automaton.outputs
        carriers = [topic for topic, each in pipelines.outgoing.items() if commanded and name in each.variables]
        topics = sorted(pipelines.topics_of(feeds[name])) if name in feeds else carriers
        variables.append(
            RecordedVariableView(
                name=name,
                commanded=commanded,
                value=each.value,
                standing=each.standing,
                last=last,
                since=since,
                topics=topics,
            )
        )
    state = transferred(station.automaton, {name: each.value for name, each in said.items()})
    values = {name: state[name] for name in station.automaton.variables}
    return RecordedStateView(id=id, number=number, at=at, obstacle=None, values=values, variables=variables)


def _moment(moment: RecordedMoment) -> RecordedMomentView:
    changes = [
        RecordedChangeView(name=name, before=before.value, after=after.value, standing=after.standing)
        for name, (before, after) in moment.changes.items()
    ]
    return RecordedMomentView(at=moment.at, changes=changes)


def _fed(station: ReadyStation, topic: str) -> list[str]:
    """The variables that a topic tells, by itself or with others."""
    pipelines = station.pipelines
    if topic in pipelines.outgoing:
        return [name for name in pipelines.outgoing[topic].variables if name in station.automaton.outputs]
    return [name for name, feed in pipelines.feeds.items() if topic in pipelines.topics_of(feed)]


def answering(folder: Path) -> Callable[[RecordingQuestion, object], object]:
    """Return what answers questions, in an empty folder; a process's life. It has no more memory than processes that
    check a model may have: a recording can be packed so that it fills any.
    """
    most = int(memory_limit() * _GB) + _data()
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))
    service = RecordingService(folder)

    def _answered(question: RecordingQuestion, _: object) -> object:
        return encoded(service.found_for(question))

    return _answered


def _data() -> int:
    """Return how many bytes of data this process has (proc_pid_statm(5))."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[5]) * resource.getpagesize()
