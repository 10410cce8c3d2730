"""Supervisor synthesis: the starts that must wait so that nothing forbidden happens and rest stays reachable.

All sets of states are decision diagrams (`diagrams`, ordered by `ordering`). `plant` says what can happen over them, in
`steps`; `saturation` closes sets under steps; `supervision` has the fixpoints of `docs/semantics.md`, "Supervisor".
"""
