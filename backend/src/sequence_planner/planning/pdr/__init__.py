"""Proofs that there is no plan at all: property-directed reachability on the encoded tick.

- `relation`: one tick between sets of states, as clauses
- `frames`: the search for an inductive invariant or a way to the goals
- `inquiry`: what the solver is asked about it
- `localisation`: the automaton seen through some of its variables
- `rehearsal`: ways to the goals tried on the reference tick
- `ordering`: the order in which a tick tries its starts
- `engine`: sees through few variables first, and through more where that is not enough
"""
