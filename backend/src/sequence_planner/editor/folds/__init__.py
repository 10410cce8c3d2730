"""Folds: shorter ways to write what a station says, each proven to mean the same before it is offered."""
