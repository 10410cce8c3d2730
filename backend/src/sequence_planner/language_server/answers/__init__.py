"""What an editor asks about documents of a station, and what it is answered."""
