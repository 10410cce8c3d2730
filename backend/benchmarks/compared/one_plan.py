"""One plan in a process of its own, for its CPU time: `one_plan.py CONTRACT`.

Its input is what `pickle` made of an automaton, its supervisor, a state and goals. Prints the number of ticks, or 0.
"""

from __future__ import annotations

import pickle
import sys

from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Contract, PlanRequest
from sequence_planner.process.gc_tuning import collection_seldom


@collection_seldom()
def main() -> None:
    """Plan and print, as the command `plan` does."""
    automaton, supervisor, state, goals = pickle.load(sys.stdin.buffer)
    request = PlanRequest(state, goals, deadline=120, contract=Contract(sys.argv[1]))
    answer = Planner(automaton, supervisor).answer(request)
    print(0 if answer.plan is None else len(answer.plan.ticks), answer.engine)


if __name__ == "__main__":
    main()
