"""The station's database: SQLite beside the station, or PostgreSQL by URL. Each room declares its own tables."""
