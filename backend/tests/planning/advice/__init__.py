"""The restart advisor against exhaustive search, and what it says of stations that have stopped."""
