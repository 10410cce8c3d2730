"""Texts of types of resources while they are edited, and what instances say of their types."""
