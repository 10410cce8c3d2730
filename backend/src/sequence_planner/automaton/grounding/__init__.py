"""Grounding of a station's model: resolved abilities, operations, work masters and specifications.

`station` puts together what the other modules make of one kind of document each, with the help of `meaning`.
"""
