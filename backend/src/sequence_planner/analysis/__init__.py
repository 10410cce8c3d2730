"""What synthesis and the checks made with it find of a model.

`analysis` gathers it, `process` has it done where it can be killed, `document` is its JSON, and `store` keeps what was
found for the next one who asks.
"""
