"""Ground conditions in the words a model was written in: names for what is said more than once, and indices."""
