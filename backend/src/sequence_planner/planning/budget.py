"""How long a question may be worked on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager


class SpentError(Exception):
    """The time is over, or nobody waits for the answer any more."""


class Budget:
    """Until a moment on the clock of `time.monotonic`, or until it is called off from another thread."""

    def __init__(self, until: float) -> None:
        self.until = until
        self._off = threading.Event()
        self._lock = threading.Lock()
        self._interrupts: list[Callable[[], object]] = []

    @classmethod
    def seconds(cls, seconds: float) -> Budget:
        """So many from now on."""
        return cls(time.monotonic() + seconds)

    @property
    def remaining(self) -> float:
        """The seconds that are left, none when it was called off."""
        return 0.0 if self._off.is_set() else max(self.until - time.monotonic(), 0.0)

    @property
    def spent(self) -> bool:
        """Whether work on the question must end."""
        return self._off.is_set() or time.monotonic() >= self.until

    def require(self) -> None:
        """Raises `SpentError` when work on the question must end."""
        if self.spent:
            raise SpentError

    def call_off(self) -> None:
        """Nobody waits for the answer any more. From any thread."""
        with self._lock:
            self._off.set()
            interrupts = list(self._interrupts)
        for interrupt in interrupts:
            interrupt()

    @contextmanager
    def interrupting(self, interrupt: Callable[[], object]) -> Iterator[None]:
        """While the body runs, `interrupt` is called, in another thread, as soon as the budget is spent."""
        alarm = threading.Timer(self.remaining, interrupt)
        with self._lock:
            self._interrupts.append(interrupt)
        alarm.start()
        try:
            yield
        finally:
            alarm.cancel()
            alarm.join()
            with self._lock:
                self._interrupts.remove(interrupt)

    def part(self, share: float) -> Budget:
        """A share of the time that is left; calling off the whole calls off the part."""
        part = Budget(time.monotonic() + share * self.remaining)
        part._off, part._lock, part._interrupts = self._off, self._lock, self._interrupts
        return part
