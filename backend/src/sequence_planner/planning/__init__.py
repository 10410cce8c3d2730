"""Planning: which abilities to start, in which order, so that the goals of all active operations are reached.

`planner` answers a question about goals by tasks for the `engines`, which take turns in one thread or `race` in the
processes of `lane`, which live on; `attempt` gathers what they report, and `acceptance` holds every plan against the
reference tick. `encoding` unrolls the tick into clauses, `search` asks for the fewest ticks and then the fewest starts,
`worker` does it all in a process of its own, `plain` plans for plain automata.
`way_back` looks for the way into the safe states from outside them.
"""
