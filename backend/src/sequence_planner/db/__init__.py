"""The station's database: SQLite beside the station, or PostgreSQL by URL. Each package declares its own tables."""
