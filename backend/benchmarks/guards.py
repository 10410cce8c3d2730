"""What the guards take that the supervisor adds, for people to read, beside the safe states that they are made from.

Run with `make bench`; with `--cases FOLDER`, or CASES in the environment, plain automata (`*.efa.json`) in a folder of
your own are measured as well. All is CPU time: of a process that makes them one after the other, and of `synthesize`
as a whole process with nothing kept from before, all of its processes together. Figures are medians; what takes longer
than a few seconds has one turn.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

BACKEND = Path(__file__).parents[1]
sys.path.insert(0, str(BACKEND / "tests"))

from core.known_automata import philosophers, transfer_lines  # noqa: E402 (their folder is no package)

MODELS = BACKEND.parent / "models"
ONE = BACKEND / "benchmarks" / "compared" / "one_guards.py"
STATIONS = (
    MODELS / "bolt_tightening",
    MODELS / "robots_with_buffer",
    MODELS / "docking_agv",
    MODELS / "truck_engine_station",
)
ROUNDS = 5
LONG = 4.0  # seconds; such a model has one turn only

Figures = Mapping[str, float]


def main() -> None:
    """Measure and print."""
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--cases", default=os.environ.get("CASES"), help="a folder with more plain automata")
    chosen = arguments.parse_args()
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    with tempfile.TemporaryDirectory() as folder:
        written = [write(Path(folder), philosophers(number)) for number in (10, 15, 20, 30)]
        written += [write(Path(folder), each) for each in (transfer_lines(12), threshold(30))]
        cases = sorted(Path(chosen.cases).glob("*.efa.json")) if chosen.cases else []
        for model in (*STATIONS, *written, *cases):
            print(told(model), flush=True)


def write(folder: Path, document: dict[str, Any]) -> Path:
    """The file of a plain automaton."""
    file = folder / f"{document['name']}.efa.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    return file


def threshold(number: int) -> dict[str, Any]:
    """Nobody may begin while half of the places or more are taken: no short condition says so."""
    taken = " + ".join(f"n_{each}" for each in range(number))
    moves = [
        {"event": f"take_{each}", "controllable": True, "guard": f"n_{each} == {now}", "set": {f"n_{each}": 1 - now}}
        for each in range(number)
        for now in (0, 1)
    ]
    begin = {"event": "begin", "controllable": True, "guard": "not begun", "set": {"begun": True}}
    end = {"event": "end", "controllable": True, "guard": "begun", "set": {"begun": False}}
    variables: dict[str, Any] = {f"n_{each}": {"min": 0, "max": 1} for each in range(number)}
    return {
        "name": f"threshold-{number}",
        "variables": variables | {"begun": "bool"},
        "initial": " and ".join([*(f"{name} == 0" for name in variables), "not begun"]),
        "transitions": [*moves, begin, end],
        "forbidden": [f"begun and {taken} >= {number // 2}"],
        "marked": "not begun",
    }


def told(model: Path) -> str:
    """A line for a model."""
    rounds: list[Figures] = []
    wholes: list[float] = []
    while len(rounds) < ROUNDS and not (rounds and sum(rounds[-1][each] for each in ("safe", "guards")) > LONG):
        rounds.append(made(model))
        wholes.append(whole(model))
    middle = {name: statistics.median(each[name] for each in rounds) for name in rounds[0]}
    without = round(middle["number"] - middle["short"])
    name = model.name.removesuffix(".efa.json")
    return (
        f"{name}: safe states {middle['safe']:.2f} s, findings {middle['findings']:.2f} s, "
        f"{middle['number']:.0f} guards {middle['guards']:.2f} s, at most {middle['longest']:.2f} s for one, "
        f"{middle['literals']:.0f} literals, {without} without a short condition, {middle['mebibytes']:.0f} MiB; "
        f"synthesize as a whole process {statistics.median(wholes):.2f} s"
    )


def made(model: Path) -> Figures:
    """What a process says that makes the guards."""
    done = subprocess.run([sys.executable, str(ONE), str(model)], env=environment(), stdout=subprocess.PIPE, check=True)
    found: Figures = json.loads(done.stdout)
    return found


def whole(model: Path) -> float:
    """CPU seconds of `synthesize` with nothing kept."""
    with tempfile.TemporaryDirectory() as cache:
        before = used()
        subprocess.run(
            [sys.executable, "-c", "from sequence_planner.program import main; main()", "synthesize", str(model)],
            env=environment() | {"XDG_CACHE_HOME": cache},
            stdout=subprocess.DEVNULL,
            check=False,
        )
        return used() - before


def used() -> float:
    """CPU seconds of all processes that were waited for."""
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def environment() -> dict[str, str]:
    """With the tests' known automata."""
    searched: Sequence[str] = [str(BACKEND / "tests"), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(searched)}


if __name__ == "__main__":
    main()
