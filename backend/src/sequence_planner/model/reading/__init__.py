"""Reading a station's folder."""
