"""Incoming topics: the last thing each said, whether it still counts, and batches cut so that no value is skipped.

What services and actions answer is taken as a topic's messages are, under the names of their parts.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.control.bad_input import Reports
from sequence_planner.expressions.types import Value
from sequence_planner.pipelines.graph import IncomingPipeline, StationPipelines
from sequence_planner.pipelines.observation import PipelineView
from sequence_planner.pipelines.running import RunningPipelines
from sequence_planner.ros.errors import MalformedMessageError
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Sample


@dataclass
class Feed:
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
        """What in its last message made no sense."""
        return self.running.trouble(self.pipeline.topic.name)

    def fresh(self, now: float) -> bool:
        """Whether the topic has spoken, and within its deadline, and its publishers are still there."""
        deadline = self.pipeline.deadline
        return self.last is not None and not self.abandoned and (deadline is None or now - self.last <= deadline)


class Feeds:
    """All incoming topics of a station, and what becomes of their messages."""

    def __init__(
        self, pipelines: StationPipelines, registry: MessageRegistry, initial: Mapping[str, Value | None] | None = None
    ) -> None:
        """`initial` has what the variables say that come of requests, as long as nothing is asked."""
        self.running = RunningPipelines(pipelines)
        self.topics = {name: Feed(pipeline, self.running) for name, pipeline in pipelines.incoming.items()}
        self.answers = {name: Feed(pipeline, self.running) for name, pipeline in pipelines.answers.items()}
        self.reports = Reports()
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
        """What a service or an action has answered counts no more: its variables are as before any request."""
        feed = self._all[name]
        feed.is_silent, feed.abandoned, feed.since = True, True, now
        self._forget(name)

    def _take(self, feed: Feed, sample: Sample) -> None:
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
        """What has passed each edge of each pipeline, or of those `among` these."""
        return self.running.observed(among)

    @property
    def due(self) -> float | None:
        """When `wake` next makes a difference if nothing comes before."""
        return self.running.due

    def abandon(self, topic: str, why: str = "its publishers have gone") -> None:
        """What the topic said counts no more: the last publisher has gone, or a promise has been broken."""
        self.topics[topic].abandoned = True
        self.topics[topic].why = why

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
