"""The process of a `python` stage: what it runs, and what keeps it from all but its own folder."""
