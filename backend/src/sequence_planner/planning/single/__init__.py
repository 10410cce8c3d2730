"""Plans of automata whose starts are taken one at a time: plain automata, as the planner sees them.

- `planner`: what is asked, and who answers
- `ways`: plans given before, and what they ask of a state
- `detours`: ways back to those
- `neighbourhood`: shorter plans near one that was found
- `stepping`: what can follow a state
- `engines`: who looks for plans and proofs, and in which order
- `pairs`: proofs by values that two variables never have at the same time
- `sums`: proofs by weighted sums of values that no start changes
"""
