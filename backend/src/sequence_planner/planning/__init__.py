"""Planning: which abilities to start, in which order, so that the goals of all active operations are reached.

`problem` has the questions and answers. `planner` answers a question by tasks for the engines of `portfolio`: `sat`
unrolls the tick into clauses, `heuristic` searches, `pdr` proves that there is no plan, and
`operation_decomposition` plans for one operation after the other. Every plan is held against the tick
(`validation`) before it is an answer; `plan_cache` knows what has been answered, and `repair` leads back to it.
`goals` follows formulas along runs, `diagnosis` says why there is no plan at all. `efa_planner` plans for plain
automata (with `single`), `recovery_path` looks for the way into the safe states from outside them, `recovery` for
ways back to work from wherever a station has stopped.
"""
