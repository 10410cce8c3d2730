"""Supervisor synthesis: the starts that must wait so that nothing forbidden happens and rest stays reachable.

All sets of states are decision diagrams (`bdd`). `transition_relation` says what can happen over them,
`reachability` closes sets under steps, and `supervisor` has the fixpoints of `docs/semantics.md`, "Supervisor".

For people: `guards` over few variables as short covers, in words; `traces`, the shortest of them found on diagrams;
and why there is no supervisor (`diagnosis`), with a `minimal_conflict`.
"""
