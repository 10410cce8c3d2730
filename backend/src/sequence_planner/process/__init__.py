"""Processes: those that answer, their limits, how they end with who started them, and whom they run as."""
