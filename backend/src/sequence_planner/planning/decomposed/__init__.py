"""Plans for far goals, made of plans for the operations that lead to them."""
