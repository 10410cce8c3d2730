"""The relaxation in which nothing is ever undone, and planning with what it touches."""
