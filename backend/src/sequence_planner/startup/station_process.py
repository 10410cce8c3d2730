"""A process of a station, which is started again when it dies."""

from __future__ import annotations

import contextlib
import os
import pickle
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final, Protocol

from sequence_planner.core.logging import say
from sequence_planner.core.secrets import environment
from sequence_planner.forking.child import Child
from sequence_planner.forking.request import ForkRequest
from sequence_planner.forking.starting import OWN, VARIABLE, ask, working_folder
from sequence_planner.process.parent_watch import DEPLOYED, LAST_WORDS_FILE, OVERTAKEN

UNUSABLE: Final = 2  # the exit code with which a process says that it cannot be run as asked
FIRST_PAUSE: Final = 0.5  # seconds before a process is started again; doubled each time, up to the longest
LONGEST_PAUSE: Final = 10.0
BRIEF: Final = 10.0  # seconds; a process that has lived longer is started again without a pause
STEADY: Final = 60.0  # seconds after which a process that lives has recovered
PATIENCE: Final = 5.0  # seconds in which a process may end in good order

Process = Child | subprocess.Popen[bytes]


class Program(Protocol):
    """The program that a process runs."""

    def start(self, more: Sequence[str], environment: Mapping[str, str], standard_input: int) -> Process:
        """Start it with `more` arguments, and with the end of a pipe as its standard input."""
        ...


class Executed:
    """A command line of this machine; it gets the `inherited` descriptors."""

    def __init__(self, command: Sequence[str], inherited: Sequence[int] = ()) -> None:
        self._command = command
        self._inherited = inherited

    def start(self, more: Sequence[str], environment: Mapping[str, str], standard_input: int) -> Process:
        """Start it."""
        # A session of its own: an interrupt from the terminal reaches the launcher alone, which then ends the others.
        return subprocess.Popen(
            [*self._command, *more],
            stdin=standard_input,
            start_new_session=True,
            env=environment,
            pass_fds=self._inherited,
        )


class Forked:
    """A command of this program, forked by the fork server of this process, which imports `modules` for it.

    While there is none the command is executed, which takes longer.
    """

    def __init__(self, arguments: Sequence[str], modules: Sequence[str], inherited: Sequence[int] = ()) -> None:
        self._arguments = [*arguments, "--launched"]
        self._modules = tuple(modules)
        self._inherited = tuple(inherited)
        self._executed = Executed([sys.executable, "-m", "sequence_planner.cli", *self._arguments], inherited)

    def start(self, more: Sequence[str], environment: Mapping[str, str], standard_input: int) -> Process:
        """Start it."""
        lives = OWN.lives
        try:
            server = OWN.path()
        except OSError:  # memory is short, say
            return self._executed.start(more, environment, standard_input)
        environment = {**environment, VARIABLE: str(server)}
        if not lives:
            return self._executed.start(more, environment, standard_input)
        arguments = [*self._arguments, *more]
        request = ForkRequest(
            "sequence_planner.cli.main:run",
            pickle.dumps((arguments,)),
            self._modules,
            " ".join(["sequence-planner", *arguments]),
            environment,
            list(sys.path),
            working_folder(),
            places=(0, *self._inherited),
            leads=True,
            left=True,
        )
        try:
            return ask(server, request, [standard_input, *self._inherited], arguments[0])
        except OSError:  # it does not take it
            return self._executed.start(more, environment, standard_input)


class StationProcess:
    """A process of the station, which is started again when it dies. It gets the environment `given`, or one without
    secrets.

    One that has lived for some time is followed at once by another. Whenever it is started after the first time it is
    told `again`.
    """

    def __init__(
        self,
        name: str,
        program: Program,
        given: Mapping[str, str] | None = None,
        again: Sequence[str] = (),
        last_words: Path | None = None,
    ) -> None:
        self.name = name
        self._program = program
        self._last_words = last_words
        self._told_again = again
        self._environment = environment() if given is None else given
        if last_words is not None:
            self._environment = {**self._environment, LAST_WORDS_FILE: str(last_words)}
        self.process: Process | None = None
        self._lifeline = -1  # the other end of its standard input
        self._kept_open: list[int] = []  # those of processes that were not wanted before they had begun
        self.ended: int | None = None
        """The exit code of a process that was seen to have ended (`look`) and was not looked after yet."""
        self._pause = FIRST_PAUSE
        self._due = 0.0  # on the clock of `time.monotonic`, as is `_begun`
        self._begun = 0.0
        self._again = False
        self.restarts = 0  # how often it has died and was started again

    @property
    def steady(self) -> bool:
        """True if it has lived long enough to have been able to run."""
        return self._age >= STEADY

    @property
    def lives(self) -> bool:
        """True if it runs."""
        return self.process is not None and self.process.poll() is None

    @property
    def _age(self) -> float:
        return time.monotonic() - self._begun

    def spawn(self, *more: str) -> None:
        """Start it; `more` arguments are for this time only."""
        if self._last_words is not None:
            self._last_words.unlink(missing_ok=True)
        self._forget()
        reading, self._lifeline = os.pipe()
        try:
            self.process = self._program.start(more, self._environment, reading)
        finally:
            os.close(reading)
        self._begun = time.monotonic()

    def look(self) -> None:
        """See whether it has ended. All that is done because of that goes by the same look, whenever it ends."""
        self.ended = None if self.process is None else self.process.poll()

    def said(self, code: int) -> str:
        """Return why it has ended: what it said last, if anything."""
        with contextlib.suppress(OSError):
            if self._last_words is not None and (words := self._last_words.read_text(encoding="utf-8").strip()):
                return words
        return f"the {self.name} ended with code {code}, and the log says why"

    def stop(self) -> None:
        """End it."""
        self.terminate()
        self.end()

    def look_after(self) -> int:
        """Start it again some time after it has died. The exit code when it could not be run from the first."""
        now = time.monotonic()
        if self.process is None:
            if now >= self._due:
                self._spawn_again(now)
            return 0
        code = self.ended
        if code is None:
            return 0
        if code == UNUSABLE and not self._again and not self.steady:
            return code
        if self.steady or code in (DEPLOYED, OVERTAKEN):
            self._pause = FIRST_PAUSE
        lived = self._age
        self._forget()
        self._again = True
        if code in (DEPLOYED, OVERTAKEN):
            if code == OVERTAKEN:
                say("another station has taken the command, and this one stands by")
            self._spawn_again(now)
            return 0
        self.restarts += 1
        if lived >= BRIEF:
            say(f"the {self.name} ended with code {code} and is started again")
            self._spawn_again(now)
            return 0
        say(f"the {self.name} ended with code {code} and is started again in {self._pause:g} s")
        self._put_off(now)
        return 0

    def _spawn_again(self, now: float) -> None:
        try:
            self.spawn(*self._told_again)
        except OSError as error:
            say(f"the {self.name} cannot be started: {error.strerror}; it is tried again in {self._pause:g} s")
            self._forget()
            self._put_off(now)

    def _put_off(self, now: float) -> None:
        self._due = now + self._pause
        self._pause = min(self._pause * 2, LONGEST_PAUSE)

    def terminate(self) -> None:
        """Ask it to end."""
        if self.process is not None:
            self.process.terminate()

    def has_ended(self) -> int | None:
        """The exit code, once, of a process that is not started again."""
        code = self.ended
        if code is not None:
            self._forget()
        return code

    def end(self) -> None:
        """End it in good order, or kill it if that takes too long."""
        if self.process is not None:
            try:
                self.process.wait(timeout=PATIENCE)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self._forget()

    def hang_up(self) -> None:
        """Close its standard input, which ends what goes by that."""
        if self._lifeline >= 0:
            os.close(self._lifeline)
            self._lifeline = -1

    def _forget(self) -> None:
        if isinstance(self.process, Child) and self.process.was_withdrawn:
            # Should it begin all the same it is ended at once, and must not take that for the end of the launcher.
            self._kept_open.append(self._lifeline)
            self._lifeline = -1
        self.hang_up()
        self.process = self.ended = None
