"""The way in which the tables have come to be what they are."""
