"""Proofs that there is no plan at all: property-directed reachability on the encoded tick.

`transition_relation` is one tick between sets of states, as clauses; `invariants` of two literals come first; `ic3`
looks for an inductive invariant or a way to the goals; `abstraction` sees the automaton through few variables
first, and through more where that is not enough. Another solver checks every proof.
"""
