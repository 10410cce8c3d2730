"""The engineer's workshop: the draft of a model while it is edited, what is found in it, and what its names mean."""
