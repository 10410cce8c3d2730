"""What is suspicious in a model that can be used: it has a meaning, but hardly the one that was meant.

`checks` gathers what the other modules look for. Nothing here reads files or keeps time.
"""
