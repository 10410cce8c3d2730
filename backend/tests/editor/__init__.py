"""Tests of the engineer's workshop."""
