"""A service of a device, called while production runs. What it answers is heard as messages of a topic are."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence

from sequence_planner.automaton.structure import State
from sequence_planner.control.call_course import CallCourse
from sequence_planner.control.feeds import Feeds
from sequence_planner.control.request_making import RequestMaker
from sequence_planner.pipelines.graph import ServiceUse
from sequence_planner.ros.errors import MessageValueError
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Sample, Transport, TransportError

Hear = Callable[[Sequence[Sample]], None]


class ServiceClient:
    """One service. Nothing here waits: calls are tasks of the event loop, and `hear` is told what comes of them."""

    def __init__(
        self, use: ServiceUse, registry: MessageRegistry, transport: Transport, feeds: Feeds, hear: Hear
    ) -> None:
        self._use = use
        self._registry = registry
        self._transport = transport
        self._feeds = feeds
        self._hear = hear
        self._course = CallCourse(use.every)
        self.maker = RequestMaker(use.request)
        self._making = False
        self._task: asyncio.Task[None] | None = None

    def heed(self, state: State, now: float) -> None:
        """The state is so now: call, if it is time."""
        use = self._use
        if use.when is not None and self._course.heed(state[use.when] is True):
            self._making = False
            if use.every is None:
                self._feeds.begin_anew(use.response.name, now)
        if not self._course.is_due(now):
            return
        if not self._making:
            self.maker.begin()
            self._making = True
        message = self.maker.message(state, now)
        if message is None:
            return
        self._making = False
        self._course.begin(now)
        try:
            request = self._registry.encode(use.request.topic.type_name, message)
        except MessageValueError as error:
            self._end(b"", f"the request cannot be written: {error}")
        else:
            self._task = asyncio.get_running_loop().create_task(self._call(request))

    def close(self) -> None:
        """Call no more."""
        self.maker.close()
        if self._task is not None:
            self._task.cancel()

    async def _call(self, request: bytes) -> None:
        use = self._use
        try:
            answer = await self._transport.call(use.name, use.type_name, request, use.deadline)
        except TransportError as error:
            self._end(b"", str(error))
        else:
            self._end(answer, "")

    def _end(self, answer: bytes, trouble: str) -> None:
        if self._course.end():
            self._hear([Sample(self._use.response.name, answer, time.monotonic(), trouble=trouble)])
