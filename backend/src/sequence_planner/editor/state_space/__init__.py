"""The state space of a draft, folded by chosen variables: what is reached, what is unsafe, and what leads there."""
