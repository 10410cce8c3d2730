"""The restart advisor: proven ways back to work from the state a station is in, what is done before what is only said.

`request` has what is asked and `offer` what is offered. `proving` finds plans or proofs that there are none, `walking`
holds errands against the reference tick, `errands` makes them, `options` says what a person could change, and `fewest`
looks for the fewest such `changes`; `claims` says which work they would only claim to be done. `stalling` is the
station without what does not happen though it should. `consultation` is one question, `advisor` answers it until the
time is over, and `worker` does so in a process.
"""
