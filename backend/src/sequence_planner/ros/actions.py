"""Actions over any transport: goals that take time, with feedback, status, result and cancelling.

An action `/arm/move` is three services and two topics below `/arm/move/_action` (ROS 2's design document on actions).
Goals are known by 16 random bytes. A client that waits for a result asks again from time to time, so that a server
that has gone, or has been started anew and knows nothing of the goal, is noticed.
"""

from __future__ import annotations

import asyncio
import time
import uuid
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from enum import IntEnum
from typing import NamedTuple

from pydantic import BaseModel

from sequence_planner.ros.derived import CANCEL_GOAL, GOAL_STATUSES
from sequence_planner.ros.messages import MalformedMessageError, MessageRegistry
from sequence_planner.ros.quality import QualityOfService
from sequence_planner.ros.transport import NoAnswerError, Sample, Transport, TransportError

Values = Mapping[str, object]

#: Seconds after which a client that waits for a result asks for it again.
RENEWAL = 5.0

#: Goals that have ended and are remembered, since their server can still be telling of them.
_REMEMBERED = 100


class GoalStatus(IntEnum):
    """What has become of a goal, as action_msgs/msg/GoalStatus has it."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6

    @property
    def ended(self) -> bool:
        """Whether nothing more will come of it."""
        return self >= GoalStatus.SUCCEEDED


_ENDED = {status for status in GoalStatus if status.ended}


class Outcome(NamedTuple):
    """How a goal ended, and the fields of the action's result."""

    status: GoalStatus
    result: Values


class GoalRejectedError(Exception):
    """The server did not take the goal, or does not let it be cancelled."""


class LostGoalError(TransportError):
    """The server has gone, or has been started anew: what became of the goal is unknown."""


class ActionNames:
    """The services and topics of the action `name`."""

    def __init__(self, name: str) -> None:
        self.send_goal = f"{name}/_action/send_goal"
        self.get_result = f"{name}/_action/get_result"
        self.cancel_goal = f"{name}/_action/cancel_goal"
        self.feedback = f"{name}/_action/feedback"
        self.status = f"{name}/_action/status"


class _Id(BaseModel):
    uuid: list[int]


class _Info(BaseModel):
    goal_id: _Id


class _Status(BaseModel):
    goal_info: _Info
    status: int


class _Accepted(BaseModel):
    accepted: bool


class _Result(BaseModel):
    status: int
    result: dict[str, object]


class _Feedback(BaseModel):
    goal_id: _Id
    feedback: dict[str, object]


class _Statuses(BaseModel):
    status_list: list[_Status]


class _Cancelled(BaseModel):
    return_code: int


class Goal:
    """A goal that a server has accepted. `status` is the last that the server told."""

    def __init__(self, client: ActionClient, goal_id: bytes, on_feedback: Callable[[Values], None] | None) -> None:
        self._client = client
        self.id = goal_id
        self.status = GoalStatus.ACCEPTED
        self.on_feedback = on_feedback

    async def result(self, renewal: float = RENEWAL) -> Outcome:
        """Wait until the goal has ended, and return how.

        The server is asked anew every `renewal` seconds. Raises LostGoalError when it has gone or has forgotten the
        goal, at the latest when DDS has noticed that (10 s for Cyclone) and that time has passed.
        """
        try:
            return await self._client.result_of(self, renewal)
        finally:
            self._client.forget(self)

    async def cancel(self, within: float) -> None:
        """Ask the server to give the goal up, within so many seconds; `result` tells when it has.

        Raises GoalRejectedError when it refuses, and NoServerError or NoAnswerError when it does not answer.
        """
        await self._client.cancel(self, within)


class ActionClient:
    """Has a server carry out goals of one action. All methods belong on the event loop's thread."""

    def __init__(
        self,
        transport: Transport,
        registry: MessageRegistry,
        name: str,
        type_name: str,
        on_status: Callable[[], None] = lambda: None,
    ) -> None:
        """Listen to the action; raises as `Transport.subscribe` does, and UnknownMessageTypeError.

        `on_status` is called when the server has told what has become of its goals: ours, and `others`.
        """
        self._transport = transport
        self._registry = registry
        self._name = name
        self._type = registry.action(type_name)
        self._names = ActionNames(name)
        self._goals: dict[bytes, Goal] = {}
        self._ended: deque[bytes] = deque(maxlen=_REMEMBERED)
        self._on_status = on_status
        self.others: dict[bytes, GoalStatus] = {}  # goals under way that this client does not know, or has given up
        self.malformed = 0  # messages received that are not of the action's type
        transport.subscribe(self._names.feedback, self._type.feedback_message, QualityOfService.RELIABLE, self._hear)
        transport.subscribe(self._names.status, GOAL_STATUSES, QualityOfService.LATCHED, self._hear_status)

    async def send_goal(self, goal: Values, within: float, on_feedback: Callable[[Values], None] | None = None) -> Goal:
        """Have the server accept a goal with these fields, within so many seconds.

        `on_feedback` is called with the fields of each feedback. Raises GoalRejectedError, NoServerError,
        NoAnswerError (the goal may be under way all the same), MessageValueError, and MalformedMessageError for an
        answer that cannot be read.
        """
        types, goal_id = self._type.send_goal, uuid.uuid4().bytes
        made = self._goals[goal_id] = Goal(self, goal_id, on_feedback)  # Feedback can come before the answer.
        try:
            request = {"goal_id": {"uuid": list(goal_id)}, "goal": goal}
            answer = await self._call(self._names.send_goal, types.type_name, request, within)
            if not _Accepted.model_validate(answer).accepted:
                raise GoalRejectedError(f"{self._name} does not accept the goal")
        except BaseException:
            self.forget(made)
            raise
        return made

    async def result_of(self, goal: Goal, renewal: float) -> Outcome:
        """Wait for the end of a goal; see `Goal.result`."""
        request = {"goal_id": {"uuid": list(goal.id)}}
        while True:
            try:
                answer = await self._call(self._names.get_result, self._type.get_result.type_name, request, renewal)
            except NoAnswerError:
                continue
            except TransportError as error:
                raise LostGoalError(f"{self._name} has lost its server while a goal was under way: {error}") from error
            ended = _Result.model_validate(answer)
            if ended.status == GoalStatus.UNKNOWN:
                raise LostGoalError(f"{self._name} knows nothing of the goal: its server has been started anew")
            if ended.status not in _ENDED:
                raise LostGoalError(f"{self._name} says that a goal ended as {ended.status}, which is no way to end")
            goal.status = GoalStatus(ended.status)
            self._ended.append(goal.id)
            return Outcome(goal.status, ended.result)

    async def cancel(self, goal: Goal, within: float) -> None:
        """Ask for a goal to be given up; see `Goal.cancel`."""
        await self._cancel(goal.id, within)

    async def cancel_others(self, within: float) -> None:
        """Ask for all of `others` to be given up; raises as `Goal.cancel` does."""
        for goal_id in list(self.others):
            await self._cancel(goal_id, within)

    async def _cancel(self, goal_id: bytes, within: float) -> None:
        request = {"goal_info": {"goal_id": {"uuid": list(goal_id)}}}
        answer = _Cancelled.model_validate(await self._call(self._names.cancel_goal, CANCEL_GOAL, request, within))
        if answer.return_code != 0:
            codes = self._registry.constants(f"{CANCEL_GOAL}_Response")
            reason = next((name for name, code in codes.items() if code == answer.return_code), answer.return_code)
            raise GoalRejectedError(f"{self._name} does not cancel the goal: {reason}")

    def forget(self, goal: Goal) -> None:
        """Hear no more of a goal."""
        self._goals.pop(goal.id, None)

    async def _call(self, service: str, type_name: str, request: Values, within: float) -> Values:
        types = self._registry.service(type_name)
        data = self._registry.encode(types.request, request)
        return self._registry.decode(types.response, await self._transport.call(service, type_name, data, within))

    def _hear(self, batch: Sequence[Sample]) -> None:
        for sample in batch:
            try:
                message = _Feedback.model_validate(self._registry.decode(self._type.feedback_message, sample.data))
            except MalformedMessageError:
                self.malformed += 1
                continue
            goal = self._goals.get(bytes(message.goal_id.uuid))
            if goal is not None and goal.on_feedback is not None:
                goal.on_feedback(message.feedback)

    def _hear_status(self, batch: Sequence[Sample]) -> None:
        for sample in batch:
            try:
                statuses = _Statuses.model_validate(self._registry.decode(GOAL_STATUSES, sample.data))
            except MalformedMessageError:
                self.malformed += 1
                continue
            known = [told for told in statuses.status_list if told.status in set(GoalStatus)]
            told = {bytes(each.goal_info.goal_id.uuid): GoalStatus(each.status) for each in known}
            for goal_id, goal in self._goals.items():
                goal.status = told.pop(goal_id, goal.status)
            self.others = {i: s for i, s in told.items() if not s.ended and i not in self._ended}
            self._on_status()


def now() -> dict[str, object]:
    """Return the time of day as builtin_interfaces/msg/Time has it."""
    seconds, nanoseconds = divmod(time.time_ns(), 10**9)
    return {"sec": seconds, "nanosec": nanoseconds}


async def cancelled(event: asyncio.Event, within: float) -> bool:
    """Wait so many seconds for a goal to be cancelled; returns whether it was."""
    try:
        await asyncio.wait_for(event.wait(), within)
    except TimeoutError:
        return False
    return True
