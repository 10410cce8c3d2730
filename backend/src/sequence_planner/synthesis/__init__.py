"""Supervisor synthesis: the starts that must wait so that nothing forbidden happens and rest stays reachable.

All sets of states are decision diagrams (`diagrams`, ordered by `ordering`; `reading` makes them of expressions).
`plant` says what can happen over them, in `steps` and in the `reaction` of a tick; `saturation` closes sets under
steps, and `supervision` has the fixpoints of `docs/semantics.md`, "Supervisor".

For people: `guards` over few variables (`separation`, by `hitting` sets) as short covers (`covers` of `primes`, said in
`wording`); `traces`, the `shortest` of them found on diagrams; why a supervisor is `unmeetable`, with a
`minimal_conflict`; `conflicts` of finishes. `effort` limits what is not needed to run a station.
"""
