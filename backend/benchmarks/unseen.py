"""Plain automata that nobody has seen before, beside Fast Downward and Berkeley ABC: see `compared/unseen.py`.

Run with `make bench`; each run draws new ones, `--seed` the same again, `--quick` takes the small. All figures are CPU
time; those of the peers are of a fresh process, with its input made beforehand: ABC (`bmc3`, `pdr`) reads a circuit
whose step is one transition, so that it looks for the fewest as well, and Fast Downward its own format. Ratios above 1
say that the peer takes longer. Who does not answer in time has taken until then; where neither does, there is none.
"""

from __future__ import annotations

import argparse
import random
import statistics
import tempfile
from collections import defaultdict
from collections.abc import Iterable
from math import exp, log
from pathlib import Path
from typing import NamedTuple

from compared import abc, fast_downward
from compared.aiger import aiger_of_plain
from compared.declaring import UNSUPERVISED
from compared.timing import own
from compared.unseen import SCALES, Unseen, strayed, unseen

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.export.pddl import pddl_text
from sequence_planner.export.sequential import sequential
from sequence_planner.planning.efa_planner import PlainPlanner
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.problem import Contract, Verdict
from sequence_planner.planning.single.derived import as_station
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget

LIMIT = 10.0  # seconds of the processor for one question
WAIT = 120.0  # seconds that we wait for them
TRANSLATION = 10.0  # seconds, which do not count
STATES = 3  # on the way of a plan, and as many off it


class Took(NamedTuple):
    """The seconds that a peer took, and whether it was done with the question then."""

    seconds: float
    done: bool


class Bench:
    """Asks and prints, and keeps all ratios."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.ratios: dict[str, list[float]] = defaultdict(list)
        self._untranslated: set[str] = set()  # automata that Fast Downward cannot translate in time

    def measure(self, problem: Unseen, chance: random.Random) -> None:
        """One automaton: cold, again on the way and off it, by both contracts; and what cannot be reached."""
        print(f"\n{problem.name}, {problem.size}")
        state = problem.automaton.initial_valuation
        for contract, peer in ((Contract.MINIMAL, self._abc), (Contract.FAST, self._fast_downward)):
            planner = PlainPlanner(problem.automaton, problem.supervisor)
            answer, seconds = asked(planner, problem.goals, state, contract)
            done = answer.minimal or (contract is Contract.FAST and answer.verdict is Verdict.FOUND)
            self._say(f"cold, {contract}", [seconds], [peer(problem, state)], told(answer), done)
            if answer.verdict is Verdict.FOUND and answer.transitions:
                on, off = states_of(problem, state, answer, chance)
                for where, met in (("on its way", on), ("off its way", off)):
                    times = [asked(planner, problem.goals, each, contract)[1] for each in met]
                    self._say(f"again, {contract}, {where}", times, [peer(problem, each) for each in met])
        if problem.impossible:
            planner = PlainPlanner(problem.automaton, problem.supervisor)
            answer, seconds = asked(planner, problem.impossible, state, Contract.FAST)
            done = answer.verdict is Verdict.NONE_AT_ALL
            self._say("none at all", [seconds], [self._pdr(problem, state)], told(answer), done)

    def _say(
        self, what: str, ours: list[float], peers: Iterable[Took | None], more: str = "", done: bool = True
    ) -> None:
        theirs = [each.seconds for each in peers if each is not None and (each.done or done)]
        if not ours:
            return
        line = f"  {what:<28}{statistics.median(ours) * 1000:10.2f} ms   {more}"
        if theirs:
            ratio = statistics.median(theirs) / statistics.median(ours)
            self.ratios[what].append(ratio)
            line += f"   peer {statistics.median(theirs) * 1000:.0f} ms, ratio {ratio:.2f}"
        print(line, flush=True)

    def _abc(self, problem: Unseen, state: State) -> Took | None:
        if abc.PROGRAM is None:
            return None
        outcome = abc.bmc3(self._circuit(problem, state, problem.goals), LIMIT)
        return Took(outcome.seconds, outcome.ticks > 0)

    def _pdr(self, problem: Unseen, state: State) -> Took | None:
        if abc.PROGRAM is None:
            return None
        outcome = abc.pdr(self._circuit(problem, state, problem.impossible), LIMIT)
        return Took(outcome.seconds, outcome.proven)

    def _circuit(self, problem: Unseen, state: State, goals: Goals) -> Path:
        circuit = self._folder / "question.aig"
        circuit.write_bytes(aiger_of_plain(problem.automaton, state, missing(goals, state)))
        return circuit

    def _fast_downward(self, problem: Unseen, state: State) -> Took | None:
        if fast_downward.programs() is None or problem.name in self._untranslated:
            return None
        derived, task = as_station(problem.automaton, state, problem.goals)
        text = pddl_text(sequential(derived, UNSUPERVISED, task.state, task.goals))
        try:
            found = fast_downward.search(text, fast_downward.translated(text, self._folder, TRANSLATION), LIMIT)
        except fast_downward.TranslationError:
            self._untranslated.add(problem.name)
            return None
        return Took(found.seconds, found.plan is not None)


def asked(planner: PlainPlanner, goals: Goals, state: State, contract: Contract) -> tuple[PlainAnswer, float]:
    """What is answered, which takes every step of a plan on the reference, and after how long."""
    answers: list[PlainAnswer] = []
    budget = Budget.seconds(WAIT).working(LIMIT)
    seconds = own(lambda: answers.append(planner.answer(goals, state, contract, budget=budget)))
    return answers[0], seconds


def told(answer: PlainAnswer) -> str:
    """An answer in a few words."""
    if answer.verdict is Verdict.FOUND:
        return f"{len(answer.transitions)} transitions by {answer.engine}, none has fewer than {answer.searched}"
    return f"{answer.verdict} {answer.engine}, none has up to {answer.searched}"


def states_of(
    problem: Unseen, state: State, answer: PlainAnswer, chance: random.Random
) -> tuple[list[State], list[State]]:
    """Some states that a plan leads through, and some to which another transition has led from these."""
    transitions, way = plain_transitions(problem.automaton), [state]
    for name in answer.transitions[:-1]:
        after = step(way[-1], transitions[name])
        assert after is not None
        way.append(after)
    off = [strayed(problem.automaton, each, chance) for each in way]
    off = [each for each in off if each not in way and missing(problem.goals, each)]
    count = min(STATES, len(way))
    return [way[number * len(way) // count] for number in range(count)], off[:STATES]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(10_000))
    parser.add_argument("--quick", action="store_true", help="small automata")
    options = parser.parse_args()
    print(f"seed {options.seed}")
    for peer, there in (("Fast Downward", fast_downward.programs()), ("Berkeley ABC", abc.PROGRAM)):
        if there is None:
            print(f"{peer} is not installed, and left out")
    with tempfile.TemporaryDirectory() as name:
        bench = Bench(Path(name))
        for shape, scales in SCALES.items():
            for scale in scales[:1] if options.quick else scales:
                bench.measure(unseen(shape, scale, options.seed), random.Random(options.seed))
        print("\nRatios over all of them: least, geometric mean, number")
        for what, ratios in bench.ratios.items():
            mean = exp(statistics.mean(map(log, ratios)))
            print(f"  {what:<28}{min(ratios):8.2f}{mean:10.1f}{len(ratios):6}")


if __name__ == "__main__":
    main()
