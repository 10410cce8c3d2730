"""Inputs of a running station: topics, the bounded inbox, invalid messages and last known values."""

from __future__ import annotations

import re
import time
from collections import Counter, deque
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from sequence_planner.execution.events import Heard, Ticked
from sequence_planner.execution.executor import Executor
from sequence_planner.language.types import Value
from sequence_planner.pipelines.graph import IncomingPipeline, PipelineView, StationPipelines
from sequence_planner.pipelines.runtime import RunningPipelines
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.types.errors import MalformedMessageError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.texts.message import message

# What devices say that makes no sense: reported once for each cause, with how often and when.
#
# Texts about the same thing differ in the values they name, so a cause is a text without them.

SHOWN = 10.0  # seconds for which a cause is shown after it was last seen, although what came since makes sense
MOST_CAUSES = 5  # of one place; what is seen beyond them counts as the last of these

_VALUES = re.compile(r"'[^']*'|\"[^\"]*\"|[-+]?\b(\d[\w.+-]*|nan|inf)\b")


@dataclass
class InputError:
    """One cause. Times are on the clock of `time.monotonic`; `text` is what was said last."""

    text: str
    first: float
    last: float
    count: int = 1


class InputErrors:
    """All causes that are to be shown, by place: a topic, a service or an action."""

    def __init__(self) -> None:
        self._places: dict[str, dict[str, InputError]] = {}
        self._troubled: set[str] = set()  # places where the last that came made no sense

    def note(self, place: str, text: str, now: float, lasting: bool = True) -> None:
        """Something made no sense; when `lasting`, it is shown until what comes makes sense again."""
        causes = self._places.setdefault(place, {})
        if lasting:
            self._troubled.add(place)
        cause = _VALUES.sub("…", text)
        if cause not in causes and len(causes) >= MOST_CAUSES:
            cause = max(causes, key=lambda each: causes[each].last)
        report = causes.get(cause)
        if report is None:
            causes[cause] = InputError(text, now, now)
        else:
            report.text, report.last, report.count = text, now, report.count + 1

    def settle(self, place: str) -> None:
        """Note that what came last makes sense."""
        self._troubled.discard(place)

    def every_report(self) -> Iterator[tuple[str, InputError]]:
        """Each report with its place; none is forgotten."""
        for place, causes in self._places.items():
            for report in causes.values():
                yield place, report

    def current(self, now: float) -> Iterator[tuple[str, str, InputError]]:
        """Each report with its place and a key for its cause; those that are long over are forgotten."""
        for place, causes in list(self._places.items()):
            for cause, report in list(causes.items()):
                if now - report.last > SHOWN and not (place in self._troubled and _is_last(report, causes)):
                    del causes[cause]
                else:
                    yield place, cause, report
            if not causes:
                del self._places[place]


def _is_last(report: InputError, causes: dict[str, InputError]) -> bool:
    return report.last == max(each.last for each in causes.values())


# Incoming topics: the last thing each said, whether it still counts, and batches cut so that no value is skipped.
#
# What services and actions answer is taken as a topic's messages are, under the names of their parts.


@dataclass
class InputTopic:
    """One incoming topic. Times are on the clock of `time.monotonic`, as samples carry them.

    What it said counts until its deadline has passed or its last publisher has gone, and then it has said nothing.
    """

    pipeline: IncomingPipeline
    running: RunningPipelines
    last: float | None = None
    messages: int = 0
    abandoned: bool = False  # what it said counts no more, since before the next message
    why: str = ""  # it was abandoned
    is_silent: bool = True  # nothing has come since the beginning, or since it was begun anew
    since: float = float("-inf")  # what was received before counts no more
    data: bytes | None = None  # of the last message, if it could be read; None also once it counts no more

    @property
    def trouble(self) -> str | None:
        """The part of its last message that made no sense."""
        return self.running.trouble(self.pipeline.topic.name)

    def fresh(self, now: float) -> bool:
        """Return whether the topic has spoken, and within its deadline, and its publishers are still there."""
        deadline = self.pipeline.deadline
        return self.last is not None and not self.abandoned and (deadline is None or now - self.last <= deadline)


class Inputs:
    """All incoming topics of a station, and what becomes of their messages."""

    def __init__(
        self,
        pipelines: StationPipelines,
        registry: MessageRegistry,
        initial: Mapping[str, Value | None] | None = None,
        *,
        patient: bool = False,
    ) -> None:
        """`initial` has what the variables say that come of requests, as long as nothing is asked. With `patient`,
        stages that work beside are waited for.
        """
        self.running = RunningPipelines(pipelines, patient)
        self.topics = {name: InputTopic(pipeline, self.running) for name, pipeline in pipelines.incoming.items()}
        self.answers = {name: InputTopic(pipeline, self.running) for name, pipeline in pipelines.answers.items()}
        self.reports = InputErrors()
        self._all = self.topics | self.answers
        self._initial = initial or {}
        polled = {use.response.name for use in pipelines.services.values() if use.every is not None}
        self.expected = {name: feed for name, feed in self._all.items() if name in self.topics or name in polled}
        self._asked = [feed for name, feed in self.answers.items() if name not in polled]
        self.heard_on = pipelines.heard_on
        self.sources = {name: pipelines.topics_of(feed) for name, feed in pipelines.feeds.items()}  # of each variable
        self._registry = registry
        self._forgotten: set[str] = set(self._all)  # topics of which nothing is remembered

    def take(self, samples: Iterable[Sample]) -> None:
        """Read messages, of which no topic has more than one."""
        for sample in samples:
            feed = self._all[sample.topic]
            if sample.received < feed.since:
                continue
            self._take(feed, sample)
            if (trouble := sample.trouble or feed.trouble) is not None:
                self.reports.note(sample.topic, trouble, sample.received)
            else:
                self.reports.settle(sample.topic)

    def begin_anew(self, name: str, now: float) -> None:
        """Disregard what a service or an action has answered: its variables are as before any request."""
        feed = self._all[name]
        feed.is_silent, feed.abandoned, feed.since = True, True, now
        self._forget(name)

    def _take(self, feed: InputTopic, sample: Sample) -> None:
        """Read one message. One that cannot be read makes what comes of the topic unknown."""
        if not feed.fresh(sample.received):
            self._forget(sample.topic)  # also when nobody looked while it was silent
        feed.last = sample.received
        feed.abandoned = feed.is_silent = False
        feed.messages += 1
        if sample.data == feed.data and self.running.repeats[sample.topic]:
            self.running.repeat(sample.topic)
            return
        self._forgotten.discard(sample.topic)
        if sample.trouble:
            feed.data = None
            self.running.spoil(sample.topic, sample.trouble)
            feed.abandoned = sample.topic in self.answers  # nobody answers
            return
        try:
            record = self._registry.decode(feed.pipeline.topic.type_name, sample.data)
        except MalformedMessageError as error:
            feed.data = None
            self.running.spoil(sample.topic, str(error))
        else:
            feed.data = sample.data
            self.running.take(sample.topic, record, sample.received)

    def wake(self, now: float) -> None:
        """Let time pass in the pipelines; `due` says when it next makes a difference."""
        due = self.running.due
        if due is not None and due <= now:
            for name, trouble in self.running.wake(now).items():
                self.reports.note(name, trouble, now)

    def observed(self, among: Container[str] | None = None) -> dict[str, PipelineView]:
        """Return what has passed each edge of each pipeline, or of those `among` these."""
        return self.running.observed(among)

    @property
    def due(self) -> float | None:
        """The time when `wake` next makes a difference if nothing comes before."""
        return self.running.due

    def abandon(self, topic: str, why: str | None = None) -> None:
        """Disregard what the topic said: the last publisher has gone, or a promise has been broken as `why` says."""
        self.topics[topic].abandoned = True
        self.topics[topic].why = message("silent.gone") if why is None else why

    def measured(self, now: float) -> dict[str, Value | None]:
        """The values of all measured variables that topics feed; unknown are those of which a topic is not fresh."""
        fresh = {name: feed.fresh(now) for name, feed in self._all.items()}
        for name, is_fresh in fresh.items():
            if not is_fresh:
                self._forget(name)
        values = self.running.values(fresh)
        for feed in self._asked:
            if feed.is_silent:
                values.update((name, self._initial.get(name)) for name in feed.pipeline.variables)
        return values

    def awaited(self, now: float) -> list[str]:
        """The topics that are not fresh, and the services called every so often that do not answer."""
        return [name for name, feed in self.expected.items() if not feed.fresh(now)]

    def resource_of(self, name: str) -> str:
        """The resource of a topic, or of a service or action by the name of a part."""
        return self._all[name].pipeline.topic.resource

    def offline(self, now: float) -> frozenset[str]:
        """The resources from which something is awaited."""
        return frozenset(map(self.resource_of, self.awaited(now)))

    def _forget(self, topic: str) -> None:
        if topic not in self._forgotten:
            self._forgotten.add(topic)
            self._all[topic].data = None
            self.running.forget(topic)


def one_per_topic(samples: Iterable[Sample]) -> Iterator[list[Sample]]:
    """Cut a batch so that in each part every topic speaks at most once: one part is one tick.

    Topics are delivered one after the other; the parts are in the order in which the messages were received, so that
    no tick sees a state of the devices that never was.
    """
    part: list[Sample] = []
    spoken: set[str] = set()
    for sample in sorted(samples, key=lambda each: each.received):
        if sample.topic in spoken:
            yield part
            part, spoken = [], set()
        part.append(sample)
        spoken.add(sample.topic)
    if part:
        yield part


# What has been heard and not been looked at yet, bounded: a topic that floods the station does not hold it up.

MOST_WAITING = 500  # samples of one topic; then the oldest are passed over
AGAIN = 1.0  # seconds after which the same is said anew, and not once more
LONGEST = 0.02  # seconds for which one look at what waits may go on


class Inbox:
    """Samples in the order in which they were received. What is passed over is noted in `reports`."""

    def __init__(self, reports: InputErrors) -> None:
        self._reports = reports
        self._waiting: deque[Sample] = deque()
        self._last: dict[str, Sample] = {}

    def __bool__(self) -> bool:
        return bool(self._waiting)

    def put(self, samples: Sequence[Sample]) -> bool:
        """Samples have come; whether one of them is to be looked at now, and not only at the next look.

        It is not where a topic says again and again what it has said: that tells no more than that it is alive.
        """
        self._waiting.extend(samples)
        news = False
        for sample in samples:
            last, self._last[sample.topic] = self._last.get(sample.topic), sample
            same = last is not None and (last.data, last.trouble) == (sample.data, sample.trouble)
            news = news or not same or last is None or sample.received - last.received > AGAIN
        return news

    def parts(self) -> Iterator[list[Sample]]:
        """Yield what waits, in parts of which no topic has more than one; the rest stays when that takes too long."""
        end = time.monotonic() + LONGEST
        if len(self._waiting) > MOST_WAITING:
            self._pass_over(time.monotonic())
        waiting, self._waiting = self._waiting, deque()
        parts = one_per_topic(waiting)
        for part in parts:
            yield part
            if time.monotonic() > end:
                break
        self._waiting.extendleft(reversed([sample for part in parts for sample in part]))

    def _pass_over(self, now: float) -> None:
        """Only the newest samples of each topic stay."""
        surplus = {
            topic: count - MOST_WAITING
            for topic, count in Counter(sample.topic for sample in self._waiting).items()
            if count > MOST_WAITING
        }
        kept: deque[Sample] = deque()
        left = dict(surplus)
        for sample in self._waiting:
            if left.get(sample.topic, 0):
                left[sample.topic] -= 1
            else:
                kept.append(sample)
        self._waiting = kept
        for topic, count in surplus.items():
            text = f"messages come faster than they can be looked at: {count} were passed over for newer ones"
            self._reports.note(topic, text, now, lasting=False)


# What measured variables were when they were known last.


class LastKnown:
    """Listens to an execution, and remembers each value that is lost."""

    def __init__(self, execution: Executor) -> None:
        self._execution = execution
        self._lost: dict[str, Value] = {}
        execution.listeners.append(self._hear)

    @property
    def values(self) -> Mapping[str, Value]:
        """Of those that are unknown now, and were known once."""
        state = self._execution.state
        return {name: value for name, value in self._lost.items() if state[name] is None}

    def _hear(self, heard: Heard) -> None:
        if isinstance(heard.happening, Ticked):
            for name, value in heard.happening.measured.items():
                if value is None and (before := heard.before[name]) is not None:
                    self._lost[name] = before
