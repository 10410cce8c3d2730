"""The names of a model in its texts: what they mean at a place, and which one was meant."""
