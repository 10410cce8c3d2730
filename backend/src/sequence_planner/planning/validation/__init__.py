"""Plans held against the tick: replayed, looked ahead, made tighter."""
