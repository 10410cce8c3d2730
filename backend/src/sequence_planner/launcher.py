"""One command starts all processes of a station, and sees to it that they live.

Controller and server are started again when they die. Of the controller a spare is kept, a process that has imported
all that it needs and waits: half of what a start takes is over then. Emulated devices are not started again: like real
ones they stay away until somebody brings them back, but where another model was deployed they begin anew with it.
Production is started without a person only once; a controller that had to be started again waits for one. None of them
outlives this process, even if it is killed: each holds a pipe from it (see `lifeline`).
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import structlog

from sequence_planner.announcement import UNWELL, announced, first_start, health
from sequence_planner.backup.settings import Keeping
from sequence_planner.control.unix_socket import LONGEST_PATH
from sequence_planner.identity.openid.options import ProviderOptions
from sequence_planner.lifeline import DEMONSTRATION_DATABASE, DEPLOYED, NEEDED, OVERTAKEN
from sequence_planner.logs import FORMAT, LogFormat, configure_logs
from sequence_planner.mes.webhooks.targets import Targets
from sequence_planner.parts_file import write_restarts
from sequence_planner.secret_variables import CLIENT_SECRET, PASSWORD, environment
from sequence_planner.service_manager import ServiceManager
from sequence_planner.storage.address import PostgresqlServer
from sequence_planner.storage.database import Database
from sequence_planner.storage.environment import DATABASE
from sequence_planner.web.binding import check_demonstration, check_free
from sequence_planner.web.settings import Endpoint, SettingsError

# The page as the build leaves it: in the package where that was installed, or beside the backend in the repository.
PACKAGED = Path(__file__).resolve().parent / "page"
PAGE = PACKAGED if PACKAGED.is_dir() else Path(__file__).resolve().parents[3] / "frontend" / "build"

LOG = structlog.get_logger(__name__)
UNUSABLE = 2  # the exit code with which a process says that it cannot be run as asked
FIRST_PAUSE = 0.5  # seconds before a process is started again; doubled each time, up to the longest
LONGEST_PAUSE = 10.0
STEADY = 60.0  # seconds after which a process that lives has recovered
PATIENCE = 5.0  # seconds in which a process may end in good order
SPARE_AFTER = 10.0  # seconds after which a process that lives gets a spare; until then its start is not held up
SPARE = "--spare"  # of a command: it waits until it is needed


@dataclass(frozen=True)
class Launch:
    """What to run, and how; without the URL of a `database` a demonstration, whose own is forgotten at the end."""

    model: Path
    endpoint: Endpoint
    database: str | None
    transport: str
    rosbridge: str | None
    emulator: bool
    start: bool
    emulator_speed: float
    hot_standby: str | None = None
    provider: ProviderOptions = field(default_factory=ProviderOptions)
    log_format: LogFormat = LogFormat.TEXT
    webhooks: Targets = field(default_factory=Targets)
    backups: Keeping = field(default_factory=Keeping)


class Part:
    """A process of the station, which is started again when it dies. It gets the environment `given`, or one without
    secrets.

    One that `has_spare` is followed at once by another process that was started before. Whenever it is started after
    the first time it is told `again`.
    """

    def __init__(
        self,
        name: str,
        command: list[str],
        given: Mapping[str, str] | None = None,
        has_spare: bool = False,
        again: Sequence[str] = (),
    ) -> None:
        self.name = name
        self._told_again = again
        self._has_spare = has_spare
        self.spare: subprocess.Popen[bytes] | None = None
        self._spare_due = 0.0
        self._environment = environment() if given is None else given
        self.process: subprocess.Popen[bytes] | None = None
        self._command = command
        self._pause = FIRST_PAUSE
        self._due = 0.0  # on the clock of `time.monotonic`, as is `_begun`
        self._begun = 0.0
        self._again = False
        self.deployed = False  # it has made room for another model
        self.restarts = 0  # how often it has died and was started again

    @property
    def steady(self) -> bool:
        """Whether it has lived long enough to have been able to run."""
        return time.monotonic() - self._begun >= STEADY

    def spawn(self, *more: str) -> None:
        """Start it; `more` arguments are for this time only."""
        self.process = self._popen(*more)
        self._begun = time.monotonic()
        self._spare_due = self._begun + SPARE_AFTER

    def _popen(self, *more: str) -> subprocess.Popen[bytes]:
        # A session of its own: an interrupt from the terminal reaches the launcher alone, which then ends the others.
        return subprocess.Popen(
            [*self._command, *more], stdin=subprocess.PIPE, start_new_session=True, env=self._environment
        )

    def look_after(self) -> int:
        """Start it again some time after it has died. The exit code when it could not be run from the first."""
        now = time.monotonic()
        if self.process is None:
            if now >= self._due:
                self.spawn(*self._told_again)
            return 0
        code = self.process.poll()
        if code is None:
            self._look_after_spare(now)
            return 0
        if code == UNUSABLE and not self._again and not self.steady:
            return code
        if self.steady or code in (DEPLOYED, OVERTAKEN):
            self._pause = FIRST_PAUSE
        self._forget()
        self._again = True
        if code in (DEPLOYED, OVERTAKEN):
            self.deployed = code == DEPLOYED
            if code == OVERTAKEN:
                _say("another station has taken the command, and this one stands by")
            if not self._follow(now):
                self.spawn(*self._told_again)
            return 0
        self.restarts += 1
        if self._follow(now):
            _say(f"the {self.name} ended with code {code}, and its spare goes on")
            return 0
        _say(f"the {self.name} ended with code {code} and is started again in {self._pause:g} s")
        self._due = now + self._pause
        self._pause = min(self._pause * 2, LONGEST_PAUSE)
        return 0

    def _look_after_spare(self, now: float) -> None:
        """Start a spare where there is none, some time after what it is for, or after one that has died."""
        if self.spare is not None and self.spare.poll() is not None:
            _close(self.spare)
            self.spare, self._spare_due = None, now + LONGEST_PAUSE
        if self._has_spare and self.spare is None and now >= self._spare_due:
            self.spare = self._popen(SPARE)

    def _follow(self, now: float) -> bool:
        """Let the spare go on, if there is one."""
        spare, self.spare = self.spare, None
        if spare is None:
            return False
        try:
            assert spare.stdin is not None
            os.write(spare.stdin.fileno(), NEEDED)
        except OSError:  # it has died just now
            spare.wait()
            _close(spare)
            return False
        self.process, self._begun = spare, now
        self._spare_due = now + SPARE_AFTER
        return True

    def terminate(self) -> None:
        """Ask it to end, and its spare."""
        for process in (self.process, self.spare):
            if process is not None:
                process.terminate()

    def has_ended(self) -> int | None:
        """The exit code, once, of a process that is not started again."""
        code = None if self.process is None else self.process.poll()
        if code is not None:
            self._forget()
        return code

    def end(self) -> None:
        """End it in good order, or kill it if that takes too long."""
        for process in (self.process, self.spare):
            if process is None:
                continue
            try:
                process.wait(timeout=PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            _close(process)
        self.process = self.spare = None

    def _forget(self) -> None:
        if self.process is not None:
            _close(self.process)
        self.process = None


def launch(request: Launch) -> int:
    """Run all processes until SIGTERM, SIGINT or SIGHUP; returns the exit code.

    Raises `SettingsError` when host, port or certificate cannot be used, or the folder for temporary files has too long
    a name, and `StorageError` when the database cannot be used.
    """
    os.environ[FORMAT] = request.log_format  # of all parts, and what these start
    if request.log_format is LogFormat.JSON:
        configure_logs()
    check_free(request.endpoint)
    if request.database is None:
        check_demonstration(request.endpoint)
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        if signal.getsignal(number) is not signal.SIG_IGN:  # as it is under `nohup`
            signal.signal(number, lambda *_: stop.set())
    with tempfile.TemporaryDirectory(prefix="sequence-planner-") as folder:
        socket = Path(folder) / "controller.socket"
        if len(str(socket).encode()) > LONGEST_PATH:
            raise SettingsError(f"the path of {socket} is too long for a socket; set TMPDIR to a shorter folder")
        url = request.database or f"sqlite:///{socket.parent / DEMONSTRATION_DATABASE}"
        with contextlib.closing(Database.open(url)) as database:
            if request.hot_standby is not None and not isinstance(database.place, PostgresqlServer):
                raise SettingsError(f"several stations cannot share {database.place}: --hot-standby takes PostgreSQL")
            database.upgrade()
        return _Launcher(request, url, socket, stop).run()


class _Launcher:
    def __init__(self, request: Launch, url: str, socket: Path, stop: threading.Event) -> None:
        self._request = request
        self._url = url
        self._stop = stop
        self._folder = socket.parent
        self._manager = ServiceManager()  # before there are parts, which are not to inherit what it goes by
        model, transport = str(request.model), ["--transport", request.transport]
        transport += ["--rosbridge", request.rosbridge] if request.rosbridge else []
        controller = [model, "--socket", str(socket), *transport]
        controller += ["--emulated"] if request.emulator else []
        controller += ["--hot-standby", request.hot_standby] if request.hot_standby is not None else []
        speed = ["--speed", str(request.emulator_speed)]
        # Not as an argument: the URL may hold a password, and everybody on this machine may read what `ps` shows.
        of_controller = {**environment(PASSWORD), DATABASE: url}
        of_server = {**environment(PASSWORD, CLIENT_SECRET), DATABASE: url}
        self._controller = Part(
            "controller", _command("controller", *controller), of_controller, has_spare=True, again=("--again",)
        )
        server = ["--socket", str(socket), "--page", str(PAGE), "--model", model, "--transport", request.transport]
        server += ["--demonstration"] if request.database is None else []
        server += request.provider.arguments()
        server += [f"--webhook-host={host}" for host in request.webhooks.written]
        server += ["--webhook-loopback"] if request.webhooks.loopback else []
        server += request.backups.arguments()
        self._server = Part("server", _command("server", *server, *_options(request.endpoint)), of_server)
        self._emulator = Part("emulated devices", _command("emulate", model, *speed, *transport))

    def run(self) -> int:
        """Start everything and watch over it."""
        try:
            if self._request.emulator:
                self._emulator.spawn()
            self._controller.spawn(*(["--start"] if self._request.start else []))
            self._server.spawn()
            threading.Thread(target=self._announce, daemon=True).start()
            told: dict[str, int] = {}
            while not self._stop.wait(0.2):
                if told != (restarts := {each.name: each.restarts for each in (self._controller, self._server)}):
                    write_restarts(self._folder, restarts)
                    told = restarts
                code = self._notice_emulator() or self._controller.look_after() or self._server.look_after()
                if code:
                    return code
                if self._controller.deployed:
                    self._controller.deployed = False
                    self._begin_emulator_anew()
            return 0
        finally:
            self._stop.set()
            self._manager.stopping()
            parts = (self._server, self._controller, self._emulator)
            for part in parts:
                part.terminate()
            for part in parts:
                part.end()

    def _begin_emulator_anew(self) -> None:
        """Another model may have other devices."""
        if self._request.emulator:
            self._emulator.terminate()
            self._emulator.end()
            self._emulator.spawn()

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
        """Print the address as soon as somebody answers there, and how to begin where there are no people yet."""
        endpoint, model = self._request.endpoint, self._request.model
        while health(endpoint) is None:
            if self._stop.wait(0.1):
                return
        self._manager.ready()
        _say(announced(endpoint, model))
        if self._request.database is not None and (how := first_start(self._url, endpoint, model)):
            _say(how)
        self._watch()

    def _watch(self) -> None:
        """Tell whoever watches over this that the station is alive, as long as it is.

        A process that hangs does not end, so nothing here would start it again: then all of it begins anew.
        """
        patience = self._manager.patience
        while patience is not None and not self._stop.wait(patience / 4):
            if health(self._request.endpoint) not in (None, UNWELL):
                self._manager.alive()


def _options(endpoint: Endpoint) -> list[str]:
    """The options of `server` that mean `endpoint`."""
    options = [f"--host={endpoint.host}", f"--port={endpoint.port}"]
    if endpoint.certificate is not None:
        options += [f"--certificate={endpoint.certificate}", f"--private-key={endpoint.private_key}"]
    options += [f"--proxy={proxy}" for proxy in endpoint.proxies]
    return [*options, *(f"--name={name}" for name in endpoint.names)]


def _command(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "sequence_planner.cli", *arguments, "--launched"]


def _close(process: subprocess.Popen[bytes]) -> None:
    """Let go of its lifeline."""
    if process.stdin is not None:
        process.stdin.close()


def _say(text: str) -> None:
    """On standard output, or as an event where no person reads that: a secret is only told at a terminal."""
    if os.environ.get(FORMAT) == LogFormat.JSON and not sys.stdout.isatty():
        LOG.info(text)
        return
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
