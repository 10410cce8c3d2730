"""How a station begins: what its processes import, what is done first, and what keeps them running."""
