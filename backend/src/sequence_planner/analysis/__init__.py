"""The findings of synthesis, and of the checks made with it, about a model.

`analysis` gathers it, `worker` has it done where it can be killed, `report` is its JSON, and `store` and `cache`
keep what was found for the next one who asks. `checks` says what is suspicious in a model that can be used.
"""
