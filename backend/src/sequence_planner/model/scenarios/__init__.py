"""Scenarios by which a station is tested, as an engineer writes them."""
