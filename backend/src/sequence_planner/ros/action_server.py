"""The server's side of an action, for emulated devices."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

import structlog

from sequence_planner.ros.actions import ActionNames, GoalStatus, Outcome, Values, now
from sequence_planner.ros.derived import CANCEL_GOAL, GOAL_STATUSES
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.quality import QualityOfService
from sequence_planner.ros.transport import Transport

_log = structlog.get_logger(__name__)

#: Goals that have ended and are remembered for who asks for their result.
_REMEMBERED = 100

_ERROR_UNKNOWN_GOAL_ID, _ERROR_GOAL_TERMINATED = 2, 3


class Work:
    """A goal that is being carried out. `cancel_wanted` is set when a client wants it to be given up."""

    def __init__(self, server: ActionServer, goal_id: bytes, goal: Values) -> None:
        self._server = server
        self.id = goal_id
        self.goal = goal
        self.status = GoalStatus.ACCEPTED
        self.stamp = now()
        self.cancel_wanted = asyncio.Event()
        self.outcome: asyncio.Future[Outcome] = asyncio.get_running_loop().create_future()

    def feedback(self, values: Values) -> None:
        """Tell the clients how it is going; raises MessageValueError."""
        self._server.publish_feedback(self, values)


Execute = Callable[[Work], Awaitable[Outcome]]


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
        self._works: dict[bytes, Work] = {}
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

    def publish_feedback(self, work: Work, values: Values) -> None:
        """Tell the clients how a goal is going; see `Work.feedback`."""
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
            work = self._works[goal_id] = Work(self, goal_id, goal)
            self._forget_old()
            task = asyncio.get_running_loop().create_task(self._carry_out(work))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)
        return self._registry.encode(types.response, {"accepted": accepted, "stamp": now()})

    async def _carry_out(self, work: Work) -> None:
        self._move(work, GoalStatus.EXECUTING)
        try:
            outcome = await self._execute(work)
            self._registry.encode(self._type.result, outcome.result)
        except Exception:
            _log.exception("a goal could not be carried out", action=self._type.type_name)
            outcome = Outcome(GoalStatus.ABORTED, {})
        self._move(work, outcome.status)
        work.outcome.set_result(outcome)

    async def _answer_result(self, request: bytes) -> bytes:
        types = self._type.get_result
        work = self._works.get(_goal_id(self._registry.decode(types.request, request)["goal_id"]))
        # Shielded: a client that goes away must not end the goal for the others.
        outcome = Outcome(GoalStatus.UNKNOWN, {}) if work is None else await asyncio.shield(work.outcome)
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

    def _move(self, work: Work, status: GoalStatus) -> None:
        work.status = status
        statuses = [{"goal_info": self._info(each), "status": int(each.status)} for each in self._works.values()]
        data = self._registry.encode(GOAL_STATUSES, {"status_list": statuses})
        self._transport.publish(self._names.status, GOAL_STATUSES, data)

    def _info(self, work: Work) -> dict[str, object]:
        return {"goal_id": {"uuid": list(work.id)}, "stamp": work.stamp}

    def _forget_old(self) -> None:
        ended = [work.id for work in self._works.values() if work.status.ended]
        for goal_id in ended[:-_REMEMBERED]:
            del self._works[goal_id]


def _goal_id(value: object) -> bytes:
    """Return the 16 bytes of a decoded unique_identifier_msgs/msg/UUID."""
    assert isinstance(value, dict)
    return bytes(value["uuid"])
