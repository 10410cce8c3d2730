"""Commands and questions that people and systems may put to the controller, and who answers them."""
