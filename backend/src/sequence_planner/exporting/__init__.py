"""Automata for other tools: as plain automata (`*.efa.json`), and in the language CIF.

`station` says a station's ticks as single transitions, over the `steps` that a tick is taken in; `efa` and `cif` write
plain automata down. `together` finds what can happen at once, `replacing` and `names` are about expressions and names.

Questions to the planner are `sequential` actions: `ticks` makes them, by the `reaction_order` of effects; `pddl` and
`smv` write them down, and `unified` has other planners answer them.
"""
