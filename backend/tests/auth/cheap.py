"""Hashing that takes no time, for tests that are not about hashing."""

from __future__ import annotations

from argon2 import PasswordHasher

from sequence_planner.auth.passwords import Passwords

CHEAP = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)


def cheap_passwords() -> Passwords:
    """As in the program, but for what a hash costs. Close it."""
    return Passwords(CHEAP)
