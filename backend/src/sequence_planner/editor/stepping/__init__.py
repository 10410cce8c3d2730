"""A station led through its model step by step, each one tick of the reference semantics."""
