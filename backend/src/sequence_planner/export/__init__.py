"""Automata for other tools: as plain automata (`*.efa.json`), and in the languages CIF, PDDL and SMV.

`efa` says a station's ticks as single transitions and writes plain automata down, `cif` does so in CIF. Questions
to the planner are `sequential` actions: `pddl` and `smv` write them down, and `unified` has other planners answer
them. `sros2` writes a station's security policy.
"""
