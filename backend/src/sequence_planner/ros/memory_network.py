"""What stands on a network inside one process: participants, their endpoints and servers."""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from dataclasses import dataclass, field
from typing import Literal

from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.quality import disagreements
from sequence_planner.ros.serving import Serving
from sequence_planner.ros.transport import Direction, Handler, OnQualityEvent, QualityEvent, QualityOfService


@dataclass(eq=False)
class Participant:
    """One transport on the network, as the others see it."""

    registry: MessageRegistry
    node: str
    loop: asyncio.AbstractEventLoop
    watchers: list[OnQualityEvent] = field(default_factory=list)
    serving: Serving = field(default_factory=Serving)

    def tell(self, event: QualityEvent) -> None:
        """Have the watchers called with `event`."""
        for watcher in self.watchers:
            self.loop.call_soon(watcher, event)


@dataclass(eq=False)
class Member:
    """One endpoint on the network; `kept` holds what a publisher keeps for late joiners."""

    owner: Participant
    topic: str
    type_name: str
    qos: QualityOfService
    direction: Direction
    delivery: Delivery | None = None
    kept: deque[bytes] = field(default_factory=deque)
    counts: Counter[str] = field(default_factory=Counter)
    timer: asyncio.TimerHandle | None = None

    def passed(self) -> None:
        """Note that a sample was published or received: the deadline begins anew."""
        if self.timer is not None:
            self.timer.cancel()
        if self.qos.deadline is not None:
            self.timer = self.owner.loop.call_later(self.qos.deadline, self._missed)

    def tell(self, kind: Literal["incompatible", "deadline"], text: str) -> None:
        """Have the transport's watchers told of an event."""
        self.counts[kind] += 1
        self.owner.tell(QualityEvent(self.topic, self.direction, kind, self.counts[kind], text))

    def _missed(self) -> None:
        done = "received" if self.direction == "subscriber" else "published"
        self.tell("deadline", f"{self.topic}: no sample {done} within its deadline of {self.qos.deadline:g} s")
        self.passed()


@dataclass(eq=False)
class Server:
    """Who answers the requests to a service."""

    owner: Participant
    service: str
    type_name: str
    handler: Handler


def _meet(publisher: Member, subscriber: Member) -> bool:
    return (publisher.topic, publisher.type_name) == (subscriber.topic, subscriber.type_name)


def match(publisher: Member, subscriber: Member) -> bool:
    """Return whether samples of a publisher reach a subscriber."""
    return _meet(publisher, subscriber) and not disagreements(publisher.qos, subscriber.qos)


class Members:
    """All endpoints and servers."""

    def __init__(self) -> None:
        self.members: list[Member] = []
        self.servers: list[Server] = []

    def add(self, member: Member) -> None:
        """Let an endpoint join, and tell it and its peers where they do not agree."""
        self.members.append(member)
        for other in self.members:
            if other.direction == member.direction:
                continue
            publisher, subscriber = (member, other) if member.direction == "publisher" else (other, member)
            if _meet(publisher, subscriber) and (found := disagreements(publisher.qos, subscriber.qos)):
                for side in (publisher, subscriber):
                    side.tell("incompatible", f"{side.topic}: {'; '.join(found)}")

    def of(self, direction: Direction) -> list[Member]:
        """Return the publishers or the subscribers."""
        return [member for member in self.members if member.direction == direction]
