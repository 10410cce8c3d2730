"""Service and action clients of a running station: call and goal decisions, responses as messages."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Container, Coroutine, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

from pydantic import ValidationError

from sequence_planner.automaton.automaton import State
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.core.data_models import in_a_line
from sequence_planner.language.types import Value
from sequence_planner.pipelines.chain_runtime import RunningOutgoing
from sequence_planner.pipelines.graph import (
    STATUS_FIELD,
    STATUS_TYPE,
    ActionUse,
    GoalState,
    IncomingPipeline,
    OutgoingPipeline,
    PipelineView,
    ServiceUse,
    StationPipelines,
)
from sequence_planner.ros.actions import AcceptedGoal, ActionClient, ActionNames, GoalRejectedError, GoalStatus, Values
from sequence_planner.ros.transport import NetworkEndpoint, Sample, Transport, TransportError
from sequence_planner.ros.types.errors import MalformedMessageError, MessageValueError
from sequence_planner.ros.types.messages import MessageRegistry

# Requests and goals from the state, as outgoing messages are made.


class RequestMaker:
    """Makes one message each time it is asked, at once or when the stages let it through."""

    def __init__(self, pipeline: OutgoingPipeline) -> None:
        self._pipeline = pipeline
        self.running = RunningOutgoing(pipeline)
        self._said: tuple[Value | None, ...] | None = None

    def begin(self) -> None:
        """A message is wanted: `next_message` makes it, now or later."""
        self._said = None

    def next_message(self, state: State, now: float) -> dict[str, object] | None:
        """The fields of the message that is wanted; None when stages hold it back, until they do not."""
        said = tuple([state[name] for name in self._pipeline.variables])
        if said != self._said:
            self._said = said
            return self.running.take(state, now)
        due = self.running.chain.due
        made = list(self.running.wake(now)) if due is not None and due <= now else []
        return made[-1] if made else None

    def close(self) -> None:
        """End what stages have started beside. May be repeated."""
        self.running.chain.close()


# Decisions about the calls of a service: for each rise of an output, every so often, and one at a time.
#
# Pure: it calls nothing, and is told the time.


@dataclass
class CallCourse:
    """One service, called `every` so many seconds, or only for rises where that is None."""

    every: float | None
    _wanted: bool | None = None  # the output as last seen; its first value is no rise
    _waiting: bool = False  # a rise has not been answered with a call yet
    _begun: float | None = None  # when a call was begun last
    _busy: bool = False
    _outdated: bool = False  # the call under way was begun before the output rose or fell

    def heed(self, wanted: bool) -> bool:
        """The output is so now; returns whether it rises or falls. What was asked before then counts no more."""
        was, self._wanted = self._wanted, wanted
        if was is None or was == wanted:
            return False
        self._waiting = wanted
        self._outdated = self._busy
        return True

    def is_due(self, now: float) -> bool:
        """Return whether to call now."""
        if self._busy:
            return False
        is_time = self.every is not None and (self._begun is None or now - self._begun >= self.every)
        return self._waiting or is_time

    def begin(self, now: float) -> None:
        """A call is begun."""
        self._busy, self._waiting, self._outdated, self._begun = True, False, False, now

    def end(self) -> bool:
        """The call under way has ended; returns whether what came of it counts."""
        self._busy = False
        return not self._outdated


# Decisions about the goal of an action: what to do when the output that wants it rises and falls.
#
# Pure: it sends nothing and knows no time. A goal is sent once for each rise, and never beside one that is under way: a
# rise waits until the device has ended that one, be it of this controller or of one that has gone since.


class Do(Enum):
    """An instruction about what is to be done now."""

    SEND = "send"
    CANCEL = "cancel"


# How ROS 2's states of a goal are told; one that is being cancelled is still at work.
_TOLD = {
    GoalStatus.ACCEPTED: GoalState.ACCEPTED,
    GoalStatus.EXECUTING: GoalState.EXECUTING,
    GoalStatus.CANCELING: GoalState.EXECUTING,
    GoalStatus.SUCCEEDED: GoalState.SUCCEEDED,
    GoalStatus.CANCELED: GoalState.CANCELED,
    GoalStatus.ABORTED: GoalState.ABORTED,
}


@dataclass
class GoalCourse:
    """One action. `own` is the state of the goal that was wanted last.

    `others` is that of a goal the server has and that is not ours, if one is under way.
    """

    own: GoalState = GoalState.IDLE
    others: GoalState | None = None
    _wanted: bool | None = None  # the output as last seen; its first value is no rise
    _waiting: bool = False  # a rise has not been answered with a goal yet
    _at_work: bool = False  # a goal of ours has been sent and has not ended

    @property
    def state(self) -> GoalState:
        """The state that the variable says."""
        if self._at_work or self.others is None:
            return self.own
        return self.others

    def heed(self, wanted: bool) -> Do | None:
        """The output is so now."""
        was, self._wanted = self._wanted, wanted
        if was is None or was == wanted:
            return self._next()
        if wanted:
            self._waiting = True
            return self._next()
        self._waiting = False
        if self._at_work or self.others is not None:
            return Do.CANCEL
        self.own = GoalState.IDLE
        return None

    def heard(self, status: GoalStatus) -> Do | None:
        """The server says what has become of our goal."""
        self.own = _TOLD.get(status, GoalState.LOST)
        if status.ended:
            self._at_work = False
        return self._next()

    def ended(self, state: GoalState) -> Do | None:
        """Nothing more will be heard of our goal: it was rejected, or nobody knows."""
        self.own, self._at_work = state, False
        return self._next()

    def heard_of_others(self, statuses: list[GoalStatus]) -> Do | None:
        """The server says which goals it has beside ours."""
        at_work = [_TOLD[status] for status in statuses if status in _TOLD and not status.ended]
        if not self._wanted and not self._at_work:
            self.own = GoalState.IDLE  # what was lost is not there any more, or is among the others
        self.others = max(at_work, key=[GoalState.ACCEPTED, GoalState.EXECUTING].index, default=None)
        return self._next()

    def lose_others(self) -> Do | None:
        """The server of the goals beside ours has gone."""
        self.others = None
        action = self._next()
        if not self._at_work:
            self.own = GoalState.LOST
        return action

    def _next(self) -> Do | None:
        if not self._wanted and not self._at_work and self.own is not GoalState.LOST:
            self.own = GoalState.IDLE
        if not self._waiting or self._at_work or self.others is not None:
            return None
        self._waiting, self._at_work, self.own = False, True, GoalState.IDLE
        return Do.SEND


# An action of a device, used while production runs. What its server tells is heard as messages of topics are.

Hear = Callable[[Sequence[Sample]], None]

_FAILURES = (TransportError, MalformedMessageError, MessageValueError, ValidationError)


class GoalClient:
    """One action. Nothing here waits: goals are tasks of the event loop, and `hear` is told what comes of them."""

    def __init__(
        self, use: ActionUse, registry: MessageRegistry, transport: Transport, feeds: Inputs, hear: Hear
    ) -> None:
        self._use = use
        self._registry = registry
        self._feeds = feeds
        self._hear = hear
        self._course = GoalCourse()
        self.maker = RequestMaker(use.goal)
        self._making = False
        self._goal: AcceptedGoal | None = None
        self._cancelled = False  # before its goal was accepted
        self._tasks: set[asyncio.Task[None]] = set()
        self._told: GoalState | None = None
        self._client = ActionClient(transport, registry, use.name, use.type_name, self._hear_status)
        self._tell()

    def heed(self, state: State, now: float) -> None:
        """The state is so now: send a goal or cancel it, if that is wanted."""
        self._do(self._course.heed(state[self._use.when] is True))
        if self._making and (message := self.maker.next_message(state, now)) is not None:
            self._making = False
            self._begin(self._carry_out(message))

    def look(self, graph: Sequence[NetworkEndpoint]) -> None:
        """Goals of others are known only from their server: when that has gone, nobody knows of them."""
        status = ActionNames(self._use.name).status
        if self._course.others is not None and not any(
            each.topic == status and each.direction == "publisher" and not each.own for each in graph
        ):
            self._client.others = {}
            self._do(self._course.lose_others())

    def close(self) -> None:
        """Leave the goals alone: the device goes on, and whoever runs next finds it so."""
        self.maker.close()
        for task in self._tasks:
            task.cancel()

    def _do(self, what: Do | None) -> None:
        match what:
            case Do.SEND:
                self._make()
            case Do.CANCEL:
                self._cancel()
        self._tell()

    def _make(self) -> None:
        """A goal is wanted."""
        self._feeds.reports.settle(self._use.name)
        self.maker.begin()
        self._making, self._goal, self._cancelled = True, None, False

    def _cancel(self) -> None:
        if self._making:  # nothing has been sent
            self._making = False
            self._do(self._course.ended(GoalState.IDLE))
        elif self._goal is None and self._course.others is None:
            self._cancelled = True
        else:
            self._begin(self._call_off(self._goal))

    async def _carry_out(self, message: Values) -> None:
        """Send a goal, and tell what becomes of it."""
        try:
            goal = self._goal = await self._client.send_goal(message, self._use.deadline, self._hear_feedback)
            self._do(self._course.heard(goal.status))
            if self._cancelled:
                self._begin(self._call_off(goal))
            outcome = await goal.result(self._use.deadline)
        except GoalRejectedError as error:
            self._fail(GoalState.REJECTED, str(error))
        except _FAILURES as error:
            self._fail(GoalState.LOST, _told(error))
        else:
            self._say(self._use.result, outcome.result)
            self._goal = None
            self._do(self._course.heard(outcome.status))

    async def _call_off(self, goal: AcceptedGoal | None) -> None:
        """Have a goal cancelled; without one of ours, those that others have left."""
        try:
            if goal is not None:
                await goal.cancel(self._use.deadline)
            else:
                await self._client.cancel_others(self._use.deadline)
        except (GoalRejectedError, *_FAILURES) as error:
            if goal is None or not goal.status.ended:
                self._feeds.reports.note(self._use.name, _told(error), time.monotonic())

    def _fail(self, state: GoalState, text: str) -> None:
        self._feeds.reports.note(self._use.name, text, time.monotonic())
        self._goal = None
        self._do(self._course.ended(state))

    def _hear_status(self) -> None:
        if self._goal is not None and not self._goal.status.ended:  # its end comes with its result
            self._do(self._course.heard(self._goal.status))
        self._do(self._course.heard_of_others(list(self._client.others.values())))

    def _hear_feedback(self, values: Values) -> None:
        self._say(self._use.feedback, values)

    def _say(self, part: IncomingPipeline, values: Values) -> None:
        data = self._registry.encode(part.topic.type_name, values)
        self._hear([Sample(part.name, data, time.monotonic())])

    def _tell(self) -> None:
        """Tell the state of the goal when it is another."""
        state, now = self._course.state, time.monotonic()
        if state is self._told:
            return
        self._told = state
        if state is GoalState.IDLE:  # nothing counts any more of what has been told
            for part in (self._use.feedback, self._use.result, self._use.status):
                self._feeds.begin_anew(part.name, now)
            self._feeds.reports.settle(self._use.name)
            self._feeds.take([self._status(state, now)])
        else:
            self._hear([self._status(state, now)])

    def _status(self, state: GoalState, now: float) -> Sample:
        return Sample(self._use.status.name, self._registry.encode(STATUS_TYPE, {STATUS_FIELD: state.value}), now)

    def _begin(self, work: Coroutine[None, None, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)


def _told(error: Exception) -> str:
    """Say what went wrong, in a line."""
    return in_a_line(error) if isinstance(error, ValidationError) else str(error)


# A service of a device, called while production runs. What it answers is heard as messages of a topic are.


class ServiceClient:
    """One service. Nothing here waits: calls are tasks of the event loop, and `hear` is told what comes of them."""

    def __init__(
        self, use: ServiceUse, registry: MessageRegistry, transport: Transport, feeds: Inputs, hear: Hear
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
        message = self.maker.next_message(state, now)
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


# All services and actions that a running station uses: requests as the state wants them, answers heard as messages.
#
# Nothing is asked for before production is started.


class Clients:
    """The clients of a station. `hear` is given what servers answer; it belongs on the event loop, and never waits."""

    def __init__(
        self, pipelines: StationPipelines, registry: MessageRegistry, transport: Transport, feeds: Inputs, hear: Hear
    ) -> None:
        services = [ServiceClient(use, registry, transport, feeds, hear) for use in pipelines.services.values()]
        self._actions = [GoalClient(use, registry, transport, feeds, hear) for use in pipelines.actions.values()]
        self._all: list[ServiceClient | GoalClient] = [*services, *self._actions]
        makers = (client.maker.running for client in self._all)
        self.requests = dict(zip(pipelines.requests, makers, strict=True))

    def heed(self, state: State, now: float) -> None:
        """The state is so now, and production runs: call, send and cancel what is wanted."""
        for client in self._all:
            client.heed(state, now)

    def look(self, graph: Sequence[NetworkEndpoint]) -> None:
        """The network is so now."""
        for client in self._actions:
            client.look(graph)

    def set_override(self, request: str, name: str, fields: Mapping[str, object], now: float, actor: str) -> None:
        """A person sets fields of the requests to come. Raises ValueError for what the model does not allow."""
        self.requests[request].set_override(name, fields, now, actor)

    def clear_override(self, request: str, name: str, now: float) -> None:
        """A person takes back what was set."""
        self.requests[request].clear_override(name, now)

    def observed(self, among: Container[str] | None = None) -> dict[str, PipelineView]:
        """Return what has passed each edge of each request's pipeline, or of those `among` these."""
        chosen = ((name, each) for name, each in self.requests.items() if among is None or name in among)
        return {name: running.observed() for name, running in chosen}

    def close(self) -> None:
        """Ask for nothing more. May be repeated."""
        for client in self._all:
            client.close()
