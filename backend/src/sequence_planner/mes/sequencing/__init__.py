"""Order of work: when the operations of several jobs are expected to be worked, so that as little as possible is late.

`work` says what is asked and answered, `sequencing` answers it, and `process` has it answered in time by a process of
its own. The start order of the abilities inside an operation is the planner's.
"""
