"""Proofs that there is no plan at all: property-directed reachability on the encoded tick.

- `relation`: one tick between sets of states, as clauses
- `pairs`: invariants of two literals, which come first
- `frames`: the search for an inductive invariant or a way to the goals
- `inquiry`: what the solver is asked about it
- `localisation`: the automaton seen through some of its variables
- `sight`: through which ones
- `rehearsal`: ways to the goals tried on the reference tick
- `ordering`: the order in which a tick tries its starts
- `question`: one question, seen through few variables first, and through more where that is not enough
- `certificate`: proofs checked by another solver (`second_solver`)
- `engine`: what the planner asks
"""
