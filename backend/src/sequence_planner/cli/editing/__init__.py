"""Commands on a model: nothing of them needs a running station."""
