"""The recovery advisor: proven ways back to work, what is done before what is only said.

`request` has what is asked and `proposals` what is proposed. `prover` finds plans or proofs that there are none,
`manual_plans` holds plans of a person against the reference tick, and `search` looks for the fewest acts of a
person. `consultation` is one question, `advisor` answers it until the time is over, in a process.
"""
