"""Databases for the draft."""

from db.databases import database, database_url, postgresql

__all__ = ["database", "database_url", "postgresql"]
