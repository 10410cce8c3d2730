"""An action of a device, used while production runs. What its server tells is heard as messages of topics are."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine, Sequence

from pydantic import ValidationError

from sequence_planner.automaton.structure import State
from sequence_planner.complaints import in_a_line
from sequence_planner.control.feeds import Feeds
from sequence_planner.control.goal_course import Do, GoalCourse
from sequence_planner.control.request_making import RequestMaker
from sequence_planner.pipelines.goal_states import STATUS_FIELD, STATUS_TYPE, GoalState
from sequence_planner.pipelines.graph import ActionUse, IncomingPipeline
from sequence_planner.ros.actions import ActionClient, ActionNames, Goal, GoalRejectedError, Values
from sequence_planner.ros.errors import MalformedMessageError, MessageValueError
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Endpoint, Sample, Transport, TransportError

Hear = Callable[[Sequence[Sample]], None]

_FAILURES = (TransportError, MalformedMessageError, MessageValueError, ValidationError)


class GoalClient:
    """One action. Nothing here waits: goals are tasks of the event loop, and `hear` is told what comes of them."""

    def __init__(
        self, use: ActionUse, registry: MessageRegistry, transport: Transport, feeds: Feeds, hear: Hear
    ) -> None:
        self._use = use
        self._registry = registry
        self._feeds = feeds
        self._hear = hear
        self._course = GoalCourse()
        self.maker = RequestMaker(use.goal)
        self._making = False
        self._goal: Goal | None = None
        self._cancelled = False  # before its goal was accepted
        self._tasks: set[asyncio.Task[None]] = set()
        self._told: GoalState | None = None
        self._client = ActionClient(transport, registry, use.name, use.type_name, self._hear_status)
        self._tell()

    def heed(self, state: State, now: float) -> None:
        """The state is so now: send a goal or cancel it, if that is wanted."""
        self._do(self._course.heed(state[self._use.when] is True))
        if self._making and (message := self.maker.message(state, now)) is not None:
            self._making = False
            self._begin(self._carry_out(message))

    def look(self, graph: Sequence[Endpoint]) -> None:
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

    async def _call_off(self, goal: Goal | None) -> None:
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
    """What went wrong, in a line."""
    return in_a_line(error) if isinstance(error, ValidationError) else str(error)
