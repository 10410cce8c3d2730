"""Plans of automata whose starts are taken one at a time: plain automata, as the planner sees them.

`planner` answers, by plans given before and by engines; `neighbourhood` finds shorter plans near one that was
found; `pairs` proves by values that two variables never have at the same time, `sums` by weighted sums of values
that no start changes.
"""
