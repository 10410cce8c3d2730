"""The pure core of a running station: it takes ticks, follows plans, and turns the same events into the same state.

No clock, network, thread or database is here. `executor` takes ticks, `events` are what happens, `state` is where
the station stands, and `record` writes events down and brings the state back.
"""
