"""Checks for what is suspicious in a model that can be used: it has a meaning, but hardly the one that was meant.

`rules` gathers what can be said without a supervisor; `supervised` says what is not possible under it (by
`reachability` and `feasibility`, or by `far` where states are too many), and `unmeetable` that there is none.
Nothing here reads files or keeps time.
"""
