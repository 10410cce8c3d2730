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
from compared.bolts import bolt_tightening
from compared.families import Problem, blocked, blocks, capacity, logistics, mutex, stations
from compared.timing import ROUNDS, child, median, own

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.tick import apply_effects, finish, start, synchronise
from sequence_planner.export.pddl import pddl_text
from sequence_planner.export.sequential import sequential
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.portfolio.engines import FACTORIES
from sequence_planner.planning.problem import Contract, Plan, PlanAnswer, PlanRequest, Proof
from sequence_planner.planning.validation.replay import Replay, missing
from sequence_planner.process.budget import Budget

T = TypeVar("T")

LIMIT = 60.0  # seconds for one question
ONE_PLAN = Path(__file__).parent / "compared" / "one_plan.py"
REPLANS = (("part", Contract.FAST), ("part", Contract.MINIMAL), ("several", Contract.FAST))

UNTRANSLATED: set[str] = set()  # problems of which it is known that Fast Downward cannot translate them in time


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small problems, few states")
    quick = parser.parse_args().quick
    if fast_downward.programs() is None:
        print("Fast Downward is not installed, and left out")
    if abc.PROGRAM is None:
        print("Berkeley ABC is not installed, and left out")
    bolts, small = bolt_tightening(), stations(3, 2, 2)
    middle, large = stations(20, 8, 2), stations(40, 16, 2)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for problem in (bolts, small) if quick else (bolts, small, middle):
            print(f"\nWarm re-plan while a plan is followed: {problem.name}, {problem.size}")
            for question, contract in REPLANS:
                replan(problem, question, contract, folder, states=2 if quick else 7)
        print("\nMinimal plan, cold, whole process")
        whole_process(small if quick else middle, "part", folder)
    print("\nFast plan, cold, in process")
    for problem in (
        (bolts, small, logistics(5, 2), blocks(4))
        if quick
        else (bolts, small, middle, large, logistics(40, 4), blocks(10))
    ):
        for question in problem.questions:
            fast(problem, question, compare=problem in (bolts, small))
    print("\nNo plan at all, cold")
    with tempfile.TemporaryDirectory() as name:
        for family, sizes in ((mutex, (3, 8)), (blocked, (6, 40)), (capacity, (2, 3))):
            for size in sizes[:1] if quick else sizes:
                none_at_all(family(size), Path(name))


def replan(problem: Problem, question: str, contract: Contract, folder: Path, states: int) -> None:
    """Plan again warm, and with fresh peers, from states that a plan leads through and from others.

    On the way the planner remembers the rest of its plan; off it, where starts of a tick were held back, it has only
    what its engines have kept.
    """
    planner = Planner(problem.automaton, problem.supervisor)
    first = asked(planner, problem, problem.state, question, contract)
    if first.plan is None:
        say(f"{question}, {contract}: no plan in {LIMIT:.0f} s")
        return
    way = list(followed(problem, first.plan))
    late = [held for held in followed(problem, first.plan, held_back=True) if held not in way]
    for where, met in (("on its way", spread(way, states)), ("off its way", spread(late, states))):
        # Each state is asked about once: a second time it would be remembered wherever it is.
        times = [own(partial(asked, planner, problem, each, question, contract)) for each in met]
        peers = (
            f"{peer} {seconds * 1000:.0f} ms, ratio {seconds / statistics.median(times):.1f}"
            for peer, seconds in fresh_peers(problem, question, met, folder)
        )
        if times:
            say(f"{question}, {contract}, {len(first.plan.ticks)} ticks, {where}", statistics.median(times), *peers)


def fresh_peers(problem: Problem, question: str, states: list[State], folder: Path) -> Iterable[tuple[str, float]]:
    """What the peers take for the same, each state in a fresh process."""
    peers: dict[str, list[float]] = {}
    for each in states:
        goals = missing(problem.questions[question], each)
        from_here = replace(problem, state=each, questions={question: goals})
        if problem.name not in UNTRANSLATED and fast_downward.programs() is not None:
            text = pddl_text(sequential(problem.automaton, problem.supervisor, each, goals))
            try:
                found = fast_downward.search(text, fast_downward.translated(text, folder), LIMIT)
            except fast_downward.TranslationError as error:
                print(f"  Fast Downward cannot translate {problem.name}: {error}")
                UNTRANSLATED.add(problem.name)
                continue
            if found.plan is not None:
                require_replay(from_here, question, found.plan)
            peers.setdefault("Fast Downward", []).append(found.seconds)
        if abc.PROGRAM is not None:
            circuit = folder / "question.aig"
            circuit.write_bytes(aiger(from_here, question))
            peers.setdefault("ABC bmc3", []).append(abc.bmc3(circuit, LIMIT).seconds)
    return ((peer, statistics.median(each)) for peer, each in peers.items())


def asked(planner: Planner, problem: Problem, state: State, question: str, contract: Contract) -> PlanAnswer:
    """What `planner` answers."""
    return planner.answer(PlanRequest(state, problem.questions[question], LIMIT, contract=contract))


def whole_process(problem: Problem, question: str, folder: Path) -> None:
    """From the start of Python to the answer; and what of it is the planner's import."""
    model, circuit = folder / "model", folder / "question.aig"
    model.write_bytes(pickle.dumps((problem.automaton, problem.supervisor, problem.state, problem.questions[question])))
    ours = median(lambda: child((sys.executable, ONE_PLAN, "minimal"), LIMIT, stdin=model).seconds)
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
    """A proof, checked, from a planner whose engines take turns, and from its engine alone, beside one by ABC."""
    (question,) = problem.questions
    answers: list[PlanAnswer] = []
    ours = median(lambda: own(lambda: answers.append(planned(problem, question))))
    task = PlanningTask(problem.state, problem.questions[question])
    alone = median(lambda: own(partial(proof_of, problem, task)))
    more = [f"{answers[-1].verdict}, {answers[-1].engine}", f"engine pdr {alone * 1000:.1f} ms"]
    if abc.PROGRAM is not None:
        circuit = folder / "question.aig"
        circuit.write_bytes(aiger(problem, question))
        theirs = [abc.pdr(circuit, LIMIT) for _ in range(ROUNDS)]
        seconds = statistics.median(each.seconds for each in theirs)
        outcome = "" if theirs[0].proven else ", not proven"
        ratios = f"ratio {seconds / ours:.1f}, engine {seconds / alone:.1f}"
        more.append(f"ABC pdr {seconds * 1000:.0f} ms{outcome}, {ratios}")
    say(f"{problem.name}, {problem.size}", ours, *more)


def proof_of(problem: Problem, task: PlanningTask) -> Proof:
    """What the engine that makes proofs, made anew, finds."""
    proof = FACTORIES["pdr"](problem.automaton, problem.supervisor).solve(task, Budget.seconds(LIMIT)).proof
    assert proof is not None
    return proof


def planned(problem: Problem, question: str, contract: Contract = Contract.FAST) -> PlanAnswer:
    """The answer of a new planner."""
    return asked(Planner(problem.automaton, problem.supervisor), problem, problem.state, question, contract)


def followed(problem: Problem, plan: Plan, held_back: bool = False) -> Iterable[State]:
    """The states at the ends of the plan's ticks, but for the last; or had their last starts been `held_back`."""
    automaton, state = problem.automaton, problem.state
    effects = {effect.name: effect for effect in automaton.effects}
    for tick in plan.ticks[:-1]:
        sensed = apply_effects(state, [effects[name] for name in tick.effects])
        assert sensed is not None
        state = settled = synchronise(automaton, finish(automaton, sensed).state)
        for name in tick.starts:
            after = start(automaton, state, automaton.abilities[name])
            assert after is not None
            state = after
        yield settled if held_back else state


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
