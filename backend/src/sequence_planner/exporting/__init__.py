"""Automata for other tools: as plain automata (`*.efa.json`), and in the language CIF.

`station` says a station's ticks as single transitions, over the `steps` that a tick is taken in; `efa` and `cif` write
plain automata down. `together` finds what can happen at once, `replacing` and `names` are about expressions and names.
"""
