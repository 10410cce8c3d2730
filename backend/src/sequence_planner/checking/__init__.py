"""What is suspicious in a model that can be used: it has a meaning, but hardly the one that was meant.

`checks` gathers what can be said without a supervisor; `supervised` says what is not possible under it (by `inquiry`
and `possibility`), and `unmeetable` that there is none. Nothing here reads files or keeps time.
"""
