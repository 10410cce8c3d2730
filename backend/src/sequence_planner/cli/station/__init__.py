"""Commands of a station: running it, its devices, its database, and who may sign in."""
