"""What `check` answers of a station: whether each ability can start, and each operation be begun and completed.

Run with `make bench`. CPU time in process, each station once: to the safe states, to what can be answered where all
that is reached is computed, and from afar to the rest, with a bound to the number of states that are reached.
"""

from __future__ import annotations

import os
import resource
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from sequence_planner.analysis.checks.feasibility import UNKNOWN, FeasibilityFinding
from sequence_planner.analysis.checks.large_reachability import MOST_EFFORT, begun, from_afar
from sequence_planner.analysis.checks.reachability import Questions
from sequence_planner.analysis.checks.supervised import exactly, subjects_of
from sequence_planner.cli.loading import load_model
from sequence_planner.synthesis.supervisor import supervised, supervisor
from sequence_planner.synthesis.transition_relation import NodeLimit

MODELS = Path(__file__).parents[2] / "models"


def main() -> None:
    """Measure and print."""
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    for folder in sorted(MODELS.iterdir()):
        measure(folder)


def measure(folder: Path) -> None:
    """A line for a station, and one for what is found from afar."""
    automaton = load_model(folder).automaton
    began = time.process_time()
    supervision = supervised(automaton)
    safe, made = supervision.plant.diagrams.exported(supervision.safe), supervisor(supervision)
    to_safe = time.process_time()
    subjects = list(subjects_of(automaton))
    found = list(exactly(automaton, subjects, safe))
    left = [each.subject for each in found if each.kind == UNKNOWN]
    at_once = time.process_time()
    answered = len(subjects) - len(left)
    print(
        f"{folder.name}: safe states {to_safe - began:.2f} s, {answered} of {len(subjects)} questions "
        f"{at_once - to_safe:.2f} s, findings {kinds(found)}"
    )
    if left:
        far = from_afar(automaton, left, safe, made).findings
        took, memory = time.process_time() - at_once, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(f"  from afar {len(left)} questions {took:.1f} s, {memory:.0f} MiB at most, findings {kinds(far)}")
        inquiry = begun(
            Questions(automaton, [e for each in left for e in each.expressions], safe), NodeLimit(MOST_EFFORT)
        )
        if inquiry is not None:
            print(
                f"  at most {inquiry.diagrams.count(inquiry.perhaps_reached())} states are reached with the supervisor"
            )


def kinds(found: Sequence[FeasibilityFinding]) -> str:
    """How many findings there are of which kind."""
    return ", ".join(f"{number} {kind}" for kind, number in Counter(each.kind for each in found).items()) or "none"


if __name__ == "__main__":
    main()
