"""Plain automata: variables and transitions, one of which is taken at a time. There are no ticks.

`meaning` makes the automaton of a document, with what disables a transition in its guard; `steps` is the reference
of what a transition does.
"""
