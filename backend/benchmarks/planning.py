"""The planner beside Fast Downward and Berkeley ABC, on the families of `compared/families.py`.

Run with `make bench`; `--quick` takes small problems and few states. All figures are CPU time, children included, and
medians; ratios are those of medians of one run. A peer that is not there is left out, which is said: Fast Downward
comes with `pip install -r requirements-bench.lock`, ABC as the Debian package `berkeley-abc`.

Our own figures are of this process, without its start, except where they are called *whole process*. Fast Downward has
its input translated beforehand, and ABC its circuit; of both a fresh process is timed, as they cannot be kept.
"""

from __future__ import annotations

import argparse
import pickle
import statistics
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeVar

from compared import abc, fast_downward
from compared.aiger import aiger
from compared.families import Problem, blocked, blocks, capacity, logistics, mutex, stations
from compared.timing import ROUNDS, child, median, own

from sequence_planner.automaton.structure import State
from sequence_planner.automaton.tick import apply_effects, finish, start, synchronise
from sequence_planner.exporting.pddl import pddl_text
from sequence_planner.exporting.ticks import sequential
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.engines import FACTORIES
from sequence_planner.planning.plan import Contract, Plan, PlanAnswer, PlanRequest
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.replaying.replay import Replay, missing

T = TypeVar("T")

LIMIT = 60.0  # seconds for one question
ONE_PLAN = Path(__file__).parent / "compared" / "one_plan.py"
ENGINES = ("bmc", "search")  # those that make plans while one is followed


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small problems, few states")
    quick = parser.parse_args().quick
    if fast_downward.programs() is None:
        print("Fast Downward is not installed, and left out")
    if abc.PROGRAM is None:
        print("Berkeley ABC is not installed, and left out")
    small, middle, large = stations(3, 2, 2), stations(20, 8, 2), stations(40, 16, 2)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for problem in (small,) if quick else (small, middle):
            print(f"\nWarm re-plan while a plan is followed: {problem.name}, {problem.size}")
            for question in ("part", "several"):
                replan(problem, question, folder, states=2 if quick else 5)
        print("\nMinimal plan, cold, whole process")
        whole_process(small if quick else middle, "part", folder)
    print("\nFast plan, cold, in process")
    for problem in (
        (small, logistics(5, 2), blocks(4)) if quick else (small, middle, large, logistics(40, 4), blocks(10))
    ):
        for question in problem.questions:
            fast(problem, question, compare=problem is small)
    print("\nNo plan at all, cold")
    with tempfile.TemporaryDirectory() as name:
        for problem in (mutex(3), blocked(3), capacity(2)) if quick else (mutex(8), blocked(10), capacity(3)):
            none_at_all(problem, Path(name))


def replan(problem: Problem, question: str, folder: Path, states: int) -> None:
    """Plan again from states that a plan leads through, warm, and from each with fresh peers."""
    goals = problem.questions[question]
    first = planned(problem, question)
    if first.plan is None:
        say(f"{question}: no plan in {LIMIT:.0f} s")
        return
    along = spread(list(followed(problem, first.plan)), states)
    peers: dict[str, list[float]] = {}
    for each in along:
        asked = replace(problem, state=each, questions={question: missing(goals, each)})
        if fast_downward.programs() is not None:
            text = pddl_text(sequential(asked.automaton, asked.supervisor, each, asked.questions[question]))
            sas = fast_downward.translated(text, folder)
            found = fast_downward.search(text, sas, LIMIT)
            if found.plan is not None:
                require_replay(asked, question, found.plan)
            peers.setdefault("Fast Downward", []).append(found.seconds)
        if abc.PROGRAM is not None:
            circuit = folder / "question.aig"
            circuit.write_bytes(aiger(asked, question))
            peers.setdefault("ABC bmc3", []).append(abc.bmc3(circuit, LIMIT).seconds)
    for name in ENGINES:
        engine = FACTORIES[name](problem.automaton, problem.supervisor)
        times: list[float] = []
        for warming in (True, False, False):
            for each in along:
                task = Task(each, missing(goals, each), contract=Contract.FAST)
                seconds = own(partial(engine.solve, task, Budget.seconds(LIMIT)))
                times += [] if warming else [seconds]
        ours = statistics.median(times)
        ratios = (
            f"{peer} {statistics.median(each) * 1000:.0f} ms, ratio {statistics.median(each) / ours:.0f}"
            for peer, each in peers.items()
        )
        say(f"{question}, {len(first.plan.ticks)} ticks, {name}", ours, *ratios)


def whole_process(problem: Problem, question: str, folder: Path) -> None:
    """From the start of Python to the answer; and what of it is the planner's import."""
    model, circuit = folder / "model", folder / "question.aig"
    model.write_bytes(pickle.dumps((problem.automaton, problem.supervisor, problem.state, problem.questions[question])))
    ours = median(lambda: child((sys.executable, ONE_PLAN, model, "minimal"), LIMIT).seconds)
    peers: list[str] = []
    if abc.PROGRAM is not None:
        circuit.write_bytes(aiger(problem, question))
        theirs = median(lambda: abc.bmc3(circuit, LIMIT).seconds)
        peers.append(f"ABC bmc3 {theirs * 1000:.0f} ms, ratio {theirs / ours:.2f}")
    say(f"{problem.name}, {question}", ours, *peers)
    bare, imported = (
        median(partial(seconds_of, code)) for code in ("pass", "import sequence_planner.planning.planner")
    )
    say("import of the planner", imported - bare, f"Python itself {bare * 1000:.0f} ms")


def seconds_of(code: str) -> float:
    """The CPU time of a Python that runs `code`."""
    return child((sys.executable, "-c", code), LIMIT).seconds


def fast(problem: Problem, question: str, compare: bool) -> None:
    """A planner made anew for each question; with `compare`, how many more ticks than needed its plan has."""
    answers: list[PlanAnswer] = []
    seconds = median(lambda: own(lambda: answers.append(planned(problem, question))), 3)
    plan = answers[-1].plan
    more = [f"{answers[-1].verdict}, {answers[-1].engine}"]
    if plan is not None:
        require_replay(problem, question, plan)
        more.append(f"{len(plan.ticks)} ticks, {len(plan.starts)} starts")
        if compare and (best := planned(problem, question, Contract.MINIMAL).plan) is not None:
            more.append(f"fewest {len(best.ticks)} ticks, ratio {len(plan.ticks) / len(best.ticks):.2f}")
    say(f"{problem.name}, {question}", seconds, *more)


def none_at_all(problem: Problem, folder: Path) -> None:
    """A proof from a planner made anew, beside one by ABC."""
    (question,) = problem.questions
    answers: list[PlanAnswer] = []
    ours = median(lambda: own(lambda: answers.append(planned(problem, question))))
    more = [f"{answers[-1].verdict}, {answers[-1].engine}"]
    if abc.PROGRAM is not None:
        circuit = folder / "question.aig"
        circuit.write_bytes(aiger(problem, question))
        theirs = [abc.pdr(circuit, LIMIT) for _ in range(ROUNDS)]
        seconds = statistics.median(each.seconds for each in theirs)
        outcome = "" if theirs[0].proven else ", not proven"
        more.append(f"ABC pdr {seconds * 1000:.0f} ms{outcome}, ratio {seconds / ours:.1f}")
    say(f"{problem.name}, {problem.size}", ours, *more)


def planned(problem: Problem, question: str, contract: Contract = Contract.FAST) -> PlanAnswer:
    """The answer of a new planner."""
    request = PlanRequest(problem.state, problem.questions[question], deadline=LIMIT, contract=contract)
    return Planner(problem.automaton, problem.supervisor).answer(request)


def followed(problem: Problem, plan: Plan) -> Iterable[State]:
    """The states at the ends of the plan's ticks, but for the last."""
    automaton, state = problem.automaton, problem.state
    effects = {effect.name: effect for effect in automaton.effects}
    for tick in plan.ticks[:-1]:
        sensed = apply_effects(state, [effects[name] for name in tick.effects])
        assert sensed is not None
        state = synchronise(automaton, finish(automaton, sensed).state)
        for name in tick.starts:
            after = start(automaton, state, automaton.abilities[name])
            assert after is not None
            state = after
        yield state


def spread(items: list[T], count: int) -> list[T]:
    """So many of them, evenly from the first on."""
    return [items[number * len(items) // count] for number in range(min(count, len(items)))]


def require_replay(problem: Problem, question: str, plan: Plan) -> None:
    """No figure counts for a plan that is none."""
    replay = Replay(problem.automaton, problem.supervisor)
    if not replay.exactly(problem.state, problem.state, problem.questions[question], (), plan.ticks):
        raise AssertionError(f"a plan for {problem.name}, {question}, does not replay: {plan}")


def say(what: str, seconds: float | None = None, *more: str) -> None:
    """Print one figure."""
    figure = "" if seconds is None else f"{seconds * 1000:10.2f} ms"
    print("   ".join((f"{what:<44}{figure}", *more)), flush=True)


if __name__ == "__main__":
    main()
