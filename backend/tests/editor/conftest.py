"""Databases for the draft."""

from support.databases import database, database_url, postgresql

__all__ = ["database", "database_url", "postgresql"]
