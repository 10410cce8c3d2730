"""A station's own stages: Python functions in files of its folder `stages`, each in a process of its own.

The process gets one request at a time and can be killed: a function that hangs, crashes or fails costs the values that
it gives, and nothing else. The controller's thread never waits for it, nor do its ticks.
"""
