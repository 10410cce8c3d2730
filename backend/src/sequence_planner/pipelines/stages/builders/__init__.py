"""From the documents of stages to checked stages, one module for each family.

A builder gives a stage, or None after it has noted all that is wrong.
"""
