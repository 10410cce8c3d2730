"""What the campaigns of this folder share."""
