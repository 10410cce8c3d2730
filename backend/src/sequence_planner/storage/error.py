"""What goes wrong with the database, in words for people."""

from __future__ import annotations


class StorageError(Exception):
    """The database cannot be used. The message names the place, without any password, and says what to do."""
