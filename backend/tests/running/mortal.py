"""A station whose processes are killed and started one by one, and an operator who brings it back to work."""

from __future__ import annotations

import contextlib
import random
import signal
import subprocess
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from running.judging import Kept
from sequence_planner.core.storage_error import DATABASE
from sequence_planner.db.database import Database
from sequence_planner.journal.run_journal import RunRecord
from support.network import free_port
from support.places import REPOSITORY
from support.station import MODEL, command, descendants, environment, signed_in
from support.waiting import until

SPEED = 10.0  # of the devices
PATIENCE = 240.0  # on a machine that is busy with much else
BUSY = 30.0  # seconds for an answer there
PARTS = {"server": ("server",), "controller": ("controller",), "both": ("controller", "server")}


@dataclass
class Mortal:
    """The station in front of its operator. `seen` is what has been met.

    Its database is a file in its folder, or where `url` says; with `standby` it shares that with others. Its devices
    are emulated, unless `emulated` says that there are others.
    """

    folder: Path
    database: Database
    chance: random.Random
    url: str = ""
    standby: str | None = None
    server: tuple[str, ...] = ()  # more options of it
    model: Path = MODEL
    emulated: bool = True
    port: int = field(default_factory=free_port)
    seen: Counter[str] = field(default_factory=Counter)
    _parts: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.kept = Kept(self.database)
        self.url = self.url or f"sqlite:///{self.folder}/station.sqlite"
        self.browser = signed_in(REPOSITORY / self.model, self.port, self.url)
        self.browser.timeout = BUSY

    def start(self, part: str) -> None:
        """Start one of its processes."""
        socket = ("--socket", str(self.folder / "socket"))
        standby = ("--hot-standby", self.standby) if self.standby else ()
        arguments = {
            "emulate": ("--speed", str(SPEED)),
            "controller": (*socket, *(("--emulated",) if self.emulated else ()), *standby),
            "server": (*socket, "--page", str(self.folder), "--port", str(self.port), *self.server),
        }[part]
        model = ("--model", str(self.model)) if part == "server" else (str(self.model),)
        with (self.folder / f"{part}.log").open("ab") as log:
            self._parts[part] = subprocess.Popen(
                command(part, *model, *arguments),
                cwd=REPOSITORY,
                env={**environment(), DATABASE: self.url},
                stdout=log,
                stderr=log,
            )

    def signal(self, part: str, number: signal.Signals) -> None:
        """Send a signal to one of its processes."""
        self._parts[part].send_signal(number)

    def ended(self, part: str) -> int | None:
        """The exit code of one of its processes; None while it lives."""
        return self._parts[part].poll()

    def kill(self, part: str) -> None:
        """It has no time to end in good order."""
        self._parts[part].send_signal(signal.SIGKILL)
        self._parts[part].wait()

    def kill_and_start(self, what: str) -> None:
        """One of `PARTS` is killed, and started again."""
        for part in PARTS[what]:
            self.kill(part)
            self.seen[f"{part}s killed"] += 1
        for part in PARTS[what]:
            self.start(part)

    def end(self) -> None:
        """All processes end in good order, those that were stopped too."""
        for each in self._parts.values():
            each.terminate()
            each.send_signal(signal.SIGCONT)
        for each in self._parts.values():
            each.wait(timeout=PATIENCE)

    def children(self, part: str) -> list[int]:
        """The processes that a part has started, and that from which they are forked."""
        return [each.number for each in descendants(self.pid(part))]

    def pid(self, part: str) -> int:
        """The process id of one of its processes."""
        return self._parts[part].pid

    def memory(self, part: str) -> int:
        """The resident memory of one of its processes, in MB."""
        status = Path(f"/proc/{self.pid(part)}/status").read_text(encoding="ascii")
        return int(status.partition("VmRSS:")[2].split()[0]) // 1000

    def metrics(self) -> str:
        """The station in figures."""
        return self.browser.get(f"http://127.0.0.1:{self.port}/metrics").raise_for_status().text

    def production(self) -> str | None:
        """What the station says of production; None while nobody answers."""
        code = self._parts["controller"].poll()
        assert code is None, f"the controller ended with {code}: {self.log('controller')}"
        with contextlib.suppress(httpx.HTTPError):
            answer = self.browser.get("station")
            if answer.status_code == httpx.codes.OK:
                return str(answer.json()["production"])
        return None

    def mode(self) -> str:
        """The mode that the station says it is in."""
        return str(self.browser.get("station").raise_for_status().json()["mode"])

    def log(self, part: str) -> str:
        """The last that a part has said."""
        return (self.folder / f"{part}.log").read_text()[-3000:]

    def wait(self, what: Callable[[], bool], why: str) -> None:
        """Until that is true. AssertionError, with what the controller says, when it does not come true."""
        try:
            until(what, seconds=PATIENCE)
        except AssertionError:
            raise AssertionError(f"{why}: {self.shown()}\n{self.log('controller')}\n{self.log('server')}") from None

    def shown(self) -> object:
        """What the station shows."""
        try:
            return self.browser.get("station").json(), self.browser.get("plan").json()
        except httpx.HTTPError as error:
            return str(error)

    def ask(self, method: str, path: str, body: dict[str, object]) -> httpx.Response:
        """What is answered; control is taken where it is needed."""
        answer = self.browser.request(method, path, json=body)
        if answer.status_code == httpx.codes.CONFLICT and answer.json()["type"] == "/problems/control-needed":
            self.browser.put("control-lock", json={"over": None}).raise_for_status()
            answer = self.browser.request(method, path, json=body)
        return answer

    def acknowledge(self) -> None:
        """Do what people are asked to do. What has changed meanwhile is refused."""
        for id_, task in self.browser.get("tasks").json()["tasks"].items():
            self.ask("POST", f"tasks/{id_}/acknowledgement", {"revision": task["revision"]})

    def decide(self) -> bool:
        """Decide what devices shall do, where somebody has to; whether that was so."""
        undecided = self.browser.get("station").json()["undecided"]
        for name, each in undecided.items():
            value = self.chance.choice([each["value"], *each["quiet"]])
            answer = self.ask("PUT", "restored-outputs", {"values": {name: value}, "reason": "looked at"})
            self.seen["outputs decided on" if answer.is_success else "decisions refused"] += 1
        return bool(undecided)

    def begin_production(self) -> None:
        """Decide what devices shall do, and start production."""
        self.wait(lambda: self.production() == "waiting", "it is not up")

        def started() -> bool:
            self.decide()
            answer = self.ask("POST", "production/start", {"reason": "looked at"})
            if answer.status_code == httpx.codes.CONFLICT:
                assert answer.json()["type"] in ("/problems/outputs-unconfirmed",), answer.text
            return answer.is_success

        self.wait(started, "production cannot be started")

    def get_back_to_work(self, *, at_rest: bool = False) -> None:
        """Until something starts or finishes that was not done before. Nothing but what REST shows is known.

        Where it is `at_rest`, as nobody was sure that nobody had paused it, it says so, and a person lets it go on.
        """
        self.begin_production()
        self.kept.look()
        if at_rest:
            assert self.mode() == "paused" and "begins-at-rest" in self.alarms()
            self.ask("PUT", "mode", {"mode": "automatic"}).raise_for_status()
        assert self.mode() == "automatic"
        self.go_on()

    def go_on(self) -> None:
        """Do what people are asked to do until something starts or finishes that was not done before."""

        def goes_on() -> bool:
            self.acknowledge()
            return any(_does_work(each) for each in self.kept.look())

        self.wait(goes_on, "nothing goes on")

    def alarms(self) -> set[str]:
        """What is wrong now, by its key."""
        alarms: dict[str, dict[str, object]] = self.browser.get("alarms").json()["alarms"]
        return {key for key, alarm in alarms.items() if alarm["ended"] is None}


@contextlib.contextmanager
def standing(seed: str, *server: str, model: Path = MODEL, emulated: bool = True) -> Iterator[Mortal]:
    """A station of which nothing is started yet, with a folder of its own."""
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        database = Database.open(f"sqlite:///{folder}/station.sqlite")
        stack.callback(database.close)
        database.upgrade()
        chance = random.Random(seed)
        station = Mortal(folder, database, chance, server=server, model=model, emulated=emulated)
        stack.callback(station.end)
        yield station


@contextlib.contextmanager
def mortal(seed: str, *server: str) -> Iterator[Mortal]:
    """The bolt tightening station with devices of its own, about to start; `server` are more options of that."""
    with standing(seed, *server) as station:
        for part in ("emulate", "server", "controller"):
            station.start(part)
        yield station


def _does_work(record: RunRecord) -> bool:
    return any(f'"{what}":[' in record.content for what in ("started", "ended"))
