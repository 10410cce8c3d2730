"""What people read of a running station: messages, and the catalogue of their texts."""
