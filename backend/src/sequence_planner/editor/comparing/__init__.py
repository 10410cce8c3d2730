"""Comparison of two versions of a model: what is written, what may start where, and how operations are planned."""
