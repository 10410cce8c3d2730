"""The engines, in turns in one thread or racing in processes of their own, and the process of the planner."""
