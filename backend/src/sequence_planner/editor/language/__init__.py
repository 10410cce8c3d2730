"""The language service behind an editor's fields: what is wrong in a text, what could stand there, what is meant.

The parser and the grounding of the backend are its only authority: what it finds in a text is what they would find.
"""
