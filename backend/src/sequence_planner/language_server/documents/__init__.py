"""Documents as an editor has them: their texts, what stands at a place of one, and what can stand there."""
