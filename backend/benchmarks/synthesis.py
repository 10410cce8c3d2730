"""Supervisors by saturation on `oxidd`, beside the same on CUDD, and beside chaining and breadth-first search there.

Run with `make bench`; with `--cases FOLDER`, or CASES in the environment, plain automata (`*.efa.json`) in a folder of
your own are measured as well. Each figure is from a process of its own: the CPU time from the automaton to its safe
states and to both numbers of reachable states, and the most memory that process had. The peers need `dd.cudd` and are
left out without it; one that takes longer than the limit is stopped. All must come to the same numbers.

Figures are medians of rounds in each of which everything has its turn; ratios are taken within a round. What takes
longer than a few seconds has one turn.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import resource
import statistics
import subprocess
import sys
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

BACKEND = Path(__file__).parents[1]
MODELS = BACKEND.parent / "models"
ONE = BACKEND / "benchmarks" / "compared" / "one_synthesis.py"
OURS = ("oxidd", "saturation")
PEERS = (("cudd", "saturation"), ("cudd", "chaining"), ("cudd", "breadth-first"))
# The models, and how many seconds they may take at most where that is demanded.
KNOWN: Mapping[str, float | None] = {
    "philosophers-60": 1.5,
    "transfer-lines-12": 1.5,
    str(MODELS / "bolt_tightening"): 0.2,
    str(MODELS / "robots_with_buffer"): None,
    str(MODELS / "docking_agv"): None,
    str(BACKEND / "tests" / "stations" / "worked_example"): None,
}
ROUNDS = 3
LONG = 3.0  # seconds; such a peer has one turn only

Figures = dict[str, float]


class Way(NamedTuple):
    """An engine and an algorithm, with what each round has shown; None where it was stopped."""

    engine: str
    algorithm: str
    rounds: list[Figures | None]

    def over(self) -> bool:
        """Whether one turn was enough."""
        return any(each is None or each["all"] > LONG for each in self.rounds)


def main() -> None:
    """Measure and print."""
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--cases", default=os.environ.get("CASES"), help="a folder with more plain automata")
    arguments.add_argument("--limit", type=int, default=30, help="seconds that each may take")
    chosen = arguments.parse_args()
    models = dict(KNOWN)
    if chosen.cases:
        models |= {str(path): None for path in sorted(Path(chosen.cases).glob("*.efa.json"))}
    peers = PEERS if find_spec("dd") and find_spec("dd.cudd") else ()
    if not peers:
        print("dd.cudd is not installed, so nothing is compared: pip install dd")
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores; limit {chosen.limit} s")
    for model, demand in models.items():
        measure(model, peers, chosen.limit, demand)


def measure(model: str, peers: Sequence[tuple[str, str]], limit: int, demand: float | None) -> None:
    """A few lines for a model."""
    ours = Way(*OURS, [])
    ways = [ours, *(Way(*peer, []) for peer in peers)]
    for _ in range(ROUNDS):
        for way in ways:
            if not way.over():
                way.rounds.append(figures(model, way.engine, way.algorithm, limit))
    name = Path(model).name.removesuffix(".efa.json")
    first = ours.rounds[0]
    if first is None:
        print(f"{name}: more than {limit} s")
        return
    print(f"{name}: {first['bits']} bits, {first['reachable']} states reachable, {first['supervised']} supervised")
    check_agreement(first, ways)
    for way in ways:
        print(f"  {way.engine + ', ' + way.algorithm:<22}{told(way, ours, limit)}")
    if demand is not None:
        print(f"  demanded: {demand} s; {'met' if median(ours, 'all') <= demand else 'NOT MET'}")


def figures(model: str, engine: str, algorithm: str, limit: int) -> Figures | None:
    """What one process says; None when it was stopped."""
    searched = [str(BACKEND / "tests"), *filter(None, [os.environ.get("PYTHONPATH")])]
    done = subprocess.run(
        [sys.executable, str(ONE), model, engine, algorithm],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(searched)},
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit)),
        stdout=subprocess.PIPE,
        check=False,
    )
    if done.returncode < 0:
        return None
    done.check_returncode()
    found: Figures = json.loads(done.stdout)
    return found


def check_agreement(first: Figures, ways: Sequence[Way]) -> None:
    """All come to the same numbers; those of CUDD are rounded."""
    for way in ways:
        for each in way.rounds:
            for what in ("reachable", "supervised"):
                if each is not None and not math.isclose(each[what], first[what], rel_tol=1e-9):
                    raise AssertionError(f"{way.engine}, {way.algorithm}: {each[what]} states {what}")


def told(way: Way, ours: Way, limit: int) -> str:
    """The figures of a way, beside ours."""
    if None in way.rounds:
        return f">{limit:8} s   ratio > {limit / median(ours, 'all'):.0f}"
    text = (
        f"{median(way, 'all'):9.3f} s   safe set alone {median(way, 'safe'):.3f} s   {median(way, 'mebibytes'):.0f} MiB"
    )
    if way is ours:
        return text
    ratios = [
        theirs["all"] / our["all"]
        for theirs, our in zip(way.rounds, ours.rounds, strict=False)
        if theirs is not None and our is not None
    ]
    return f"{text}   ratio {statistics.median(ratios):.1f}"


def median(way: Way, what: str) -> float:
    """The median of one figure."""
    return statistics.median(each[what] for each in way.rounds if each is not None)


if __name__ == "__main__":
    main()
