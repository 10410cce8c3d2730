"""What engineers say to one another about the model."""
