"""The restart advisor after single faults, at moments of the main job drawn by seed.

Run with `make bench`. The times are CPU time, for all that is offered: an advisor that has 1.8 s for itself. A fault is
one of a device, of what is believed, or of an ability; the model's own `pose` and `tool` are faults of a kind of their
own. *goes on* counts those with an offer that leaves no goal out, *complete* those with nothing left undecided.
"""

from __future__ import annotations

import math
import random
import statistics
import sys
import time
from collections import Counter, defaultdict
from pathlib import Path

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.proposals import Advice
from sequence_planner.process.budget import Budget
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from planning.advice.single_faults import Fault, Moment, asked, faults, main_job

MODELS = Path(__file__).parents[2] / "models"
SEED = 8
EACH = 10  # faults of a kind
SECONDS = 1.8


class OwnTime(Budget):
    """So many seconds of this process, whatever others do on the machine meanwhile."""

    def __init__(self, seconds: float) -> None:
        super().__init__(math.inf, time.process_time() + seconds)

    def part(self, share: float) -> Budget:
        """Nobody calls it off."""
        return OwnTime(share * self.remaining)

    part_of_work = part


def main() -> None:
    """Measure and print a table for each station."""
    for name in ("bolt_tightening", "truck_engine_station"):
        automaton = prepare_station(MODELS / name).automaton
        supervisor = synthesise(automaton)
        moments = main_job(automaton, supervisor)
        advisor = Advisor(automaton, supervisor)
        advisor.prepare()
        print(f"\n{name}: {len(moments)} moments\n")
        print("| fault | number | goes on | complete | first offers | median | most |")
        print("|---|---|---|---|---|---|---|")
        measure(automaton, advisor, moments)


def measure(automaton: Automaton, advisor: Advisor, moments: list[Moment]) -> None:
    """One line for each kind of fault."""
    chance = random.Random(SEED)
    drawn: dict[str, list[tuple[Moment, Fault]]] = defaultdict(list)
    for moment in chance.sample(moments, len(moments)) * EACH:
        by_kind: dict[str, list[Fault]] = defaultdict(list)
        for fault in faults(automaton, moment.state):
            by_kind[fault.kind].append(fault)
        for kind, some in by_kind.items():
            if len(drawn[kind]) < EACH:
                drawn[kind].append((moment, chance.choice(some)))
        if all(len(some) == EACH for some in drawn.values()):
            break
    for kind, chosen in drawn.items():
        seconds, answers = zip(*(advised(automaton, advisor, *each) for each in chosen), strict=True)
        first = Counter(_first(answer) for answer in answers)
        goes_on = sum(any(not offer.left_out for offer in answer.offers) for answer in answers)
        complete = sum(answer.complete for answer in answers)
        kinds = ", ".join(f"{name} {number}" for name, number in first.most_common())
        times = f"{statistics.median(seconds):.2f} s | {max(seconds):.2f} s"
        print(f"| {kind} | {len(chosen)} | {goes_on} | {complete} | {kinds} | {times} |", flush=True)


def _first(advice: Advice) -> str:
    """What is offered first: what somebody has to have checked is never highlighted."""
    if not advice.offers:
        return "none"
    return "only if checked" if advice.offers[0].only_if_checked else advice.offers[0].kind.value


def advised(automaton: Automaton, advisor: Advisor, moment: Moment, fault: Fault) -> tuple[float, Advice]:
    """The CPU seconds it took, and the advice."""
    request = asked(automaton, moment, fault)
    began = time.process_time()
    advice = advisor.advise(request, OwnTime(SECONDS))
    return time.process_time() - began, advice


if __name__ == "__main__":
    main()
