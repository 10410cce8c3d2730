"""One stream for many clients, none of which can slow another.

A view that arrives is compared with the one before once, encoded once, and put into the queue of every subscriber. A
queue that is full is thrown away: its owner then gets one fresh snapshot, which says all that the lost deltas said.
When the controller falls silent everybody is told, and there is nothing to show until it is heard again: a snapshot
of an old view would look like the present.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from sequence_planner.control.view import StationView
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.difference import difference
from sequence_planner.web.settings import StreamLimits
from sequence_planner.web.stream_messages import ControllerState, Delta, Link, Snapshot, StreamError

MOST_ERRORS = 8  # answers to wrong frames that wait; of more, the oldest are dropped


class Subscriber:
    """What one client has still to be told."""

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
        return Snapshot(kind="snapshot", sequence=self._sequence, view=self._view).model_dump_json()
