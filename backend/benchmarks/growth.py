"""How what a model costs grows with its size: the truck engine station once, twice, up to sixteen times in one model.

Run with `make bench`; with `--most 4` it goes no further than that, and `--limit` says how many seconds one size may
take in all. The stations stand side by side, and neighbours share the place of the kit. Each size has a process of its
own, and so its own memory; times are CPU time. What comes after a step that does not end in time is not measured.
"""

from __future__ import annotations

import argparse
import random
import resource
import subprocess
import sys
import tempfile
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

from stations.curves import drawn
from stations.several import write_several

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Circumstances, Contract, PlanAnswer, PlanRequest, goals_of
from sequence_planner.planning.validation.acceptance import Acceptance
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import supervised, supervisor

SIZES = (1, 2, 4, 8, 16)
LIMIT = 300.0  # seconds for one size
DEADLINE = 30.0  # seconds for one plan
TICKING = 1.0  # seconds
DRAWN = ("load", "safe states", "guards that the supervisor adds", "first plan, near", "first plan, far")
FAR = "tighten_bolt_pair_{}(AtBoltPair1TCPPose)"

_Given = TypeVar("_Given")


def main() -> None:
    """Measure every size in a process of its own, and print what is known."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--most", type=int, default=SIZES[-1])
    parser.add_argument("--limit", type=float, default=LIMIT)
    parser.add_argument("--draw", type=Path, help="a file for a picture of the curves, as SVG")
    parser.add_argument("--one", type=int, help="this size, in this process")
    options = parser.parse_args()
    if options.one is not None:
        measure(options.one)
        return
    curves: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for size in (each for each in SIZES if each <= options.most):
        print(f"\n{size} x the truck engine station", flush=True)
        for what, seconds in measured(size, options.limit):
            curves[what].append((size, seconds))
    if options.draw is not None:
        options.draw.write_text(drawn({what: points for what, points in curves.items() if what in DRAWN}, "s"))


def measured(size: int, limit: float) -> Iterator[tuple[str, float]]:
    """What a process says of one size, in seconds; it is ended when so many have passed."""
    with subprocess.Popen([sys.executable, __file__, "--one", str(size)], stdout=subprocess.PIPE, text=True) as process:
        timer = threading.Timer(limit, process.kill)
        timer.start()
        assert process.stdout is not None
        for line in process.stdout:
            print(line, end="", flush=True)
            what, _, rest = line.strip().partition(": ")
            if rest.endswith(" s"):
                yield what, float(rest.removesuffix(" s"))
        timer.cancel()
    if process.returncode:
        print(f"  not done after {limit:g} s" if process.returncode < 0 else "  failed", flush=True)


def measure(size: int) -> None:
    """One size."""
    with tempfile.TemporaryDirectory() as folder:
        model = write_several(Path(folder) / "model", size)
        station = timed("load", lambda: prepare_station(model))
    automaton = station.automaton
    numbers = len(automaton.variables), len(automaton.abilities), len(automaton.operations)
    print("  {} variables, {} abilities, {} operations".format(*numbers))
    tick(automaton)
    supervision = timed("safe states", lambda: supervised(automaton))
    known = timed("guards that the supervisor adds", lambda: supervisor(supervision))
    plan(automaton, known, "near", "take_lf_tool_1", Contract.FAST)
    plan(automaton, known, "far", FAR.format(size), Contract.FAST)
    plan(automaton, known, "near, minimal", "take_lf_tool_1", Contract.MINIMAL)
    print(f"  memory of the process, at most: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024} MiB")


def plan(automaton: Automaton, known: Supervisor, what: str, operation: str, contract: Contract) -> None:
    """A plan for the goal of an operation from the empty station, and one from a tick further on."""
    planner, state, goals = Planner(automaton, known), initial_state(automaton), goals_of(automaton, (operation,))

    def ask(state: State) -> PlanAnswer:
        return planner.answer(PlanRequest(state, goals, DEADLINE, contract=contract))

    answer = timed(f"first plan, {what}", lambda: ask(state))
    if answer.plan is None:
        print(f"    {answer.verdict.value}")
        return
    print(f"    {len(answer.plan.ticks)} ticks, by {answer.engine}")
    course = Acceptance.of(automaton, known).course(PlanningTask(state, goals, Circumstances(), contract), answer.plan)
    assert course is not None
    on_its_way = dict(course.way[1].run.values)
    timed("  again, on its way", lambda: ask(on_its_way))


def timed(what: str, make: Callable[[], _Given]) -> _Given:
    """What is made, and how long it took."""
    began = time.process_time()
    made = make()
    print(f"  {what}: {time.process_time() - began:.4g} s", flush=True)
    return made


def tick(automaton: Automaton) -> None:
    """Ticks in each of which a measured value is new."""
    chance = random.Random(1)
    run = CompiledRun(timed("compile the tick", lambda: CompiledTick(automaton)), initial_state(automaton))
    measured = sorted(automaton.names(Kind.MEASURED))
    number, began, active = 0, time.process_time(), frozenset[str]()
    while time.process_time() - began < TICKING:
        name = chance.choice(measured)
        run.sense({name: chance.choice(automaton.types[name].domain)})
        run.finish()
        run.synchronise()
        active = run.update_operations(active)
        run.record_activity(active)
        number += 1
    print(f"  {number / TICKING:.3g} ticks a second")


if __name__ == "__main__":
    main()
