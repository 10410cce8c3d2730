"""WebSocket endpoints: the station stream, and the task stream of watches."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import NamedTuple, Protocol

from fastapi import WebSocket, WebSocketDisconnect
from pydantic import ValidationError
from starlette.types import Message

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.auth.watches import Watch
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.controller.views.station import (
    JobStepState,
    StationStanding,
    StationView,
    StepStatus,
    TaskView,
)
from sequence_planner.core.actor import Actor
from sequence_planner.core.data_models import complained
from sequence_planner.core.storage_error import StorageError
from sequence_planner.execution.vocabulary import JobState
from sequence_planner.server.api.watches import WatchAlarm, WatchDoing, WatchNext, WatchProgress, WatchSnapshot
from sequence_planner.server.auth import Access, allowed, watch_only
from sequence_planner.server.errors import ProblemFound
from sequence_planner.server.interface import interface
from sequence_planner.server.settings import StreamLimits
from sequence_planner.server.stream.broadcast import Broadcast, LatestValue, Subscriber
from sequence_planner.server.stream.messages import ControllerState, Resync, Silence

# The WebSocket `/api/v1/stream`: the station as it changes.
#
# Three tasks serve a client: one sends what its subscriber holds, one reads what the client says, and one sees whether
# it still may listen. A client that takes no message for too long is closed with code 1013 ("try again later"); it may
# come back and gets a snapshot. One whose session, key or watch has ended is closed with code 4401.

LOOK_EVERY = 1.0  # seconds between looks at whether a client still may listen
LAST_WORDS = 30.0  # seconds in which a dropped client may still learn why

stream_router = interface()


class StreamEnd(NamedTuple):
    """A reason why the server closes a stream; `code` is that of RFC 6455, or of ours from 4000 on."""

    code: int
    reason: str


TOO_MANY, TOO_SLOW = StreamEnd(1013, "too many clients"), StreamEnd(1013, "too slow")
NO_DATABASE = StreamEnd(1013, "the database is not available")
SIGNED_OUT = StreamEnd(4401, "signed out")


class Source(Protocol):
    """A source that clients subscribe to."""

    limits: StreamLimits

    def subscription(self) -> AbstractContextManager[Subscriber | None]:
        """A subscriber for as long as the block lasts; None when there are too many already."""


@stream_router.websocket("/stream", dependencies=[allowed(Role.VIEWER, scope=Scope.READ)])
async def stream(websocket: WebSocket) -> None:
    """Serve one client until it leaves or is dropped."""
    broadcast: Broadcast = websocket.app.state.broadcast
    await serve(websocket, broadcast)


async def serve(websocket: WebSocket, source: Source) -> None:
    """Serve one client of `source` until it leaves, is dropped, or may no longer listen."""
    await websocket.accept()
    with _counted(websocket, source.limits) as fits, source.subscription() if fits else nullcontext() as subscriber:
        ending = TOO_MANY if subscriber is None else await _converse(websocket, subscriber, source.limits)
    if ending is not None:
        with contextlib.suppress(TimeoutError, WebSocketDisconnect, RuntimeError):
            async with asyncio.timeout(LAST_WORDS):
                await websocket.close(ending.code, ending.reason)


@contextlib.contextmanager
def _counted(websocket: WebSocket, limits: StreamLimits) -> Iterator[bool]:
    """Count the stream; whether it is not one too many for who listens."""
    streams: Counter[str] = websocket.app.state.streams
    actor: Actor = websocket.state.actor
    streams[actor.id] += 1
    try:
        yield streams[actor.id] <= limits.of_one
    finally:
        streams[actor.id] -= 1
        if not streams[actor.id]:
            del streams[actor.id]


async def _converse(websocket: WebSocket, subscriber: Subscriber, limits: StreamLimits) -> StreamEnd | None:
    """Serve until one of the tasks ends; why the server ends it, None if the client has left."""
    sending = asyncio.create_task(_send(websocket, subscriber, limits))
    listening = asyncio.create_task(_listen(websocket, subscriber, limits))
    watching = asyncio.create_task(_watch_over(websocket))
    tasks = (sending, listening, watching)
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        sent, listened, watched = await asyncio.gather(*tasks, return_exceptions=True)
    for outcome in (sent, listened, watched):
        if isinstance(outcome, Exception) and not isinstance(outcome, TimeoutError | WebSocketDisconnect):
            raise outcome
    if isinstance(watched, StreamEnd):
        return watched
    return TOO_SLOW if isinstance(sent, TimeoutError) else None


async def _watch_over(websocket: WebSocket) -> StreamEnd:
    """Look whether the client still may listen; why not, as soon as it may not."""
    access: Access = websocket.state.access
    while True:
        await asyncio.sleep(LOOK_EVERY)
        try:
            await access.admit(websocket)
        except ProblemFound:
            return SIGNED_OUT
        except StorageError:
            return NO_DATABASE


async def _send(websocket: WebSocket, subscriber: Subscriber, limits: StreamLimits) -> None:
    while True:
        message = await subscriber.next()
        async with asyncio.timeout(limits.send_seconds):
            await websocket.send_text(message)


async def _listen(websocket: WebSocket, subscriber: Subscriber, limits: StreamLimits) -> None:
    while True:
        frame = await websocket.receive()
        if frame["type"] == "websocket.disconnect":
            return
        if (wrong := _fault(frame, limits.frame)) is not None:
            subscriber.complain(wrong)
        else:
            subscriber.resync()  # the only thing that a client can ask for


def _fault(frame: Message, longest: int) -> str | None:
    """Return what is wrong with a frame; None when it is a message of ours."""
    text = frame.get("text")
    if text is None:
        return "Binary frames are not understood; send JSON text."
    if len(text) > longest:
        return f"The frame is longer than {longest} characters."
    try:
        Resync.model_validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        if first["type"] == "json_invalid":
            return "The frame is not JSON."
        place = ".".join(map(str, first["loc"])) or "the frame"
        return f'Only {{"kind": "resync"}} is understood. {place}: {complained(first)}.'
    return None


# What watches are shown: each the tasks of its own resource, and nothing else of the station.

TELL_EVERY = 0.4  # seconds after which the next view is told even if nothing has changed but the time


def own_tasks(view: StationView, resource: str) -> dict[str, TaskView]:
    """The tasks that wait for a person at `resource`, by id."""
    return {name: task for name, task in view.tasks.items() if task.resource == resource}


_TO_COME = (StepStatus.NEXT, StepStatus.PLANNED)


def watch_alarm(view: StationView) -> WatchAlarm | None:
    """The alarm that every watch names while help is needed."""
    if view.named_alarm is None or not (view.failing or view.standing is StationStanding.STOPPED):
        return None
    first = view.alarms[view.named_alarm]
    return WatchAlarm(
        text=first.text,
        action=first.action,
        message=first.messages.text,
        action_message=first.messages.action,
        priority=first.priority,
        state=first.state,
        since=first.since,
    )


def next_task(view: StationView, resource: str) -> WatchNext | None:
    """What the plan asks next of a person at `resource`, and about when."""
    if view.standing not in (StationStanding.WORKING, StationStanding.SILENT):
        return None
    for step in view.plan.steps:
        if step.resource == resource and step.status in _TO_COME and view.abilities[step.ability].human:
            return WatchNext(ability=step.ability, title=step.title, at=step.expected_start)
    return None


def progress_of(view: StationView) -> WatchProgress | None:
    """How far the order in work is; where the station works freely, its operations since the first of them began."""
    for job in view.jobs.values():
        if job.state is JobState.RUNNING:
            states = [step.state for step in job.steps.values() if step.state is not JobStepState.SKIPPED]
            return WatchProgress(done=states.count(JobStepState.COMPLETED), all=len(states))
    operations = list(view.operations.values())
    if view.by_order or not operations:
        return None
    began = operations[0].active_since if operations[0].active_since is not None else operations[0].began
    done = [each for each in operations if not each.active and each.ended is not None and each.ended >= (began or 0.0)]
    return WatchProgress(done=len(done), all=len(operations))


def doing_in(view: StationView) -> list[WatchDoing]:
    """Return what devices do by the plan. What is not heard may do it or not, and so may what does not go on."""
    if view.standing is not StationStanding.WORKING or view.failing:
        return []
    running = [each for each in view.plan.steps if each.status is StepStatus.RUNNING]
    return [
        WatchDoing(ability=each.ability, title=each.title) for each in running if not view.abilities[each.ability].human
    ]


def awaits_order(view: StationView) -> bool:
    """Return whether nothing is made as the station works by order and no order may start."""
    is_working = view.standing in (StationStanding.WORKING, StationStanding.SILENT)
    return view.by_order and is_working and all(job.state.is_over for job in view.jobs.values())


class WatchShow:
    """The tasks of each resource, told when they change and each second, and when the controller falls silent."""

    def __init__(self, controller: ControllerClient, limits: StreamLimits) -> None:
        self._controller = controller
        self._limits = limits
        self._shown: dict[str, LatestValue] = {}
        self._told: dict[str, tuple[object, float]] = {}  # by resource: what was told last, and when it is time again
        self._is_heard = False
        controller.listen(self._heard)
        controller.listen_to_silence(self._look)

    def of(self, resource: str) -> LatestValue:
        """Return what the watches of `resource` are shown."""
        if resource not in self._shown:
            self._shown[resource] = LatestValue(partial(self._present, resource), self._limits)
        return self._shown[resource]

    def _look(self) -> None:
        if self._is_heard and not self._controller.heard:
            self._is_heard = False
            self._told.clear()
            for latest in self._shown.values():
                latest.tell()

    def _heard(self, view: StationView) -> None:
        self._is_heard = True
        now = time.monotonic()
        alarm = watch_alarm(view)
        for resource, latest in self._shown.items():
            if not latest.somebody.is_set():
                continue
            to_come = next_task(view, resource)
            matter = (
                view.mode,
                view.standing,
                view.silent,
                view.failing,
                view.station.title,
                alarm,
                None if to_come is None else to_come.title,
                own_tasks(view, resource),
            )
            told, due = self._told.get(resource, (None, now))
            if matter != told or now >= due:
                self._told[resource] = (matter, now + TELL_EVERY)
                latest.tell()

    def _present(self, resource: str) -> str:
        view = self._controller.view
        if view is None or not self._controller.heard:
            return Silence(kind="link", controller=ControllerState.LOST).model_dump_json()
        return WatchSnapshot(
            kind="watch",
            time=view.time,
            age=self._controller.age,
            station=view.station.title,
            mode=view.mode,
            standing=view.standing,
            silent=view.silent,
            failing=view.failing,
            alarm=watch_alarm(view),
            next=next_task(view, resource),
            progress=progress_of(view),
            doing=doing_in(view),
            awaits_order=awaits_order(view),
            tasks=own_tasks(view, resource),
        ).model_dump_json()


# The WebSocket `/api/v1/wearables/stream`: what a confirmed watch is shown.

watch_stream_router = interface("/wearables")


@watch_stream_router.websocket("/stream", dependencies=[watch_only()])
async def watch_stream(websocket: WebSocket) -> None:
    """Serve one watch with the tasks of its own resource until it leaves, or is no longer a watch of this station."""
    show: WatchShow = websocket.app.state.watch_show
    watch: Watch = websocket.state.watch
    await serve(websocket, show.of(watch.resource))
