"""Planning: which abilities to start, in which order, so that the goals of all active operations are reached.

`plan` has the questions and answers. `planner` answers a question by tasks for the `engines`: `sat` unrolls the tick
into clauses, `relaxed` does so with what a relaxed plan touches, `heuristic` searches, `pdr` proves that there is no
plan. They take turns in one thread or race in processes of their own (`racing`); `attempt` gathers what they report,
and every plan is held against the tick (`replaying`) before it is an answer; `recollection` knows what has been
answered, and `repair` leads back to it. `goals` follows formulas along runs, `reasons` says why there is no plan at
all. `plain` plans for plain automata, `way_back` looks for the way into the safe states from outside them, `advice`
for ways back to work from wherever a station has stopped, and `worker` does all but that in a process of its own.
"""
