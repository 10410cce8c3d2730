"""Sequences of operations, and what they expand to."""
