"""Tests of the way from messages to variables and back."""
