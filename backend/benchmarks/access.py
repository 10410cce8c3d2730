"""Who may act, and what finding it out costs: sign-in, every kind of act, and a flood of wrong passwords.

Run with `make bench`. A station with emulated devices runs as its users run it. Times are on the wall, of requests one
after the other; beside sign-in stands the password hash alone, made in this process with the same parameters. What the
flood does to the ticks is seen from their event loop: how long the controller takes to answer a question, asked on its
own socket, without and with the flood.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
from argon2 import PasswordHasher
from stations.processes import part

from sequence_planner.auth.passwords import COSTS
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.queries import AboutFlows
from sequence_planner.controller.ipc import ControllerClient

STATION = Path(__file__).parents[2] / "models" / "bolt_tightening"
DOMAIN = 1 + (os.getpid() + 75) % 100
ROUNDS = 41
FLOOD = 100  # wrong passwords per second
SECONDS = 20.0
ASK_EVERY = 0.02  # seconds between two questions to the controller
NAME, GIVEN, PASSWORD = "Ida", "a quiet blue submarine", "a quiet yellow submarine"
PATIENCE = 60.0  # seconds


def main() -> None:
    """Measure and print."""
    os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)
    with tempfile.TemporaryDirectory(prefix="access-") as folder:
        os.environ["SEQUENCE_PLANNER_DATABASE"] = f"sqlite:///{folder}/station.sqlite"
        add_administrator()
        with station() as (address, launcher):
            with httpx.Client(base_url=f"{address}/api/v1", timeout=10) as client:
                choose_password(client)
                measure_acts(client)
            asyncio.run(measure_flood(address, controller_socket(launcher)))


def command(*arguments: str) -> list[str]:
    """The command line of the program."""
    return [sys.executable, "-m", "sequence_planner.cli", *arguments]


def add_administrator() -> None:
    """Somebody who may do everything, made at the machine."""
    adding = command("users", "add", NAME, str(STATION), "--role", "administrator")
    subprocess.run(adding, input=f"{GIVEN}\n", text=True, check=True, stdout=subprocess.DEVNULL)


def choose_password(client: httpx.Client) -> None:
    """What was given to begin with is changed at the first sign-in."""
    expect(200, client.post("/session", json={"name": NAME, "password": GIVEN}))
    expect(200, client.put("/session/password", json={"old": GIVEN, "new": PASSWORD}))


@contextmanager
def station(model: Path = STATION, *more: str) -> Iterator[tuple[str, int]]:
    """The address of a station that runs, and the id of its launcher."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    arguments = command("run", str(model), "--emulator", "--start", "--port", str(port), *more)
    running = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    address = f"http://127.0.0.1:{port}"
    try:
        wait_for(lambda: heard(address))
        yield address, running.pid
    finally:
        running.terminate()
        running.wait(PATIENCE)


def heard(address: str) -> bool:
    """Whether the server answers, and hears the controller."""
    try:
        return bool(httpx.get(f"{address}/healthz").json()["controller"] == "heard")
    except httpx.HTTPError:
        return False


def wait_for(condition: Callable[[], bool]) -> None:
    """Return when it is true; raises `TimeoutError`."""
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError("the station did not come up")
        time.sleep(0.1)


def controller_socket(launcher: int) -> Path:
    """The socket of the controller that the launcher has started."""
    controller = part(launcher, "controller")
    assert controller is not None
    words = controller.title.split()
    return Path(words[words.index("--socket") + 1])


def measure_acts(client: httpx.Client) -> None:
    """The median of each act, over `ROUNDS` of them."""

    def sign_in() -> None:
        expect(200, client.post("/session", json={"name": NAME, "password": PASSWORD}))

    for what, act in (("sign-in", sign_in), ("sign-in, and sign-out", lambda: signed_out(client))):
        besides_hash(what, act)
    sign_in()
    for what, took in acts(client):
        print(f"{what}: {took:.1f} ms")


def besides_hash(what: str, act: Callable[[], object]) -> None:
    """Measure an act that needs one password hash, and the hash alone in turns with it."""
    hasher = PasswordHasher.from_parameters(COSTS)
    hashes, times = [], []
    for _ in range(ROUNDS):
        hashes.append(milliseconds(lambda: hasher.hash(PASSWORD)))
        times.append(milliseconds(act))
    alone, whole = statistics.median(hashes), statistics.median(times)
    besides = statistics.median(one - other for one, other in zip(times, hashes, strict=True))
    print(
        f"{what}: {whole:.1f} ms beside {alone:.1f} ms for the hash alone: {besides:.1f} ms more, {whole / alone:.2f} x"
    )


def acts(client: httpx.Client) -> Iterator[tuple[str, float]]:
    """Each kind of act, and its median."""

    def act(status: int, method: str, path: str, body: object = None, **more: Any) -> Any:  # noqa: ANN401 - JSON
        """Do it; what is answered."""
        content: dict[str, Any] = {} if body is None else {"json": body}
        answer = expect(status, client.request(method, path, **content, **more))
        return answer.json() if answer.content else None

    yield "read the state", median(lambda: act(200, "GET", "/state"))
    yield "take control", median(lambda: act(204, "PUT", "/control-lock", {"over": None}))
    yield "pause", median(lambda: act(204, "PUT", "/mode", {"mode": "paused"}))
    yield "go on", median(lambda: act(204, "PUT", "/mode", {"mode": "automatic"}))
    yield "start production (refused: it is started)", median(lambda: act(409, "POST", "/production/start", {}))
    gone = "/tasks/gone/acknowledgement"
    yield "acknowledge a task (refused: it is gone)", median(lambda: act(409, "POST", gone, {"revision": 1}))
    names = iter(range(10_000))

    def person() -> dict[str, Any]:
        body = {"name": f"Person {next(names)}", "role": "viewer", "password": f"{PASSWORD} again"}
        made: dict[str, Any] = act(201, "POST", "/users", body)
        return made

    besides_hash("add a person", person)
    people = iter([person() for _ in range(ROUNDS)])

    def change() -> None:
        one = next(people)
        act(200, "PATCH", f"/users/{one['id']}", {"role": "operator"}, headers={"If-Match": f'"{one["revision"]}"'})

    yield "change a person's role", median(change)
    someone = person()["id"]
    yield "sign a person out everywhere", median(lambda: act(204, "DELETE", f"/users/{someone}/sessions"))

    def key() -> str:
        made = act(201, "POST", "/api-keys", {"name": f"key {next(names)}", "scopes": ["read"], "days": 1})
        return str(made["key"]["id"])

    yield "make a key", median(key)
    keys = iter([key() for _ in range(ROUNDS)])
    yield "revoke a key", median(lambda: act(204, "DELETE", f"/api-keys/{next(keys)}"))

    def offer() -> str:
        body = {"name": f"watch {next(names)}", "resource": "operator"}
        made = act(201, "POST", "/wearables/offers", body)
        act(204, "DELETE", f"/wearables/offers/{made['id']}")
        return str(made["id"])

    yield "offer to pair a watch, and take it back", median(offer)
    yield "release control, and take it again", median(lambda: released(act))
    yield "read the journal", median(lambda: act(200, "GET", "/audit"))


def released(act: Callable[..., Any]) -> None:
    """Give control up and take it."""
    act(204, "DELETE", "/control-lock")
    act(204, "PUT", "/control-lock", {"over": None})


def signed_out(client: httpx.Client) -> None:
    """Sign in and out."""
    expect(200, client.post("/session", json={"name": NAME, "password": PASSWORD}))
    expect(204, client.delete("/session"))


def expect(status: int, answer: httpx.Response) -> httpx.Response:
    """The answer, which must have this status."""
    if answer.status_code != status:
        raise RuntimeError(f"{answer.request.method} {answer.request.url} gave {answer.status_code}: {answer.text}")
    return answer


def median(act: Callable[[], object]) -> float:
    """Milliseconds that it takes."""
    return statistics.median(milliseconds(act) for _ in range(ROUNDS))


def milliseconds(act: Callable[[], object]) -> float:
    """How long it takes."""
    began = time.perf_counter()
    act()
    return (time.perf_counter() - began) * 1000


async def measure_flood(address: str, path: Path) -> None:
    """How soon the controller answers, without and with the flood, and what became of the flood."""
    client = ControllerClient(path)
    living = asyncio.create_task(client.run())
    await first_answer(client)
    quiet = await asked(client)
    flooding = asyncio.create_task(flood(address))
    flooded = await asked(client)
    answers = await flooding
    living.cancel()
    await asyncio.gather(living, return_exceptions=True)
    print(f"the controller answers, quiet: {spread(quiet)}; in the flood: {spread(flooded)}")
    print(f"{answers.total()} wrong passwords in {SECONDS:g} s were answered {dict(answers)}")
    if answers[200]:
        raise RuntimeError("a wrong password signed in")


async def first_answer(client: ControllerClient) -> None:
    """Return when the controller answers."""
    async with asyncio.timeout(PATIENCE):
        while True:
            with contextlib.suppress(CommandRefused):
                await client.ask(AboutFlows())
                return
            await asyncio.sleep(0.05)


async def asked(client: ControllerClient) -> list[float]:
    """Milliseconds that the controller took for each answer."""
    times, end = [], time.monotonic() + SECONDS
    while time.monotonic() < end:
        began = time.perf_counter()
        await client.ask(AboutFlows())
        times.append((time.perf_counter() - began) * 1000)
        await asyncio.sleep(ASK_EVERY)
    return times


async def flood(address: str) -> Counter[int]:
    """The statuses with which wrong passwords were answered, for one name that is right and for others."""
    async with httpx.AsyncClient(base_url=f"{address}/api/v1", timeout=30) as client:
        begun = time.monotonic()
        tries = []
        for number in range(int(FLOOD * SECONDS)):
            await asyncio.sleep(max(0.0, begun + number / FLOOD - time.monotonic()))
            name = NAME if number % 2 else f"Nobody {number}"
            body = {"name": name, "password": f"not the password {number}"}
            tries.append(asyncio.create_task(client.post("/session", json=body)))
        return Counter(answer.status_code for answer in await asyncio.gather(*tries))


def spread(times: Sequence[float]) -> str:
    """Median and 99th percentile, in words."""
    ordered = sorted(times)
    return f"median {statistics.median(ordered):.1f} ms, 99th percentile {ordered[int(len(ordered) * 0.99)]:.1f} ms"


if __name__ == "__main__":
    main()
