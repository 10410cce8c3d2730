"""One command starts all processes of a station, and sees to it that they live.

Controller and server are started again when they die. Emulated devices are not: like real ones they stay away until
somebody brings them back. Production is started without a person only once; a controller that had to be started again
waits for one. None of them outlives this process, even if it is killed: each holds a pipe from it (see `lifeline`).
"""

from __future__ import annotations

import signal
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request
from dataclasses import dataclass
from pathlib import Path

from sequence_planner.control.unix_socket import LONGEST_PATH
from sequence_planner.web.settings import SettingsError, check_port

# The page as the build leaves it, beside the backend in the repository.
PAGE = Path(__file__).resolve().parents[3] / "frontend" / "build"

UNUSABLE = 2  # the exit code with which a process says that it cannot be run as asked
FIRST_PAUSE = 0.5  # seconds before a process is started again; doubled each time, up to the longest
LONGEST_PAUSE = 10.0
STEADY = 60.0  # seconds after which a process that lives has recovered
PATIENCE = 5.0  # seconds in which a process may end in good order


@dataclass(frozen=True)
class Launch:
    """What to run, and how."""

    model: Path
    host: str
    port: int
    transport: str
    rosbridge: str | None
    emulator: bool
    start: bool
    emulator_speed: float


class Part:
    """A process of the station, which is started again when it dies."""

    def __init__(self, name: str, command: list[str]) -> None:
        self.name = name
        self.process: subprocess.Popen[bytes] | None = None
        self._command = command
        self._pause = FIRST_PAUSE
        self._due = 0.0  # on the clock of `time.monotonic`, as is `_begun`
        self._begun = 0.0
        self._again = False

    @property
    def steady(self) -> bool:
        """Whether it has lived long enough to have been able to run."""
        return time.monotonic() - self._begun >= STEADY

    def spawn(self, *more: str) -> None:
        """Start it; `more` arguments are for this time only."""
        # A session of its own: an interrupt from the terminal reaches the launcher alone, which then ends the others.
        self.process = subprocess.Popen([*self._command, *more], stdin=subprocess.PIPE, start_new_session=True)
        self._begun = time.monotonic()

    def look_after(self) -> int:
        """Start it again some time after it has died. The exit code when it could not be run from the first."""
        now = time.monotonic()
        if self.process is None:
            if now >= self._due:
                self.spawn()
            return 0
        code = self.process.poll()
        if code is None:
            return 0
        if code == UNUSABLE and not self._again and not self.steady:
            return code
        if self.steady:
            self._pause = FIRST_PAUSE
        self._forget()
        _say(f"the {self.name} ended with code {code} and is started again in {self._pause:g} s")
        self._again = True
        self._due = now + self._pause
        self._pause = min(self._pause * 2, LONGEST_PAUSE)
        return 0

    def has_ended(self) -> int | None:
        """The exit code, once, of a process that is not started again."""
        code = None if self.process is None else self.process.poll()
        if code is not None:
            self._forget()
        return code

    def end(self) -> None:
        """End it in good order, or kill it if that takes too long."""
        if self.process is None:
            return
        try:
            self.process.wait(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self._forget()

    def _forget(self) -> None:
        if self.process is not None and self.process.stdin is not None:
            self.process.stdin.close()
        self.process = None


def launch(request: Launch) -> int:
    """Run all processes until SIGTERM, SIGINT or SIGHUP; returns the exit code.

    Raises `SettingsError` when host or port cannot be used, or the folder for temporary files has too long a name.
    """
    check_port(request.host, request.port)
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        if signal.getsignal(number) is not signal.SIG_IGN:  # as it is under `nohup`
            signal.signal(number, lambda *_: stop.set())
    with tempfile.TemporaryDirectory(prefix="sequence-planner-") as folder:
        socket = Path(folder) / "controller.socket"
        if len(str(socket).encode()) > LONGEST_PATH:
            raise SettingsError(f"the path of {socket} is too long for a socket; set TMPDIR to a shorter folder")
        return _Launcher(request, socket, stop).run()


class _Launcher:
    def __init__(self, request: Launch, socket: Path, stop: threading.Event) -> None:
        self._request = request
        self._stop = stop
        model, transport = str(request.model), ["--transport", request.transport]
        transport += ["--rosbridge", request.rosbridge] if request.rosbridge else []
        controller = [model, "--socket", str(socket), *transport]
        controller += ["--emulated"] if request.emulator else []
        address = ["--host", request.host, "--port", str(request.port)]
        speed = ["--speed", str(request.emulator_speed)]
        self._controller = Part("controller", _command("controller", *controller))
        server = ["--socket", str(socket), "--page", str(PAGE), "--model", model, "--transport", request.transport]
        self._server = Part("server", _command("server", *server, *address))
        self._emulator = Part("emulated devices", _command("emulate", model, *speed, *transport))

    def run(self) -> int:
        """Start everything and watch over it."""
        try:
            if self._request.emulator:
                self._emulator.spawn()
            self._controller.spawn(*(["--start"] if self._request.start else []))
            self._server.spawn()
            threading.Thread(target=self._announce, daemon=True).start()
            while not self._stop.wait(0.2):
                code = self._notice_emulator() or self._controller.look_after() or self._server.look_after()
                if code:
                    return code
            return 0
        finally:
            self._stop.set()
            parts = (self._server, self._controller, self._emulator)
            for part in parts:
                if part.process is not None:
                    part.process.terminate()
            for part in parts:
                part.end()

    def _notice_emulator(self) -> int:
        """Say that the emulated devices have ended. The exit code when they refuse to run beside others."""
        code = self._emulator.has_ended()
        if code == UNUSABLE and not self._emulator.steady:
            return code
        if code is not None:
            _say(
                "the emulated devices have ended; start them again with `make emulator`, "
                f"or `sequence-planner emulate {self._request.model}`"
            )
        return 0

    def _announce(self) -> None:
        """Print the address as soon as somebody answers there."""
        address = f"http://{self._request.host}:{self._request.port}"
        direct = urllib.request.build_opener(urllib.request.ProxyHandler({}))  # the loopback is nothing for a proxy
        while not self._stop.wait(0.1):
            try:
                with direct.open(f"{address}/healthz", timeout=1):
                    break
            except (urllib.error.URLError, OSError):
                continue
        else:
            return
        _say(f"{self._request.model} runs: open {address} (operator's watch: {address}/watch)")


def _command(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "sequence_planner.cli", *arguments, "--launched"]


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
