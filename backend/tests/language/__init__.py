"""Tests of the guard and action language."""
