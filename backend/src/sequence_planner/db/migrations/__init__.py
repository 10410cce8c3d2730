"""How the tables have come to be what they are."""
