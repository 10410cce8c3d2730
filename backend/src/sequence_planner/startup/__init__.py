"""The beginning of a station: what its processes import, what is done first, and what keeps them running."""
