"""The one who acts over the command line: the program, in the name of whoever runs it."""

from __future__ import annotations

from sequence_planner.core.actor import SYSTEM, Actor
from sequence_planner.process.user import user_name


def at_the_command_line() -> Actor:
    """The actor for the journal: who may run the program has the database in hand anyway."""
    return SYSTEM.model_copy(update={"address": f"the command line of {user_name()}"})
