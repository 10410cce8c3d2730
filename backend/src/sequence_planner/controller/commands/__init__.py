"""What people and systems may ask of the controller, and who answers it."""
