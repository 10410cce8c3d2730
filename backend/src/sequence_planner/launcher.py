"""Launcher: start and supervise all processes of a station, and print its address."""

from __future__ import annotations

import contextlib
import fcntl
import http.client
import os
import signal
import sys
import tempfile
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from socket import socket as ListeningSocket  # noqa: N812 - `socket` is the path of another one
from typing import Final

from sequence_planner.auth.oidc.options import ProviderOptions
from sequence_planner.backup.settings import Keeping
from sequence_planner.controller.deployment_folder import DeploymentFolder, DeploymentNote
from sequence_planner.core.logging import FORMAT, LogFormat, configure_logs, say
from sequence_planner.core.secrets import CLIENT_SECRET, PASSWORD, environment
from sequence_planner.core.storage_error import DATABASE
from sequence_planner.forking.child import reap_orphans
from sequence_planner.forking.starting import OWN
from sequence_planner.mes.webhooks.targets import Targets
from sequence_planner.process.memory_limit import USUAL, VARIABLE
from sequence_planner.process.parent_watch import DEMONSTRATION_DATABASE, LAST_WORDS_SUFFIX, NOT_EMULATED
from sequence_planner.process.restarts import write_restarts
from sequence_planner.process.service_manager import ServiceManager
from sequence_planner.process.unix_socket import LONGEST_PATH
from sequence_planner.retention.settings import Retention
from sequence_planner.server.binding import bind, check_demonstration, check_endpoint, trusting_context
from sequence_planner.server.settings import LARGEST_RECORDING, Endpoint, SettingsError, address_of
from sequence_planner.simulation.device_state import standing_file
from sequence_planner.startup.deployment import UnderWay
from sequence_planner.startup.preloads import CONTROLLER, EMULATOR, NETWORK, SERVER
from sequence_planner.startup.prestart import StationBeginning, begin, first_start
from sequence_planner.startup.station_process import UNUSABLE, Forked, StationProcess

# What a person who starts a station is told first: where it is opened, as soon as somebody answers there.

PATIENCE = 1.0  # seconds for an answer
TO_ITSELF = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # how this machine reaches what listens on all its addresses


UNWELL = 503  # what /healthz answers while the controller is not heard


def health(endpoint: Endpoint) -> int | None:
    """With which status `endpoint` answers whether it is alive: it may be for its proxy only. None without an answer.

    Over HTTPS it must be the endpoint's own certificate; nobody else needs to trust that here.
    """
    host = str(address_of(endpoint.host))
    host, port = TO_ITSELF.get(host, host), endpoint.port
    if endpoint.certificate is None:
        asking = http.client.HTTPConnection(host, port, timeout=PATIENCE)
    else:
        context = trusting_context(endpoint.certificate)
        asking = http.client.HTTPSConnection(host, port, timeout=PATIENCE, context=context)
    with contextlib.closing(asking):
        try:
            asking.request("GET", "/healthz")
            return asking.getresponse().status
        except (OSError, http.client.HTTPException):
            return None


def announced(endpoint: Endpoint, model: Path) -> str:
    """Say where the station in the folder `model` is opened."""
    return f"{model} runs: open {endpoint.address} (operator's view: {endpoint.address}/operator)"


# One command starts all processes of a station, and sees to it that they live.
#
# Controller and server are started again when they die. A model that was deployed and cannot be started gives way to
# the one before it. All are forked from one process that has imported what they need, see `forking`: most of what a
# start takes is over then. The socket on which people reach the server is this process's, so that who connects
# meanwhile waits, and is not turned away. Emulated devices are not started again: like real ones they stay away until
# somebody brings them back, but where another model was deployed they begin anew with it, as those before them stood.
# Production is started without a person only once; a controller that had to be started again waits for one. None of
# them outlives this process, even if it is killed: each holds a pipe from it (see `parent_watch`).

# The page as the build leaves it: in the package where that was installed, or beside the backend in the repository.
PACKAGED = Path(__file__).resolve().parent / "page"
PAGE = PACKAGED if PACKAGED.is_dir() else Path(__file__).resolve().parents[3] / "frontend" / "build"

LISTENER: Final = 200  # the least number of a descriptor that a part inherits: it has it where it was forked, too


@dataclass(frozen=True)
class Launch:
    """The description of what to run, and how; without the URL of a `database` a demonstration, whose own is forgotten
    at the end.

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
    largest_recording: int = LARGEST_RECORDING
    new: bool = False
    memory: float = USUAL  # GB, for each process that checks a model
    cut_off: DeploymentNote | None = None


def launch(request: Launch) -> int:
    """Run all processes until SIGTERM, SIGINT or SIGHUP; returns the exit code.

    Raises `SettingsError` when host, port, certificate or database cannot be used, when the model cannot and has no
    draft, and when the folder for temporary files has too long a name.
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
            begun = begin(StationBeginning(request.model, url, request.new, shared=request.hot_standby is not None))
            for each in begun.said:
                say(each)
            if begun.refused is not None:
                raise SettingsError(begun.refused)
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
        network = NETWORK if request.transport == "cyclonedds" else ()  # nothing of another ROS 2 is to be there
        controller = [model, "--socket", str(socket), *transport]
        controller += ["--emulated"] if request.emulator else []
        controller += ["--hot-standby", request.hot_standby] if request.hot_standby is not None else []
        speed = ["--speed", str(request.emulator_speed)]
        # Not as an argument: the URL may hold a password, and everybody on this machine may read what `ps` shows.
        of_controller = {**environment(PASSWORD), DATABASE: url}
        of_server = {**environment(PASSWORD, CLIENT_SECRET), DATABASE: url}
        self._controller = StationProcess(
            "controller",
            Forked(["controller", *controller], (*CONTROLLER, *network)),
            of_controller,
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
        server += [f"--largest-recording={request.largest_recording}"]
        # It listens as long as this process lives: whoever connects while a server has died waits for the next one.
        listening = fcntl.fcntl(listener, fcntl.F_DUPFD_CLOEXEC, LISTENER)
        server += [*_options(request.endpoint), f"--listener={listening}"]
        kept = (listening,)
        self._server = StationProcess("server", Forked(["server", *server], SERVER, inherited=kept), of_server)
        self._standing = standing_file(self._folder)
        emulator = Forked(
            ["emulate", model, *speed, *transport, "--keep-in", str(self._standing)], (*EMULATOR, *network)
        )
        self._emulator = StationProcess(
            "emulated devices", emulator, last_words=self._folder / f"emulator{LAST_WORDS_SUFFIX}"
        )
        self._deployment = UnderWay(
            request.model, self._folder, self._controller, self._emulator if request.emulator else None
        )

    def run(self) -> int:
        """Start everything and watch over it."""
        reap_orphans()
        try:
            self._server.spawn()  # which has most to import that nobody else needs
            if self._request.emulator:
                self._emulator.spawn()
            self._controller.spawn(*(["--start"] if self._request.start else []))
            threading.Thread(target=self._announce, daemon=True).start()
            told: dict[str, int] = {}
            while not self._stop.wait(0.2):
                if told != (restarts := {each.name: each.restarts for each in (self._controller, self._server)}):
                    write_restarts(self._folder, restarts)
                    told = restarts
                for each in (self._controller, self._server, self._emulator):
                    each.look()
                with contextlib.suppress(OSError):  # then it is tried once more
                    OWN.look_after()
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
            say("there are no emulated devices: change the model on its page, under Engineering, and deploy it")
        elif code is not None:
            say(
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
        say(announced(endpoint, model))
        if self._request.database is not None:
            self._tell_first_start()
        self._watch()

    def _tell_first_start(self) -> None:
        endpoint, model = self._request.endpoint, self._request.model
        try:
            how = first_start(model, self._url, endpoint, at_terminal=sys.stdout.isatty())
        except (SettingsError, OSError) as error:  # it can still be asked for with `users setup-link`
            how = str(error)
        if how is not None:
            say(how)

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
    options += [f"--name={name}" for name in endpoint.names]
    return [*options, *(f"--wall-beside={url}" for url in endpoint.wall_beside)]
