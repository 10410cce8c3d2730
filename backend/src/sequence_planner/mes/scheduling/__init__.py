"""Order of work: when the operations of several jobs are worked, so that as little as possible is late.

`problem` says what is asked and answered, `scheduler` answers it in time by a process of its own. The start order
of the abilities inside an operation is the planner's.
"""
