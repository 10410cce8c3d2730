"""Heuristic search: plans where many goals make clauses slow, and shortest plans where there are few states.

`graph` and `relaxed_task` make the relaxed task of an automaton, in which nothing is ever undone, `estimate` solves it
from a state, `space` has the positions of runs and the moves between them, `best_first` searches it along the estimates
with the leaps of `leaping`, `trimming` makes what was found short, and `breadth_first` finds the shortest plan.
"""
