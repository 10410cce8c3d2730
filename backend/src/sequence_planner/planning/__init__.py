"""Planning: which abilities to start, in which order, so that the goals of all active operations are reached.

`encoding` unrolls the tick into clauses, `search` asks for the fewest ticks and then the fewest starts, `replay` holds
every answer against the reference tick, `worker` does it in a process of its own, `plain` plans for plain automata.
`way_back` looks for the way into the safe states from outside them.
"""
