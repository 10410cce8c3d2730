"""One command starts all processes of a station, and sees to it that they live.

Controller and server are started again when they die. A model that was deployed and cannot be started gives way to the
one before it. Of each a spare is kept, a process that has imported all that it needs and waits: most of what a start
takes is over then. The socket on which people reach the server is this process's, so that who connects meanwhile waits,
and is not turned away. Emulated devices are not started again: like real ones they stay away until somebody brings them
back, but where another model was deployed they begin anew with it, as those before them stood.
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
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from socket import socket as ListeningSocket  # noqa: N812 - `socket` is the path of another one

import structlog

from sequence_planner.announcement import UNWELL, announced, first_start, health
from sequence_planner.backup.settings import Keeping
from sequence_planner.control.unix_socket import LONGEST_PATH
from sequence_planner.deployment_folder import DeploymentFolder, DeploymentNote
from sequence_planner.deployment_under_way import UnderWay
from sequence_planner.emulation.standing import standing_file
from sequence_planner.identity.openid.options import ProviderOptions
from sequence_planner.journal.last_word import set_aside
from sequence_planner.lifeline import (
    DEMONSTRATION_DATABASE,
    DEPLOYED,
    LAST_WORDS_FILE,
    LAST_WORDS_SUFFIX,
    NEEDED,
    NOT_EMULATED,
    OVERTAKEN,
)
from sequence_planner.logs import FORMAT, LogFormat, configure_logs
from sequence_planner.memory_limit import USUAL, VARIABLE
from sequence_planner.mes.webhooks.targets import Targets
from sequence_planner.parts_file import write_restarts
from sequence_planner.retention.settings import Retention
from sequence_planner.secret_variables import CLIENT_SECRET, PASSWORD, environment
from sequence_planner.service_manager import ServiceManager
from sequence_planner.storage.address import PostgresqlServer
from sequence_planner.storage.database import Database
from sequence_planner.storage.environment import DATABASE
from sequence_planner.storage.error import StorageError
from sequence_planner.web.binding import bind, check_demonstration, check_endpoint
from sequence_planner.web.settings import Endpoint, SettingsError
from sequence_planner.workshop import draft as drafts

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
    """What to run, and how; without the URL of a `database` a demonstration, whose own is forgotten at the end.

    A database that is empty where a station was is used only where a `new` one is meant. `unusable` says why the model
    means nothing: where it has a draft it can be repaired in the browser. `cut_off` is a deployment that was undone, as
    an earlier `run` did not come to its end.
    """

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
    retention: Retention = field(default_factory=Retention)
    new: bool = False
    memory: float = USUAL  # GB, for each process that checks a model
    unusable: str | None = None
    cut_off: DeploymentNote | None = None


class Part:
    """A process of the station, which is started again when it dies. It gets the environment `given`, or one without
    secrets.

    One that `has_spare` is followed at once by another process that was started before. Whenever it is started after
    the first time it is told `again`. It gets the `inherited` descriptors.
    """

    def __init__(
        self,
        name: str,
        command: list[str],
        given: Mapping[str, str] | None = None,
        has_spare: bool = False,
        again: Sequence[str] = (),
        inherited: Sequence[int] = (),
        last_words: Path | None = None,
    ) -> None:
        self.name = name
        self._inherited = inherited
        self._last_words = last_words
        self._told_again = again
        self._has_spare = has_spare
        self.spare: subprocess.Popen[bytes] | None = None
        self._spare_due = 0.0
        self._environment = environment() if given is None else given
        if last_words is not None:
            self._environment = {**self._environment, LAST_WORDS_FILE: str(last_words)}
        self.process: subprocess.Popen[bytes] | None = None
        self.ended: int | None = None
        """The exit code of a process that was seen to have ended (`look`) and was not looked after yet."""
        self._command = command
        self._pause = FIRST_PAUSE
        self._due = 0.0  # on the clock of `time.monotonic`, as is `_begun`
        self._begun = 0.0
        self._again = False
        self.restarts = 0  # how often it has died and was started again

    @property
    def steady(self) -> bool:
        """Whether it has lived long enough to have been able to run."""
        return time.monotonic() - self._begun >= STEADY

    def spawn(self, *more: str) -> None:
        """Start it; `more` arguments are for this time only."""
        self.process, self.ended = self._popen(*more), None
        self._begun = time.monotonic()
        self._spare_due = self._begun + SPARE_AFTER

    def _popen(self, *more: str) -> subprocess.Popen[bytes]:
        if self._last_words is not None:
            self._last_words.unlink(missing_ok=True)
        # A session of its own: an interrupt from the terminal reaches the launcher alone, which then ends the others.
        return subprocess.Popen(
            [*self._command, *more],
            stdin=subprocess.PIPE,
            start_new_session=True,
            env=self._environment,
            pass_fds=self._inherited,
        )

    def look(self) -> None:
        """See whether it has ended. All that is done because of that goes by the same look, whenever it ends."""
        self.ended = None if self.process is None else self.process.poll()

    def said(self, code: int) -> str:
        """Why it has ended: what it said last, if anything."""
        with contextlib.suppress(OSError):
            if self._last_words is not None and (words := self._last_words.read_text(encoding="utf-8").strip()):
                return words
        return f"the {self.name} ended with code {code}, and the log says why"

    def stop(self) -> None:
        """End it, and not its spare."""
        if self.process is not None:
            self.process.terminate()
            _wait(self.process)
        self.process = self.ended = None

    def look_after(self) -> int:
        """Start it again some time after it has died. The exit code when it could not be run from the first."""
        now = time.monotonic()
        if self.process is None:
            if now >= self._due:
                self.spawn(*self._told_again)
            return 0
        code = self.ended
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
        code = self.ended
        if code is not None:
            self._forget()
        return code

    def end(self) -> None:
        """End it in good order, or kill it if that takes too long."""
        for process in (self.process, self.spare):
            if process is None:
                continue
            _wait(process)
        self.process = self.spare = None

    def _forget(self) -> None:
        if self.process is not None:
            _close(self.process)
        self.process = self.ended = None


def launch(request: Launch) -> int:
    """Run all processes until SIGTERM, SIGINT or SIGHUP; returns the exit code.

    Raises `SettingsError` when host, port or certificate cannot be used, the model cannot and has no draft, or the
    folder for temporary files has too long a name, and `StorageError` when the database cannot be used.
    """
    # Of all parts, and what these start.
    with _variables({FORMAT: request.log_format.value, VARIABLE: str(request.memory)}):
        if request.log_format is LogFormat.JSON:
            configure_logs()
        check_endpoint(request.endpoint)
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
            if request.unusable is not None:
                if not _has_draft(url):
                    raise SettingsError(request.unusable)
                _say(f"{request.unusable}\nthe model cannot be used: change its draft on its page, and deploy that")
            with contextlib.closing(Database.open(url, new=request.new)) as database:
                if request.hot_standby is not None and not isinstance(database.place, PostgresqlServer):
                    text = f"several stations cannot share {database.place}: --hot-standby takes PostgreSQL"
                    raise SettingsError(text)
                if request.new and database.is_empty:
                    for path, kept in set_aside(database.place, datetime.now(UTC)):
                        _say(f"a new station begins: the last word of another one, {path}, is kept as {kept}")
                database.upgrade(new=request.new)
            if request.cut_off is not None:
                DeploymentFolder(socket.parent).begin_undone(request.cut_off)
            with contextlib.closing(bind(request.endpoint)) as listener:
                return _Launcher(request, url, socket, listener, stop).run()


@contextlib.contextmanager
def _variables(values: Mapping[str, str]) -> Iterator[None]:
    """Set variables of the environment, and what they were before in the end."""
    before = {name: os.environ.get(name) for name in values}
    os.environ |= values
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


class _Launcher:
    def __init__(
        self, request: Launch, url: str, socket: Path, listener: ListeningSocket, stop: threading.Event
    ) -> None:
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
            "controller",
            _command("controller", *controller),
            of_controller,
            has_spare=True,
            again=("--again",),
            last_words=self._folder / f"controller{LAST_WORDS_SUFFIX}",
        )
        server = ["--socket", str(socket), "--page", str(PAGE), "--model", model, "--transport", request.transport]
        server += ["--demonstration"] if request.database is None else []
        server += ["--emulated"] if request.emulator else []
        server += ["--rosbridge", request.rosbridge] if request.rosbridge else []
        server += request.provider.arguments()
        server += [f"--webhook-host={host}" for host in request.webhooks.written]
        server += [f"--webhook-network={network}" for network in request.webhooks.networks]
        server += ["--webhook-loopback"] if request.webhooks.loopback else []
        server += request.backups.arguments()
        server += request.retention.arguments()
        # It listens as long as this process lives: whoever connects while a server has died waits for the next one.
        server += [*_options(request.endpoint), f"--listener={listener.fileno()}"]
        kept = (listener.fileno(),)
        self._server = Part("server", _command("server", *server), of_server, has_spare=True, inherited=kept)
        self._listener = listener
        self._standing = standing_file(self._folder)
        emulator = _command("emulate", model, *speed, *transport, "--keep-in", str(self._standing))
        self._emulator = Part("emulated devices", emulator, last_words=self._folder / f"emulator{LAST_WORDS_SUFFIX}")
        self._deployment = UnderWay(
            request.model, self._folder, self._controller, self._emulator if request.emulator else None
        )

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
                for each in (self._controller, self._server, self._emulator):
                    each.look()
                self._deployment.look()
                code = self._notice_emulator() or self._controller.look_after() or self._server.look_after()
                if code:
                    return code
            return 0
        finally:
            self._stop.set()
            self._manager.stopping()
            parts = (self._server, self._controller, self._emulator)
            for part in parts:
                part.terminate()
            for part in parts:
                part.end()

    def _notice_emulator(self) -> int:
        """Say that the emulated devices have ended. The exit code when at first they refuse to run beside others."""
        code = self._emulator.has_ended()
        if code == UNUSABLE and not self._emulator.steady and not self._deployment.was:
            return code
        if code == NOT_EMULATED:
            _say("there are no emulated devices: change the model on its page, under Engineering, and deploy it")
        elif code is not None:
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


def _has_draft(url: str) -> bool:
    """Whether somebody has edited the model in the browser, so that it can be repaired there. No database is made."""
    try:
        with contextlib.closing(Database.open(url, create=False)) as database:
            database.upgrade()
            with database.reading() as connection:
                return drafts.read(connection).number > 0
    except StorageError:
        return False


def _options(endpoint: Endpoint) -> list[str]:
    """The options of `server` that mean `endpoint`."""
    options = [f"--host={endpoint.host}", f"--port={endpoint.port}"]
    if endpoint.certificate is not None:
        options += [f"--certificate={endpoint.certificate}", f"--private-key={endpoint.private_key}"]
    options += [f"--proxy={proxy}" for proxy in endpoint.proxies]
    return [*options, *(f"--name={name}" for name in endpoint.names)]


def _command(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "sequence_planner.cli", *arguments, "--launched"]


def _wait(process: subprocess.Popen[bytes]) -> None:
    """Wait until it has ended in good order, or kill it if that takes too long."""
    try:
        process.wait(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    _close(process)


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
