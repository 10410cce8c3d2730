"""What is shown of a running station."""
