"""The extended finite automaton a model means: finite variables, ground transitions, and the tick that takes them.

`automaton` is the automaton with its transitions by phase; `grounding` makes it from documents, `plain_efa` from
the automata of other tools, in which one transition is taken at a time. `tick` is the reference interpreter of
`docs/semantics.md`: plain and slow, and what every faster reading of the automaton is tested against,
`compiled_tick` first of all, for which `compiler` turns expressions into Python.
"""
