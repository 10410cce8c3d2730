"""Folds of resources that differ in a few words: one type, and instances of it."""
