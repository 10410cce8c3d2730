"""Keeps a function's process: asks it in a thread of its own, and replaces it when it gives no answer."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Mapping
from concurrent.futures import Future

from sequence_planner.pipelines.stages.own.process import Function, FunctionFailed, FunctionProcess, OwnStageError

FIRST_REST = 0.1  # seconds before a process that gave no answer is replaced, twice as long each time in a row
LONGEST_REST = 5.0

_Request = tuple[Mapping[str, object], float, "Future[object]"]


class Keeper:
    """Starts at once. No call waits."""

    def __init__(self, function: Function) -> None:
        self._function = function
        self._requests: queue.SimpleQueue[_Request | None] = queue.SimpleQueue()
        self._process: FunctionProcess | None = None
        self._closed = False
        self._lock = threading.Lock()
        self._failures = 0  # in a row
        self._rests_until = 0.0
        self._trouble = ""
        threading.Thread(target=self._work, daemon=True, name=f"stage {function}").start()

    def ask(self, arguments: Mapping[str, object], deadline: float) -> Future[object]:
        """What the function returns for these arguments; its exception is an `OwnStageError`.

        The deadline counts from when the process can be asked.
        """
        future: Future[object] = Future()
        if self._closed:
            future.set_exception(OwnStageError("has been closed"))
        else:
            self._requests.put((arguments, deadline, future))
        return future

    def close(self) -> None:
        """End the process, and the thread. What has been asked gets no answer. May be repeated."""
        with self._lock:
            self._closed = True
            if self._process is not None:
                self._process.kill()
        self._requests.put(None)

    def _work(self) -> None:
        self._prepare()
        while (request := self._requests.get()) is not None and not self._closed:
            arguments, deadline, future = request
            try:
                future.set_result(self._call(arguments, deadline))
            except OwnStageError as error:
                future.set_exception(error)
            if time.monotonic() >= self._rests_until:
                self._prepare()
        self._end()

    def _call(self, arguments: Mapping[str, object], deadline: float) -> object:
        if time.monotonic() < self._rests_until:
            raise OwnStageError(self._trouble)
        process = self._started()
        try:
            returned = process.call(arguments, deadline)
        except FunctionFailed:
            raise
        except OwnStageError as error:
            raise self._replaced(error) from None
        self._failures = 0
        return returned

    def _prepare(self) -> None:
        """Start the process before it is asked; a failure is told to the one who asks."""
        try:
            self._started()
        except OwnStageError:
            return

    def _started(self) -> FunctionProcess:
        if self._process is not None:
            return self._process
        try:
            with self._lock:
                if self._closed:
                    raise OwnStageError("has been closed")
                self._process = FunctionProcess(self._function)
            self._process.load()
        except OSError as error:
            raise self._replaced(OwnStageError(f"cannot be started: {error}")) from None
        except OwnStageError as error:
            raise self._replaced(error) from None
        return self._process

    def _replaced(self, error: OwnStageError) -> OwnStageError:
        """End the process; the next is started after a rest, so that one that always fails costs little."""
        self._end()
        self._failures += 1
        self._trouble = str(error)
        rest = FIRST_REST * 2 ** min(self._failures - 1, 10)
        self._rests_until = time.monotonic() + min(rest, LONGEST_REST)
        return error

    def _end(self) -> None:
        with self._lock:
            process, self._process = self._process, None
        if process is not None:
            process.close()
