"""What watches are shown: each the tasks of its own resource, and nothing else of the station."""

from __future__ import annotations

import time
from functools import partial

from sequence_planner.control.view import StationView, TaskView
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.latest import Latest
from sequence_planner.web.looking_messages import Silence
from sequence_planner.web.settings import StreamLimits
from sequence_planner.web.stream_messages import ControllerState
from sequence_planner.web.watch_messages import WatchSnapshot

TELL_EVERY = 0.4  # seconds after which the next view is told even if nothing has changed but the time


def own_tasks(view: StationView, resource: str) -> dict[str, TaskView]:
    """The tasks that wait for a person at `resource`, by id."""
    return {name: task for name, task in view.tasks.items() if task.resource == resource}


class WatchShow:
    """The tasks of each resource, told when they change and each second, and when the controller falls silent."""

    def __init__(self, controller: ControllerClient, limits: StreamLimits) -> None:
        self._controller = controller
        self._limits = limits
        self._shown: dict[str, Latest] = {}
        self._told: dict[str, tuple[object, float]] = {}  # by resource: what was told last, and when it is time again
        self._is_heard = False
        controller.listen(self._heard)
        controller.listen_to_silence(self._look)

    def of(self, resource: str) -> Latest:
        """What the watches of `resource` are shown."""
        if resource not in self._shown:
            self._shown[resource] = Latest(partial(self._present, resource), self._limits)
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
        for resource, latest in self._shown.items():
            if not latest.somebody.is_set():
                continue
            matter = (
                view.mode,
                view.standing,
                view.silent,
                view.failing,
                view.station.title,
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
            station=view.station.title,
            mode=view.mode,
            standing=view.standing,
            silent=view.silent,
            failing=view.failing,
            tasks=own_tasks(view, resource),
        ).model_dump_json()
