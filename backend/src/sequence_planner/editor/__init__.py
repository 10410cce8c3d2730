"""The engineer's editor: the draft of a model while it is edited, what is found in it, and its revisions."""
