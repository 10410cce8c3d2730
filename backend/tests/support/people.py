"""People who act in tests."""

from __future__ import annotations

from argon2 import PasswordHasher

from sequence_planner.auth.passwords import Passwords
from sequence_planner.core.actor import Actor, ActorKind


def person(name: str, *, kind: ActorKind = ActorKind.PERSON, session: str | None = None) -> Actor:
    """Somebody signed in from this machine, in a session of their own."""
    return Actor(kind=kind, id=name.lower(), name=name, session=session or f"session of {name}", address="127.0.0.1")


EVA, ADAM = person("Eva"), person("Adam")


CHEAP = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)


def cheap_passwords() -> Passwords:
    """As in the program, but for what a hash costs. Close it."""
    return Passwords(CHEAP)
