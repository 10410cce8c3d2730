"""The extended finite automaton a model means: finite variables, ground transitions, and the tick that takes them.

`structure` is the automaton, `transitions` its transitions by phase; `grounding` makes it from documents, `plain` from
the automata of other tools. `tick` is the reference interpreter of `docs/semantics.md`: plain and slow, and what every
faster reading of the automaton is tested against, `compiled` first of all.
"""
