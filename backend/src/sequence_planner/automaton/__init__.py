"""The extended finite automaton a model means: finite variables, ground transitions, and the tick that takes them.

`structure` is the automaton, `grounding` makes it from documents, `tick` is the reference interpreter of
`docs/semantics.md`: plain and slow, and what every faster reading of the automaton is tested against.
"""
