"""Who acts over the command line: the program, in the name of whoever runs it."""

from __future__ import annotations

import os
import pwd

from sequence_planner.actor import SYSTEM, Actor


def at_the_command_line() -> Actor:
    """The actor for the journal: who may run the program has the database in hand anyway."""
    return SYSTEM.model_copy(update={"address": f"the command line of {_user()}"})


def _user() -> str:
    """Who runs the program, as the machine knows; what the environment says anybody may write there."""
    try:
        return pwd.getpwuid(os.getuid()).pw_name
    except KeyError:  # as in a container
        return f"user {os.getuid()}"
