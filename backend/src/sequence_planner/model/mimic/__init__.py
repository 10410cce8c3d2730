"""The document of a station's live picture."""
