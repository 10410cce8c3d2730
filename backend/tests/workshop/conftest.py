"""Databases for the draft."""

from storage.databases import database, database_url, postgresql

__all__ = ["database", "database_url", "postgresql"]
