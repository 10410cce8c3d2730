"""Why there is no plan at all, and what would bring one back."""
