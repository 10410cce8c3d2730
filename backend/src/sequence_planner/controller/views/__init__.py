"""The documents that show a running station."""
