"""Incoming topics: the last thing each said, whether it still counts, and batches cut so that no value is skipped."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from sequence_planner.expressions.types import Value
from sequence_planner.pipelines.pipeline import IncomingPipeline
from sequence_planner.ros.errors import MalformedMessageError
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Sample


@dataclass
class Feed:
    """One incoming topic. Times are on the clock of `time.monotonic`, as samples carry them.

    What it said counts until its deadline has passed or its last publisher has gone, and then it has said nothing.
    """

    pipeline: IncomingPipeline
    last: float | None = None
    messages: int = 0
    trouble: str | None = None
    abandoned: bool = False  # its publishers have gone since the last message
    values: dict[str, Value | None] = field(default_factory=dict)
    memory: dict[str, Value | None] = field(default_factory=dict)

    def take(self, sample: Sample, registry: MessageRegistry) -> None:
        """Read one message. One that cannot be read makes the topic's variables unknown."""
        if not self.fresh(sample.received):
            self.memory.clear()  # also when nobody looked while it was silent
        self.last = sample.received
        self.abandoned = False
        self.messages += 1
        try:
            record = registry.decode(self.pipeline.topic.type_name, sample.data)
        except MalformedMessageError as error:
            self.values = {}
            self.trouble = str(error)
            return
        reading = self.pipeline.read(record, self.memory)
        self.values = reading.values
        self.trouble = "; ".join(reading.troubles) or None

    def fresh(self, now: float) -> bool:
        """Whether the topic has spoken, and within its deadline, and its publishers are still there."""
        deadline = self.pipeline.deadline
        return self.last is not None and not self.abandoned and (deadline is None or now - self.last <= deadline)

    def measured(self, now: float) -> dict[str, Value | None]:
        """The values of its variables; all unknown when it is not fresh."""
        if not self.fresh(now):
            self.memory.clear()
            return dict.fromkeys(self.pipeline.variables)
        return {name: self.values.get(name) for name in self.pipeline.variables}


class Feeds:
    """All incoming topics of a station."""

    def __init__(self, pipelines: Mapping[str, IncomingPipeline], registry: MessageRegistry) -> None:
        self.topics = {name: Feed(pipeline) for name, pipeline in pipelines.items()}
        self._registry = registry

    def take(self, samples: Iterable[Sample]) -> None:
        """Read messages, of which no topic has more than one."""
        for sample in samples:
            self.topics[sample.topic].take(sample, self._registry)

    def abandon(self, topic: str) -> None:
        """The last publisher of the topic has gone."""
        self.topics[topic].abandoned = True

    def measured(self, now: float) -> dict[str, Value | None]:
        """The values of all measured variables that topics feed."""
        values: dict[str, Value | None] = {}
        for feed in self.topics.values():
            values |= feed.measured(now)
        return values

    def awaited(self, now: float) -> list[str]:
        """The topics that are not fresh."""
        return [name for name, feed in self.topics.items() if not feed.fresh(now)]

    def offline(self, now: float) -> frozenset[str]:
        """The resources of which a topic is not fresh."""
        return frozenset(self.topics[name].pipeline.topic.resource for name in self.awaited(now))


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
