"""Scenarios by which a station is tested: what those in its `tests` mean."""
