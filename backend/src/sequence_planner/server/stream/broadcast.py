"""Broadcast of live documents to many clients: view differences, latest values, on-demand feeds."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from functools import partial

from pydantic import BaseModel

from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.queries import AboutFlows
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.controller.views.details import NetworkView
from sequence_planner.controller.views.pipelines import FlowsView
from sequence_planner.controller.views.station import StationView
from sequence_planner.server.settings import StreamLimits
from sequence_planner.server.stream.messages import (
    MAPS,
    ControllerState,
    Delta,
    FlowsSnapshot,
    Link,
    NetworkSnapshot,
    Silence,
    Snapshot,
    StationChange,
    StationRemoval,
    StreamError,
)
from sequence_planner.texts.message import Message, Title

# The difference between two views: what changed, and what is gone.
#
# The law that makes the stream right: whoever holds `old` and applies `difference(old, new)` holds `new`, to the
# letter. Values are compared with their types, because Python calls `True` and `1` equal and a page does not.


def difference(old: StationView, new: StationView) -> tuple[StationChange, StationRemoval]:
    """Return what to apply to `old` to get `new`: changed members (of maps, changed entries) and removed keys.

    `time` is always among the changes, so that whoever hears a delta also hears how fresh it is.
    """
    changed: dict[str, object] = {"time": new.time}
    removed: dict[str, list[str]] = {}
    for name in StationView.model_fields:
        before, after = getattr(old, name), getattr(new, name)
        if name not in MAPS:
            if not _same(before, after):
                changed[name] = after
            continue
        if entries := changed_entries(before, after):
            changed[name] = entries
        if gone := [key for key in before if key not in after]:
            removed[name] = gone
    return changed, removed


def changed_entries(old: Mapping[str, BaseModel], new: Mapping[str, BaseModel]) -> dict[str, BaseModel]:
    """The entries of `new` that are not, or not so, in `old`."""
    return {key: entry for key, entry in new.items() if key not in old or not _same(old[key], entry)}


def _same(old: object, new: object) -> bool:
    """Return whether both are written as the same JSON, as far as these views go: equal, and of the same types and the
    same words throughout.
    """
    return old is new or (old == new and _same_types(old, new))


def _same_types(old: object, new: object) -> bool:
    """Return whether what is equal is also of the same types, down to the values in it."""
    if old is new:
        return True
    if type(old) is not type(new):
        return False
    if isinstance(old, BaseModel):
        return _same_types(old.__dict__, new.__dict__)
    if isinstance(old, Message) and isinstance(new, Message):
        return old.id == new.id and _same(old.arguments, new.arguments)  # equal in English, not yet in what is sent
    if isinstance(old, Title) and isinstance(new, Title):
        return old.words == new.words
    if isinstance(old, Mapping) and isinstance(new, Mapping):
        return all(_same_types(value, new[key]) for key, value in old.items())
    if isinstance(old, list | tuple) and isinstance(new, list | tuple):
        return all(map(_same_types, old, new))
    return True


# One stream for many clients, none of which can slow another.
#
# A view that arrives is compared with the one before once, encoded once, and put into the queue of every subscriber. A
# queue that is full is thrown away: its owner then gets one fresh snapshot, which says all that the lost deltas said.
# When the controller falls silent everybody is told, and there is nothing to show until it is heard again: a snapshot
# of an old view would look like the present.

MOST_ERRORS = 8  # answers to wrong frames that wait; of more, the oldest are dropped


class Subscriber:
    """A client, with what it has still to be told."""

    def __init__(self, present: Callable[[], str], length: int) -> None:
        self._present = present
        self._length = length
        self._waiting: deque[str] = deque()
        self._errors: deque[str] = deque(maxlen=MOST_ERRORS)
        self._behind = True  # it starts with a snapshot
        self._something = asyncio.Event()
        self._something.set()

    def offer(self, message: str) -> None:
        """Tell the client in its turn, or give it a snapshot when it is too far behind."""
        if self._behind:
            return  # the snapshot it will get is made when it is sent, and includes this
        if len(self._waiting) >= self._length:
            self.resync()
            return
        self._waiting.append(message)
        self._something.set()

    def resync(self) -> None:
        """Forget what waits; a snapshot comes next."""
        self._waiting.clear()
        self._behind = True
        self._something.set()

    def complain(self, detail: str) -> None:
        """Tell this client alone what was wrong with its frame."""
        self._errors.append(StreamError(kind="error", detail=detail).model_dump_json())
        self._something.set()

    async def next(self) -> str:
        """The next message for this client, when there is one."""
        while True:
            await self._something.wait()
            if self._errors:
                return self._errors.popleft()
            if self._behind:
                self._behind = False
                return self._present()
            if self._waiting:
                return self._waiting.popleft()
            self._something.clear()


class Broadcast:
    """Follows the controller and tells every subscriber, also when it falls silent."""

    def __init__(self, controller: ControllerClient, limits: StreamLimits) -> None:
        self.limits = limits
        self._controller = controller
        self._sequence = 0
        self._view: StationView | None = None  # what was told last; None while the controller is lost
        self._subscribers: set[Subscriber] = set()
        controller.listen(self._heard)
        controller.listen_to_silence(self._look)

    @contextmanager
    def subscription(self) -> Iterator[Subscriber | None]:
        """A subscriber for as long as the block lasts; None when there are too many already."""
        if len(self._subscribers) >= self.limits.clients:
            yield None
            return
        subscriber = Subscriber(self._present, self.limits.queue)
        self._subscribers.add(subscriber)
        try:
            yield subscriber
        finally:
            self._subscribers.discard(subscriber)

    def _heard(self, view: StationView) -> None:
        before, self._view = self._view, view
        if before is None:
            self._tell_link(ControllerState.HEARD)
            self._tell(self._present())
            return
        self._sequence += 1
        if not self._subscribers:
            return
        changed, removed = difference(before, view)
        delta = Delta(kind="delta", sequence=self._sequence, changed=changed, removed=removed)
        self._tell(delta.model_dump_json())

    def _look(self) -> None:
        if self._view is not None and not self._controller.heard:
            self._view = None
            self._tell_link(ControllerState.LOST)

    def _tell_link(self, state: ControllerState) -> None:
        self._sequence += 1
        self._tell(Link(kind="link", sequence=self._sequence, controller=state).model_dump_json())

    def _tell(self, message: str) -> None:
        for subscriber in self._subscribers:
            subscriber.offer(message)

    def _present(self) -> str:
        """All that is to be said now: the view, or that there is none."""
        if self._view is None:
            lost = Link(kind="link", sequence=self._sequence, controller=ControllerState.LOST)
            return lost.model_dump_json()
        age = self._controller.age
        return Snapshot(kind="snapshot", sequence=self._sequence, age=age, view=self._view).model_dump_json()


# A document for many clients, of which each gets the newest whenever it is ready for one.
#
# Nothing waits in a queue: a client that is slow misses what was overtaken meanwhile, and slows nobody.


class LatestValue:
    """`present` encodes the document as it is now; it is called once for each change and client."""

    def __init__(self, present: Callable[[], str], limits: StreamLimits) -> None:
        self.limits = limits
        self.somebody = asyncio.Event()  # whether anybody looks
        self._present = present
        self._subscribers: set[Subscriber] = set()

    @contextmanager
    def subscription(self, present: Callable[[], str] | None = None) -> Iterator[Subscriber | None]:
        """A subscriber for as long as the block lasts; None when there are too many already. With a `present` of its
        own it is shown a part.
        """
        if len(self._subscribers) >= self.limits.clients:
            yield None
            return
        subscriber = Subscriber(present or self._present, 0)
        self._subscribers.add(subscriber)
        self.somebody.set()
        try:
            yield subscriber
        finally:
            self._subscribers.discard(subscriber)
            if not self._subscribers:
                self.somebody.clear()

    def tell(self) -> None:
        """The document has changed."""
        for subscriber in self._subscribers:
            subscriber.resync()


# The documents that are shown only to who looks: the ROS graph, and what passes the pipelines.

# Pipelines that somebody looks at; none is all.
Names = frozenset[str] | None

LOOK_EVERY = 0.5  # seconds between two questions what has passed the pipelines


class NetworkFeed:
    """The ROS graph: told whenever it has changed, and when the controller falls silent."""

    def __init__(self, controller: ControllerClient, limits: StreamLimits) -> None:
        self.latest = LatestValue(self._present, limits)
        self._controller = controller
        self._encoded: str | None = None
        self._is_heard = False
        controller.listen_to_network(self._changed)
        controller.listen(lambda view: self._look())
        controller.listen_to_silence(self._look)

    def _look(self) -> None:
        if self._is_heard != (is_heard := self._controller.heard and self._controller.network is not None):
            self._is_heard = is_heard
            self._forget()

    def _changed(self, network: NetworkView) -> None:
        self._is_heard = self._controller.heard
        self._forget()

    def _forget(self) -> None:
        self._encoded = None
        self.latest.tell()

    def _present(self) -> str:
        network = self._controller.network
        if network is None or not self._controller.heard:
            return Silence(kind="link", controller=_state(self._controller)).model_dump_json()
        if self._encoded is None:
            self._encoded = NetworkSnapshot(kind="network", network=network).model_dump_json()
        return self._encoded


class FlowsFeed:
    """A feed of what passes the pipelines: the controller is asked twice a second for those that somebody looks at."""

    def __init__(self, controller: ControllerClient, limits: StreamLimits) -> None:
        self.latest = LatestValue(partial(self._present, None), limits)
        self._controller = controller
        self._looked_at: list[Names] = []  # of each who looks; none is all
        self._flows: FlowsView | None = None
        self._encoded: dict[Names, str] = {}

    def of(self, names: Names) -> PipelineFeed:
        """Return what passes these pipelines, or all."""
        return PipelineFeed(self, names)

    @contextmanager
    def looking(self, names: Names) -> Iterator[Subscriber | None]:
        """A subscriber to these pipelines for as long as the block lasts; None when there are too many already."""
        self._looked_at.append(names)
        try:
            with self.latest.subscription(partial(self._present, names)) as subscriber:
                yield subscriber
        finally:
            self._looked_at.remove(names)

    async def run(self) -> None:
        """Ask until cancelled."""
        while True:
            if not self.latest.somebody.is_set():
                self._take(None)
                await self.latest.somebody.wait()
            self._take(await self._asked())
            await asyncio.sleep(LOOK_EVERY)

    async def _asked(self) -> FlowsView | None:
        wanted = [names for names in self._looked_at if names is not None]
        among = None if len(wanted) < len(self._looked_at) else frozenset().union(*wanted)
        try:
            return await self._controller.ask(AboutFlows(among=among))
        except CommandRefused:
            return None

    def _take(self, flows: FlowsView | None) -> None:
        is_news = flows != self._flows
        self._flows, self._encoded = flows, {}
        if is_news:
            self.latest.tell()

    def _present(self, names: Names) -> str:
        if self._flows is None:
            return Silence(kind="link", controller=_state(self._controller)).model_dump_json()
        if names not in self._encoded:
            chosen = {name: view for name, view in self._flows.pipelines.items() if names is None or name in names}
            shown = self._flows.model_copy(update={"pipelines": chosen})
            self._encoded[names] = FlowsSnapshot(kind="flows", flows=shown).model_dump_json()
        return self._encoded[names]


class PipelineFeed:
    """A feed of what passes some pipelines, as clients subscribe to it."""

    def __init__(self, show: FlowsFeed, names: Names) -> None:
        self.limits = show.latest.limits
        self._show = show
        self._names = names

    def subscription(self) -> AbstractContextManager[Subscriber | None]:
        """A subscriber for as long as the block lasts; None when there are too many already."""
        return self._show.looking(self._names)


def _state(controller: ControllerClient) -> ControllerState:
    return ControllerState.HEARD if controller.heard else ControllerState.LOST
