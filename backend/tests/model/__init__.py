"""Tests of the model documents: what they may say, and what is said of those that are wrong."""
