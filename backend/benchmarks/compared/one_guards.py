"""The guards of one model in a process of its own, for their time and their memory: `one_guards.py MODEL`.

MODEL is what `one_synthesis.py` takes. Prints figures as JSON: CPU seconds to load the model, to its safe states, to
the findings and to all guards, each by itself, and how many guards there are and have a short condition.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from itertools import pairwise

from one_synthesis import automaton_of

from sequence_planner.analysis.checks.supervised import check_supervision
from sequence_planner.synthesis.guards import Restrictions
from sequence_planner.synthesis.supervisor import Supervision, relevant, supervisor
from sequence_planner.synthesis.transition_relation import Plant


def main() -> None:
    """Measure and print."""
    marks = [time.process_time()]
    automaton = automaton_of(sys.argv[1])
    marks.append(time.process_time())
    supervision = Supervision(Plant(automaton, relevant(automaton)))
    supervisor(supervision)
    marks.append(time.process_time())
    check_supervision(automaton, supervision)
    marks.append(time.process_time())
    restrictions = Restrictions(supervision)
    longest, guards = 0.0, []
    for name in restrictions.starts:
        before = time.process_time()
        guards.append(restrictions.guard(name))
        longest = max(longest, time.process_time() - before)
    marks.append(time.process_time())
    loading, safe, findings, words = (after - before for before, after in pairwise(marks))
    figures = {
        "loading": loading,
        "safe": safe,
        "findings": findings,
        "guards": words,
        "longest": longest,
        "number": len(guards),
        "short": sum(guard.expression is not None for guard in guards),
        "literals": sum(guard.literals or 0 for guard in guards),
        "mebibytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
