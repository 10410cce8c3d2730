"""Goals that are far away on the truck engine station: from the empty station, from moments of a day, and after faults.

Run with `make bench`; `--seed` draws the same again, `--quick` draws few, and both it and `--alone` ask no peer. The
times are CPU time of this process without its start and without the safe states, of fast plans where nothing else is
said. A cold planner knows nothing of the station; a warm one has been asked all that stands before. ABC (`bmc3`) looks
for a shortest plan, in a circuit that is made beforehand; nobody else here takes the station's question.
"""

from __future__ import annotations

import argparse
import random
import statistics
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from compared import abc
from compared.aiger import aiger
from compared.declaring import Problem

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.language.evaluator import holds
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import (
    ORDINARY,
    Circumstances,
    Contract,
    Goal,
    PlanAnswer,
    PlanRequest,
    Verdict,
    goal_of,
    goals_of,
)
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from planning.advice.single_faults import Moment, drawn, main_job

MODEL = Path(__file__).parents[2] / "models" / "truck_engine_station"
LIMIT = 20.0  # seconds for one question
PEER_LIMIT = 60.0  # seconds for the peer


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(10_000))
    parser.add_argument("--quick", action="store_true", help="few states and no peer")
    parser.add_argument("--alone", action="store_true", help="no peer")
    options = parser.parse_args()
    automaton = prepare_station(MODEL).automaton
    state = initial_state(automaton)
    missing = [name for name, each in automaton.operations.items() if not holds(each.goal, state)]
    one_each = {name: goals_of(automaton, (name,)) for name in missing}
    questions = one_each | {f"all of these {len(missing)}": goals_of(automaton, missing)}
    station = Problem(automaton.name, automaton, synthesise(automaton), state, questions)
    print(f"{station.name}, {station.size}; seed {options.seed}")
    from_the_empty_station(station, compare=not (options.quick or options.alone))
    moments, chance = main_job(automaton, station.supervisor), random.Random(options.seed)
    print("\nMinimal plans, each by a cold planner: for operations from where they begin, and for the ladder frame\n")
    minimal_plans(station, moments)
    number = 20 if options.quick else 200
    print(f"\nFrom {number} of {len(moments)} moments of the main job, to the goal of an operation drawn, warm\n")
    from_moments(station, moments, chance, number)
    print(f"\nThe same after {number} single faults\n")
    after_faults(station, moments, chance, number)


def from_the_empty_station(station: Problem, compare: bool) -> None:
    """To the goal of each operation, each by a cold planner; and to all of them."""
    print("\nFrom the empty station, cold\n")
    print("| goal | ours | ticks, starts | engine | ABC bmc3 |")
    print("|---|---|---|---|---|")
    for question, goals in station.questions.items():
        answered = ask(Planner(station.automaton, station.supervisor), station.state, goals)
        peer = peer_of(station, question, answered.seconds) if compare else ""
        print(f"| {question} | {answered.seconds:.2f} s | {answered} | {answered.answer.engine} | {peer} |", flush=True)


def peer_of(station: Problem, question: str, ours: float) -> str:
    """What the peer takes, or that it is not there."""
    if abc.PROGRAM is None:
        return "not installed"
    with tempfile.TemporaryDirectory() as folder:
        circuit = Path(folder) / "question.aig"
        circuit.write_bytes(aiger(station, question))
        found = abc.bmc3(circuit, PEER_LIMIT)
    if not found.ticks:
        return f"none in {PEER_LIMIT:.0f} s"
    return f"{found.seconds:.2f} s, ratio {found.seconds / ours:.1f}"


@dataclass(frozen=True)
class Answered:
    """An answer, and the CPU time it took."""

    answer: PlanAnswer
    seconds: float

    def __str__(self) -> str:
        plan = self.answer.plan
        return self.answer.verdict.value if plan is None else f"{len(plan.ticks)}, {len(plan.starts)}"


def ask(
    planner: Planner,
    state: State,
    goals: tuple[Goal, ...],
    circumstances: Circumstances = ORDINARY,
    contract: Contract = Contract.FAST,
) -> Answered:
    """What the planner says, which has replayed every plan on the reference tick."""
    began = time.process_time()
    answer = planner.answer(PlanRequest(state, goals, LIMIT, contract=contract, circumstances=circumstances))
    return Answered(answer, time.process_time() - began)


def minimal_plans(station: Problem, moments: list[Moment]) -> None:
    """The goal of each operation from the first moment at which it may begin, and a far one."""
    print("| goal | fast | minimal | ticks, starts | proven |")
    print("|---|---|---|---|---|")
    begun = {
        name: next((m.state for m in moments if holds(o.precondition, m.state) and not holds(o.goal, m.state)), None)
        for name, o in station.automaton.operations.items()
    }
    for what, name, state in (
        *((name, name, state) for name, state in begun.items() if state is not None),
        ("ladder frame on the engine, from the empty station", "mount_ladder_frame", station.state),
    ):
        goals = goals_of(station.automaton, (name,))
        fast, minimal = (
            ask(Planner(station.automaton, station.supervisor), state, goals, contract=contract)
            for contract in (Contract.FAST, Contract.MINIMAL)
        )
        plan = minimal.answer.plan
        proven = plan is not None and plan.minimal_ticks and plan.minimal_starts
        bound = f"none has fewer than {minimal.answer.searched} ticks"
        known = "fewest" if proven else bound
        print(f"| {what} | {fast.seconds:.2f} s | {minimal.seconds:.2f} s | {minimal} | {known} |", flush=True)


def from_moments(station: Problem, moments: list[Moment], chance: random.Random, number: int) -> None:
    """To the goal of any operation that is not reached, wherever a product has taken the station."""
    planner = Planner(station.automaton, station.supervisor)
    found: list[Answered] = []
    while len(found) < number:
        state, goal = chance.choice(moments).state, drawn_goal(station, chance)
        if not holds(goal.predicate, state):
            found.append(ask(planner, state, (goal,)))
    header()
    line("all", found)


def after_faults(station: Problem, moments: list[Moment], chance: random.Random, number: int) -> None:
    """The same once a fault has happened there, by the kind of the fault."""
    planner = Planner(station.automaton, station.supervisor)
    found: dict[str, list[Answered]] = defaultdict(list)
    while sum(map(len, found.values())) < number:
        moment, fault = drawn(station.automaton, moments, chance)
        state, goal = synchronise(station.automaton, {**moment.state, **fault.values}), drawn_goal(station, chance)
        if not holds(goal.predicate, state):
            found[fault.kind].append(ask(planner, state, (goal,), fault.circumstances))
    header()
    for kind, answers in sorted(found.items()):
        line(kind, answers)
    line("all", [each for answers in found.values() for each in answers])


def drawn_goal(station: Problem, chance: random.Random) -> Goal:
    """The goal of an operation."""
    operations = station.automaton.operations
    return goal_of(operations[chance.choice(sorted(operations))])


def header() -> None:
    """The head of a table of `line`s."""
    print("| | number | plan | none at all, proven | neither | median | 90 % | most | engines |")
    print("|---|---|---|---|---|---|---|---|---|")


def line(what: str, answers: Iterable[Answered]) -> None:
    """How many have which answer, how long they took, and whose they are."""
    by_time = sorted(answers, key=lambda each: each.seconds)
    seconds = [each.seconds for each in by_time]
    verdicts = Counter(each.answer.verdict for each in by_time)
    engines = Counter(each.answer.engine or "nothing to do" for each in by_time)
    counted = (verdicts[Verdict.FOUND], verdicts[Verdict.NONE_AT_ALL])
    numbers = " | ".join(map(str, (len(by_time), *counted, len(by_time) - sum(counted))))
    times = " | ".join(
        f"{each:.2f} s" for each in (statistics.median(seconds), seconds[int(0.9 * len(seconds))], seconds[-1])
    )
    print(f"| {what} | {numbers} | {times} | {', '.join(f'{n} {name}' for name, n in engines.most_common())} |")


if __name__ == "__main__":
    main()
