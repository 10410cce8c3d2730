"""Environment variable of the database URL, and the error of an unusable database."""

from __future__ import annotations

# The variable of the environment that says where a station's database is, for the programs that open it.

# A URL may hold a password, and what stands on a command line `ps` shows to everybody on the machine.
DATABASE = "SEQUENCE_PLANNER_DATABASE"


# What goes wrong with the database, in words for people.


class StorageError(Exception):
    """The database cannot be used. The message names the place, without any password, and says what to do."""
