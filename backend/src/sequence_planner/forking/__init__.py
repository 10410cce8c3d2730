"""Processes that are forked from one that has imported what they need: they begin at once, and share its memory."""
