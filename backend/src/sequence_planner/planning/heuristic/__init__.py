"""Heuristic search: plans where many goals make clauses slow, and shortest plans where there are few states.

`relaxed_task` and `relaxation` are the task in which nothing is ever undone, `search` goes by what these say,
`shorten` makes what was found short, and `projection` plans with what a relaxed plan touches.
"""
