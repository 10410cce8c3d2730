"""The time for which a question may be worked on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import inf

_HELD_UP = 4.0  # times as long as without others on the machine


class SpentError(Exception):
    """The time is over, or nobody waits for the answer any more."""


class Budget:
    """Until a moment on the clock of `time.monotonic`, or until it is called off from another thread.

    Or until a moment on the clock of `time.process_time`, which stands still while others have the processor.
    """

    def __init__(self, until: float, worked_until: float = inf) -> None:
        self.until = until
        self._worked_until = worked_until
        self._off = threading.Event()
        self._lock = threading.Lock()
        self._interrupts: list[Callable[[], object]] = []

    @classmethod
    def seconds(cls, seconds: float) -> Budget:
        """So many from now on."""
        return cls(time.monotonic() + seconds)

    @property
    def remaining(self) -> float:
        """The seconds that are left at least, none when it was called off."""
        if self._off.is_set():
            return 0.0
        left = self.until - time.monotonic()
        if self._worked_until != inf:
            left = min(left, self._worked_until - time.process_time())
        return max(left, 0.0)

    @property
    def spent(self) -> bool:
        """True if work on the question must end."""
        return self.remaining == 0.0

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
        done = threading.Event()
        alarm = threading.Thread(target=self._ring, args=(interrupt, done))
        with self._lock:
            self._interrupts.append(interrupt)
        alarm.start()
        try:
            yield
        finally:
            done.set()
            alarm.join()
            with self._lock:
                self._interrupts.remove(interrupt)

    def part(self, share: float) -> Budget:
        """A share of the time and of the work that is left; calling off the whole calls off the part."""
        now, worked = time.monotonic(), time.process_time()
        return self._of_this(
            now + share * max(self.until - now, 0.0), worked + share * max(self._worked_until - worked, 0.0)
        )

    def working(self, seconds: float) -> Budget:
        """As much of it as this process works for so many seconds, however long others hold it up."""
        return self._of_this(self.until, min(time.process_time() + seconds, self._worked_until))

    def by_the_clock(self) -> Budget:
        """The same, however much this process works meanwhile."""
        return self._of_this(self.until, inf)

    def seconds_of_work(self, seconds: float) -> Budget:
        """As `working`, and by the clock no more than some times as long."""
        working = self.working(seconds)
        working.until = min(time.monotonic() + _HELD_UP * seconds, self.until)
        return working

    def part_of_work(self, share: float) -> Budget:
        """A share of the time that is left, counted as `seconds_of_work` does."""
        return self.seconds_of_work(share * self.remaining)

    def _of_this(self, until: float, worked_until: float) -> Budget:
        part = Budget(until, worked_until)
        part._off, part._lock, part._interrupts = self._off, self._lock, self._interrupts
        return part

    def _ring(self, interrupt: Callable[[], object], done: threading.Event) -> None:
        """Wait until the budget is spent, which may take longer than it seemed; nothing more when it is done before."""
        while not self.spent:
            if done.wait(self.remaining):
                return
        interrupt()
