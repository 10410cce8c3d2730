"""Folds of conditions, actions and lists of values."""
