"""ROS 2 actions over any transport: client with goals, feedback and cancellation, and an emulated server."""

from __future__ import annotations

import asyncio
import time
import uuid
from collections import deque
from collections.abc import Awaitable, Callable, Mapping, Sequence
from enum import IntEnum
from typing import NamedTuple

import structlog
from pydantic import BaseModel

from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NoAnswerError, Sample, Transport, TransportError
from sequence_planner.ros.types.errors import MalformedMessageError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.standard_types import CANCEL_GOAL, GOAL_STATUSES

# Actions over any transport: goals that take time, with feedback, status, result and cancelling.
#
# An action `/arm/move` is three services and two topics below `/arm/move/_action` (ROS 2's design document on actions).
# Goals are known by 16 random bytes. A client that waits for a result asks again from time to time, so that a server
# that has gone, or has been started anew and knows nothing of the goal, is noticed.

Values = Mapping[str, object]

#: Seconds after which a client that waits for a result asks for it again.
RENEWAL = 5.0

#: Goals that have ended and are remembered, since their server can still be telling of them.
_REMEMBERED = 100


class GoalStatus(IntEnum):
    """The state of a goal, as action_msgs/msg/GoalStatus has it."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6

    @property
    def ended(self) -> bool:
        """True if nothing more will come of it."""
        return self >= GoalStatus.SUCCEEDED


_ENDED = {status for status in GoalStatus if status.ended}


class GoalOutcome(NamedTuple):
    """The way a goal ended, and the fields of the action's result."""

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


class AcceptedGoal:
    """A goal that a server has accepted. `status` is the last that the server told."""

    def __init__(self, client: ActionClient, goal_id: bytes, on_feedback: Callable[[Values], None] | None) -> None:
        self._client = client
        self.id = goal_id
        self.status = GoalStatus.ACCEPTED
        self.on_feedback = on_feedback

    async def result(self, renewal: float = RENEWAL) -> GoalOutcome:
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
        self._goals: dict[bytes, AcceptedGoal] = {}
        self._ended: deque[bytes] = deque(maxlen=_REMEMBERED)
        self._on_status = on_status
        self.others: dict[bytes, GoalStatus] = {}  # goals under way that this client does not know, or has given up
        self.malformed = 0  # messages received that are not of the action's type
        transport.subscribe(self._names.feedback, self._type.feedback_message, QualityOfService.RELIABLE, self._hear)
        transport.subscribe(self._names.status, GOAL_STATUSES, QualityOfService.LATCHED, self._hear_status)

    async def send_goal(
        self, goal: Values, within: float, on_feedback: Callable[[Values], None] | None = None
    ) -> AcceptedGoal:
        """Have the server accept a goal with these fields, within so many seconds.

        `on_feedback` is called with the fields of each feedback. Raises GoalRejectedError, NoServerError,
        NoAnswerError (the goal may be under way all the same), MessageValueError, and MalformedMessageError for an
        answer that cannot be read.
        """
        types, goal_id = self._type.send_goal, uuid.uuid4().bytes
        made = self._goals[goal_id] = AcceptedGoal(self, goal_id, on_feedback)  # Feedback can come before the answer.
        try:
            request = {"goal_id": {"uuid": list(goal_id)}, "goal": goal}
            answer = await self._call(self._names.send_goal, types.type_name, request, within)
            if not _Accepted.model_validate(answer).accepted:
                raise GoalRejectedError(f"{self._name} does not accept the goal")
        except BaseException:
            self.forget(made)
            raise
        return made

    async def result_of(self, goal: AcceptedGoal, renewal: float) -> GoalOutcome:
        """Wait for the end of a goal; see `AcceptedGoal.result`."""
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
            return GoalOutcome(goal.status, ended.result)

    async def cancel(self, goal: AcceptedGoal, within: float) -> None:
        """Ask for a goal to be given up; see `AcceptedGoal.cancel`."""
        await self._cancel(goal.id, within)

    async def cancel_others(self, within: float) -> None:
        """Ask for all of `others` to be given up; raises as `AcceptedGoal.cancel` does."""
        for goal_id in list(self.others):
            await self._cancel(goal_id, within)

    async def _cancel(self, goal_id: bytes, within: float) -> None:
        request = {"goal_info": {"goal_id": {"uuid": list(goal_id)}}}
        answer = _Cancelled.model_validate(await self._call(self._names.cancel_goal, CANCEL_GOAL, request, within))
        if answer.return_code != 0:
            codes = self._registry.constants(f"{CANCEL_GOAL}_Response")
            reason = next((name for name, code in codes.items() if code == answer.return_code), answer.return_code)
            raise GoalRejectedError(f"{self._name} does not cancel the goal: {reason}")

    def forget(self, goal: AcceptedGoal) -> None:
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


# The server's side of an action, for emulated devices.

_log = structlog.get_logger(__name__)

#: Goals that have ended and are remembered for who asks for their result.

_ERROR_UNKNOWN_GOAL_ID, _ERROR_GOAL_TERMINATED = 2, 3


class GoalWork:
    """A goal that is being carried out. `cancel_wanted` is set when a client wants it to be given up."""

    def __init__(self, server: ActionServer, goal_id: bytes, goal: Values) -> None:
        self._server = server
        self.id = goal_id
        self.goal = goal
        self.status = GoalStatus.ACCEPTED
        self.stamp = now()
        self.cancel_wanted = asyncio.Event()
        self.outcome: asyncio.Future[GoalOutcome] = asyncio.get_running_loop().create_future()

    def feedback(self, values: Values) -> None:
        """Tell the clients how it is going; raises MessageValueError."""
        self._server.publish_feedback(self, values)


Execute = Callable[[GoalWork], Awaitable[GoalOutcome]]


class ActionServer:
    """Carries out the goals of one action, each in a task of its own. Ends with the transport."""

    def __init__(
        self,
        transport: Transport,
        registry: MessageRegistry,
        name: str,
        type_name: str,
        execute: Execute,
        accepts: Callable[[Values], bool] = lambda goal: True,
    ) -> None:
        """Serve the action; raises as `Transport.serve` does. `accepts` says which goals are taken.

        A goal whose `execute` fails is aborted with an empty result, and the log says why.
        """
        self._transport = transport
        self._registry = registry
        self._type = registry.action(type_name)
        self._names = ActionNames(name)
        self._execute = execute
        self._accepts = accepts
        self._works: dict[bytes, GoalWork] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        transport.advertise(self._names.feedback, self._type.feedback_message, QualityOfService.RELIABLE)
        transport.advertise(self._names.status, GOAL_STATUSES, QualityOfService.LATCHED)
        transport.serve(self._names.send_goal, self._type.send_goal.type_name, self._take)
        transport.serve(self._names.get_result, self._type.get_result.type_name, self._answer_result)
        transport.serve(self._names.cancel_goal, CANCEL_GOAL, self._cancel)

    def close(self) -> None:
        """Stop carrying out goals, without another word to the clients; do this before the transport closes."""
        for task in self._tasks:
            task.cancel()

    def publish_feedback(self, work: GoalWork, values: Values) -> None:
        """Tell the clients how a goal is going; see `GoalWork.feedback`."""
        message = {"goal_id": {"uuid": list(work.id)}, "feedback": values}
        data = self._registry.encode(self._type.feedback_message, message)
        self._transport.publish(self._names.feedback, self._type.feedback_message, data)

    async def _take(self, request: bytes) -> bytes:
        types = self._type.send_goal
        wanted = self._registry.decode(types.request, request)
        goal_id, goal = _goal_id(wanted["goal_id"]), wanted["goal"]
        assert isinstance(goal, dict)
        accepted = goal_id not in self._works and self._accepts(goal)
        if accepted:
            work = self._works[goal_id] = GoalWork(self, goal_id, goal)
            self._forget_old()
            task = asyncio.get_running_loop().create_task(self._carry_out(work))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)
        return self._registry.encode(types.response, {"accepted": accepted, "stamp": now()})

    async def _carry_out(self, work: GoalWork) -> None:
        self._move(work, GoalStatus.EXECUTING)
        try:
            outcome = await self._execute(work)
            self._registry.encode(self._type.result, outcome.result)
        except Exception:
            _log.exception("a goal could not be carried out", action=self._type.type_name)
            outcome = GoalOutcome(GoalStatus.ABORTED, {})
        self._move(work, outcome.status)
        work.outcome.set_result(outcome)

    async def _answer_result(self, request: bytes) -> bytes:
        types = self._type.get_result
        work = self._works.get(_goal_id(self._registry.decode(types.request, request)["goal_id"]))
        # Shielded: a client that goes away must not end the goal for the others.
        outcome = GoalOutcome(GoalStatus.UNKNOWN, {}) if work is None else await asyncio.shield(work.outcome)
        return self._registry.encode(types.response, {"status": int(outcome.status), "result": outcome.result})

    async def _cancel(self, request: bytes) -> bytes:
        """Cancel one goal, or all where the identity is zero."""
        info = self._registry.decode(f"{CANCEL_GOAL}_Request", request)["goal_info"]
        assert isinstance(info, dict)
        goal_id = _goal_id(info["goal_id"])
        works = [work for work in self._works.values() if not any(goal_id) or work.id == goal_id]
        running = [work for work in works if not work.status.ended]
        for work in running:
            self._move(work, GoalStatus.CANCELING)
            work.cancel_wanted.set()
        code = 0
        if any(goal_id) and not running:
            code = _ERROR_GOAL_TERMINATED if works else _ERROR_UNKNOWN_GOAL_ID
        cancelling = [self._info(work) for work in running]
        answer = {"return_code": code, "goals_canceling": cancelling}
        return self._registry.encode(f"{CANCEL_GOAL}_Response", answer)

    def _move(self, work: GoalWork, status: GoalStatus) -> None:
        work.status = status
        statuses = [{"goal_info": self._info(each), "status": int(each.status)} for each in self._works.values()]
        data = self._registry.encode(GOAL_STATUSES, {"status_list": statuses})
        self._transport.publish(self._names.status, GOAL_STATUSES, data)

    def _info(self, work: GoalWork) -> dict[str, object]:
        return {"goal_id": {"uuid": list(work.id)}, "stamp": work.stamp}

    def _forget_old(self) -> None:
        ended = [work.id for work in self._works.values() if work.status.ended]
        for goal_id in ended[:-_REMEMBERED]:
            del self._works[goal_id]


def _goal_id(value: object) -> bytes:
    """Return the 16 bytes of a decoded unique_identifier_msgs/msg/UUID."""
    assert isinstance(value, dict)
    return bytes(value["uuid"])
